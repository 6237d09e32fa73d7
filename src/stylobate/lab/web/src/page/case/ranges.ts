/** Sliders: where a value stands between two ends, evenly or by its logarithm. */

export interface Scale {
  readonly from: number;
  readonly to: number;
  readonly logarithmic: boolean;
}

/** Positions of a slider: finer than a pixel, coarse enough for the arrow keys. */
export const POSITIONS = 400;

/** A range over more than this factor is told apart by its logarithm: else its lower decades lie in a few pixels. */
const DECADES = 50;

export function scaleBetween(from: number, to: number): Scale {
  return { from, to, logarithmic: from > 0 && to / from >= DECADES };
}

/** Returns the scale of a slider about a value: a few times less to a few times more, by the logarithm. */
export function scaleAbout(value: number, top: number): Scale {
  if (!(value > 0)) return { from: 0, to: Math.max(top, 0), logarithmic: false };
  return { from: niceBelow(value / SPREAD), to: niceAbove(value * SPREAD), logarithmic: true };
}

/** How many times the present value a slider reaches that has no range of its own. */
export const SPREAD = 5;

/** Returns the position of `value`, 0 to POSITIONS; what lies beyond an end stands at it. */
export function positionOf(value: number, scale: Scale): number {
  const { from, to, logarithmic } = scale;
  const share = logarithmic
    ? Math.log(Math.max(value, from) / from) / Math.log(to / from)
    : (value - from) / (to - from);
  return Math.round(Math.min(Math.max(share, 0), 1) * POSITIONS);
}

/** Returns the value at a position, in the fewest digits that distinguish it from its neighbours. */
export function valueAt(position: number, scale: Scale): number {
  const { from, to, logarithmic } = scale;
  const share = Math.min(Math.max(position / POSITIONS, 0), 1);
  if (share === 0) return from;
  if (share === 1) return to;
  if (logarithmic) return Number((from * (to / from) ** share).toPrecision(3));
  return rounded(from + (to - from) * share, (to - from) / POSITIONS);
}

/** Returns `value` to the decimal place of `step`. */
export function rounded(value: number, step: number): number {
  const places = Math.min(Math.max(-Math.floor(Math.log10(step)), 0), 15);
  const found = Number(value.toFixed(places));
  return found === 0 ? 0 : found; // never minus zero
}

/** Returns the next number above (or below) of the kind 1, 2 or 5 times a power of ten. */
export function niceAbove(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  const factor = [1, 2, 5, 10].find((one) => one * power >= value * (1 - 1e-12)) ?? 10;
  return Number((factor * power).toPrecision(6));
}

export function niceBelow(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value) + 1e-12);
  const factor = [5, 2, 1].find((one) => one * power <= value * (1 + 1e-12)) ?? 1;
  return Number((factor * power).toPrecision(6));
}

/** Returns values at equal, round distances from `from` to `to`, about `number` of them. */
export function ticks(from: number, to: number, number: number): readonly number[] {
  if (!(to > from) || number < 1) return [];
  const step = niceAbove((to - from) / number);
  const first = Math.ceil(from / step - 1e-9);
  const last = Math.floor(to / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}
