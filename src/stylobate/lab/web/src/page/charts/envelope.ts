/** The band between the lowest and the highest values of swings that lie too close together to be seen one by one. */

import type { Numbers } from "./plot-looks";

export interface Envelope {
  readonly time: readonly number[];
  readonly low: readonly number[];
  readonly high: readonly number[];
}

/** Up and down a swing has two lines of 1.5 px: one that is narrower cannot be seen [px]. */
const NARROWEST = 3;

/** Swings, at least, of which the band has the lowest and the highest value at one place. */
const SWINGS = 1.5;

/** Returns the band of values over a plot of this width [px]; null where the swings can be seen one by one. */
export function envelopeOf(time: readonly number[], values: Numbers, width: number): Envelope | null {
  const swings = turnsOf(values) / 2;
  if (!(width > 0) || swings * NARROWEST < width) return null;
  const [from, to] = [time[0] ?? 0, time.at(-1) ?? 0];
  const parts = Math.max(2, Math.floor(Math.min(width, swings / SWINGS)));
  const low = Array.from({ length: parts }, () => Infinity);
  const high = Array.from({ length: parts }, () => -Infinity);
  values.forEach((value, i) => {
    if (value === null) return;
    const part = Math.min(parts - 1, Math.floor(((time[i]! - from) / (to - from)) * parts));
    low[part] = Math.min(low[part]!, value);
    high[part] = Math.max(high[part]!, value);
  });
  const step = (to - from) / parts;
  const known = low.flatMap((value, part) => (value <= high[part]! ? [part] : []));
  // Each part is level from its beginning to its end: the band holds every value.
  return {
    time: known.flatMap((part) => [from + part * step, from + (part + 1) * step]),
    low: known.flatMap((part) => [low[part]!, low[part]!]),
    high: known.flatMap((part) => [high[part]!, high[part]!]),
  };
}

/** A turn counts from which the values go back by this part of the largest: rounding turns, too. */
const SEEN = 0.01;

/** Returns how often values turn from rising to falling or back. */
function turnsOf(values: Numbers): number {
  const least = SEEN * values.reduce<number>((most, value) => Math.max(most, Math.abs(value ?? 0)), 0);
  let [turns, side, extreme]: [number, number, number | null] = [0, 0, null];
  for (const value of values) {
    if (value === null) continue;
    const way: number = extreme === null ? 0 : value - extreme;
    if (extreme === null || way * side > 0) extreme = value;
    else if (Math.abs(way) > least) {
      if (side !== 0) turns += 1;
      [side, extreme] = [Math.sign(way), value];
    }
  }
  return turns;
}
