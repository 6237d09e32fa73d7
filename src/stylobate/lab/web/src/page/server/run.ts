/** One run of a case, from the start that is set or from that on a branch of steady rolling. */

import type { Description } from "../case/description";
import type { Branch } from "../case/starting";
import { startedFrom } from "../case/starting";
import type { Answer } from "./answers";
import { simulate, steadyStart } from "./api";
import { sent } from "./requests";

export interface WantedRun {
  readonly description: Description;
  /** The branch on which it starts; null: as the description sets it. */
  readonly start: Branch | null;
}

/** A run with the case that it is of. */
export interface Run {
  readonly answer: Answer;
  readonly description: Description;
}

export async function run({ description, start }: WantedRun, signal: AbortSignal): Promise<Run> {
  const from = start === null ? {} : await steadyStart({ ...sent(startedFrom(description)), branch: start }, signal);
  const found = { ...description, ...from };
  return { answer: await simulate(sent(found), signal), description: found };
}
