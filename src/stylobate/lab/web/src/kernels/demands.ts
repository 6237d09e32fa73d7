/** Contact demands of a run: its measures, rows of its summary, and warnings. */

import { filled, general } from "./general";
import type { Kernels } from "./kernels";

export interface Demands {
  readonly measures: Readonly<Record<string, number | null>>;
  readonly rows: readonly [string, string][];
  readonly warnings: readonly string[];
}

/** Returns what the numbers of `demand` mean; `limit` is the friction coefficient of the base, `capacity` that of rest. */
export function demandsOf(kernels: Kernels, numbers: Float64Array, limit: number, capacity: number): Demands {
  const { common, texts, demand_rows, no_bound } = kernels.described;
  const of = (name: string): number => numbers[common.columns.demand[name] ?? -1] ?? NaN;
  const [friction, normal] = [of("friction"), of("normal")];
  if (Number.isNaN(friction)) return { measures: {}, rows: [], warnings: [] };
  const found = [friction, of("pivoting"), normal];
  const when = (time: number): string => (Number.isNaN(time) ? texts.for_a_moment : filled(texts.from_time, { time }));
  const warnings: string[] = [];
  if (normal <= 0) warnings.push(filled(texts.lifts_off, { when: when(of("lifts")) }));
  if (friction > limit) {
    const needed = Number.isFinite(friction) ? filled(texts.at_most, { demand: friction }) : texts.without_bound;
    const before = limit < capacity ? filled(texts.before_rocking, { capacity }) : "";
    warnings.push(filled(texts.slips, { when: when(of("slips")), limit, needed, before }));
  }
  return {
    measures: Object.fromEntries(
      demand_rows.map(([, name], k) => [name, Number.isFinite(found[k]) ? (found[k] ?? null) : null]),
    ),
    rows: demand_rows.map(([label, , unit], k) => {
      const value = found[k] ?? NaN;
      return [label, Number.isFinite(value) ? general(value, 4) + unit : no_bound];
    }),
    warnings,
  };
}
