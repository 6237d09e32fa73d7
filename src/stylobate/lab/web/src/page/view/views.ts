/** The views of presets and of links. */

import type { About, Preset } from "../case/about";
import { BrokenLink, inWords, viewFrom } from "./link";
import type { View } from "./state";
import { viewOf } from "./state";

export function viewOfPreset(preset: Preset): View {
  return viewOf(preset.description, preset.view ?? {});
}

export function firstView(about: About): View {
  const [first] = about.presets;
  if (first === undefined) throw new Error("the server has no presets");
  return viewOfPreset(first);
}

/** Returns the view of a link, or that of the first preset with a line that says what is wrong with the link. */
export function viewOfLink(link: string, about: About): readonly [view: View, problem: string | null] {
  if (link === "" || link === "#") return [firstView(about), null];
  try {
    return [viewFrom(link, about), null];
  } catch (error) {
    if (error instanceof BrokenLink) return [firstView(about), inWords(error.message)];
    throw error;
  }
}
