/** The speed at which a motion is well seen. */

import type { Run as Answer } from "../server/schema";
import type { Part } from "../case/description";
import { angularFrequency } from "../case/frequency";
import { SPEEDS } from "../view/state";

/** How long a period of the base motion, or of the column's own time, should take on the screen [s]. */
const SEEN = 2;

/** Returns the speed for a run under `motion`; earthquakes go as they went. */
export function paceOf(motion: Part, answer: Answer): number {
  if (motion["kind"] === "record") return 1;
  const frequency = angularFrequency(motion) ?? 2 * answer.column.frequency_scale;
  const wanted = (2 * Math.PI) / frequency / SEEN;
  const away = (speed: number): number => Math.abs(Math.log(speed / wanted));
  return SPEEDS.reduce((best, speed) => (away(speed) < away(best) ? speed : best));
}
