/** How long the runs of a map or a basin last, so that a motion that is chosen in one lasts as long. */

import type { Description, Part } from "./description";
import { angularFrequency, isHorizontalHarmonic } from "./frequency";
import type { PlaneKind } from "../view/state";

/** Rolling with usual damping has settled in so many periods of the base motion; what has not is told apart. */
const SETTLED = 200;

/** The fewest periods of a base motion under which nothing rolls, after which a column that stands counts as standing. */
const STANDS = 60;

const TURN = 2 * Math.PI;

/** Returns the length of the runs as it is sent: periods of each run's own motion, or the duration of the case. */
export function lengthOf(kind: PlaneKind, description: Description): Part {
  const periods = kind === "map" ? mapPeriods(description) : basinPeriods(description);
  return periods === null ? { duration: description["duration"] ?? null } : { duration: null, periods };
}

/** Returns a case that is `chosen` in the plane of a description with the length of its run there, to `longest` [s]. */
export function withLength(kind: PlaneKind, of: Description, chosen: Description, longest: number): Description {
  const { periods } = lengthOf(kind, of);
  const frequency = angularFrequency(chosen.motion);
  if (typeof periods !== "number" || frequency === null || !(frequency > 0)) return chosen;
  return { ...chosen, duration: Math.min(Number(((periods * TURN) / frequency).toPrecision(DIGITS)), longest) };
}

function basinPeriods({ motion }: Description): number | null {
  return isHorizontalHarmonic(motion) ? SETTLED : null;
}

/** Where the case lasts longer than is needed, its runs in the map last as many periods as it does. */
function mapPeriods({ motion, duration }: Description): number | null {
  const frequency = angularFrequency(motion);
  if (frequency === null || !(frequency > 0)) return null;
  const own = typeof duration === "number" ? (duration * frequency) / TURN : 0;
  return Math.max(Number(own.toPrecision(DIGITS - 2)), isHorizontalHarmonic(motion) ? SETTLED : STANDS);
}

/** Of a duration; the periods that follow from it are rounded more coarsely, so that they come back the same. */
const DIGITS = 6;
