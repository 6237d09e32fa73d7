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

const percent = (share: number): string => formatted(Math.round(100 * share));
