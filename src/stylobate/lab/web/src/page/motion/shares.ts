/** What small variations of a run say, in a line. */

import { capital, formatted, words } from "../frame/format";
import type { Variations } from "../server/schema";

/** What is varied, where it has another name for readers. */
const NAMES: Readonly<Record<string, string>> = { scale: "shaking" };

export function sharesOf({ varied, runs, classes }: Variations): string {
  const of = varied.map(({ name, deviation }) => `${NAMES[name] ?? words(name)} ± ${formatted(100 * deviation, 2)} %`);
  const shares = classes.map(({ name, share, low, high }) => {
    const between = low === null || high === null ? "" : ` (${percent(low)} to ${percent(high)})`;
    return `${capital(name)} ${percent(share ?? 0)} %${between}`;
  });
  return `${runs} small variations, ${of.join(", ")}: ${shares.join(", ")}.`;
}

/** Returns whether a case stands at the edge of overturning, as small variations of its run have it. */
export function edgeOf({ outcomes }: Pick<Variations, "outcomes">): string {
  const fallen = outcomes.filter((one) => one === "OVERTURNED").length;
  if (fallen === outcomes.length) return `All ${fallen} small variations fall as well: this is far from the edge.`;
  if (fallen === 0) return `None of ${outcomes.length} small variations falls: this is not at the edge.`;
  return `${fallen} of ${outcomes.length} small variations fall: this is at the edge. Ask for a probability, from many records.`;
}

const percent = (share: number): string => formatted(Math.round(100 * share));
