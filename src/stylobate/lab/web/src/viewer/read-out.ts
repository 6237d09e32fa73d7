/** Numbers beside the picture. */

import type { DrawnMotion } from "./drawn-motion";
import type { Place } from "./moment";

/** Return the time and that of the end with as many digits as a step on the screen is worth: 3.20 of 60.00 s. */
export function timeInWords(time: number, end: number): string {
  const digits = end >= 1000 ? 0 : end >= 100 ? 1 : 2;
  return `${time.toFixed(digits)} of ${end.toFixed(digits)} s`;
}

/** Return the magnitude of the tilt over the slenderness. */
export function tiltAt({ tilt, column }: DrawnMotion, { index, part }: Place): string {
  const [a, b] = [tilt[index]!, tilt[Math.min(index + 1, tilt.length - 1)]!];
  return (Math.hypot(a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])) / column.slenderness).toFixed(3);
}
