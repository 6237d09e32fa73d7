/** Response curves as the lines that are drawn: for each branch what is stable, and what is not. */

import type { Numbers } from "./plot-looks";

export interface ResponseLine {
  readonly stable: boolean;
  readonly sense: string;
  readonly branch: string;
  readonly amplitude: Numbers;
  readonly phase: Numbers;
}

/** A branch of a response, or two of opposite senses that look the same. */
interface ResponseBranch extends Omit<ResponseLine, "stable"> {
  readonly stable: readonly (boolean | null)[];
}

/** Returns two lines for each branch; the unstable ones reach to their stable neighbours, so that no gap is left. */
export function linesOf(
  curves: { readonly branches: readonly ResponseBranch[] },
  slenderness: number,
): readonly ResponseLine[] {
  return distinct(curves.branches).flatMap((branch) => {
    const amplitude = branch.amplitude.map((value) => (value === null ? null : value / slenderness));
    const phase = continuous(branch.phase);
    return [true, false].map((stable) => ({
      stable,
      sense: branch.sense,
      branch: branch.branch,
      amplitude: where(amplitude, branch, stable),
      phase: where(phase, branch, stable),
    }));
  });
}

/** Returns branches without those of a second sense that cannot be distinguished from the first, as under straight motion. */
function distinct(branches: readonly ResponseBranch[]): readonly ResponseBranch[] {
  const senses = [...new Set(branches.map((one) => one.sense))];
  const [first = [], second = []] = senses.map((sense) => branches.filter((one) => one.sense === sense));
  const alike = first.length > 0 && first.length === second.length && first.every((one, i) => areAlike(one, second[i]));
  return alike ? first.map((one) => ({ ...one, sense: BOTH })) : branches;
}

const BOTH = "both senses";

/** What differs by less [rad] is one line on the screen. */
const SEEN = 1e-6;

function areAlike(one: ResponseBranch, other: ResponseBranch | undefined): boolean {
  return (
    one.branch === other?.branch &&
    one.amplitude.every((value, i) => Math.abs((value ?? 0) - (other.amplitude[i] ?? 0)) < SEEN) &&
    one.stable.every((stable, i) => stable === other.stable[i])
  );
}

function where(values: Numbers, { stable }: ResponseBranch, wanted: boolean): Numbers {
  const is = (i: number): boolean => (stable[i] === true) === wanted;
  return values.map((value, i) => (is(i) || (!wanted && (is(i - 1) || is(i + 1))) ? value : null));
}

/** Returns phases without jumps of a turn, the first within half a turn of zero. */
export function continuous(phases: Numbers): Numbers {
  let before: number | null = null;
  return phases.map((phase) => {
    if (phase === null) return null;
    const near = phase - 2 * Math.PI * Math.round((phase - (before ?? 0)) / (2 * Math.PI));
    before = near;
    return near;
  });
}

/** Returns how high the axis of amplitudes reaches: to the highest point, but not far beyond what can be. */
export function heightOf(lines: readonly ResponseLine[], others: Numbers = []): number {
  const known = [...lines.flatMap((line) => line.amplitude), ...others].filter(
    (value): value is number => value !== null,
  );
  const highest = known.reduce((most, value) => Math.max(most, value), 0);
  return highest > 0 ? Math.min(highest * 1.06, HIGHEST) : 1.1;
}

/** Beyond the tilt c nothing stays; a little more is shown, so that the curves are seen to leave. */
const HIGHEST = 1.25;
