/** How long the runs of a map or a basin last, so that a motion that is chosen in one lasts as long. */

import type { Description, Part } from "./description";
import { angularFrequency, isHorizontalHarmonic } from "./frequency";
import { type ColumnScales, withValue } from "./quantities";
import { GRIDS } from "../server/declared";
import type { Axis, Plane, PlaneKind } from "../view/state";

/** The fewest periods of a horizontal base motion after which a motion counts as settled, and the most. */
const [SETTLED, MOST] = [200, 1000];

/** Free motion decays in 1/η column times (1/ω0); after forty of them rolling has settled, whatever the frequency. */
const DECAYS = 40;

/** The fewest periods of a base motion under which nothing rolls, after which a column that stands counts as standing. */
const STANDS = 60;

const TURN = 2 * Math.PI;

/** Returns the length of the runs as it is sent: periods of each run's own motion, or the duration of the case. */
export function lengthOf(kind: PlaneKind, description: Description, plane: Plane, scales: ColumnScales): Part {
  const settled = isHorizontalHarmonic(description.motion) ? settledPeriods(description, plane, scales) : null;
  const periods = GRIDS[kind].starts ? (settled ?? basinPeriods(description)) : mapPeriods(description, settled);
  return periods === null ? { duration: description["duration"] ?? null } : { duration: null, periods };
}

/** Returns a case that is `chosen` in a plane whose runs have this length, as long as its run there, to `longest` [s]. */
export function withLength({ periods }: Part, chosen: Description, longest: number): Description {
  const frequency = angularFrequency(chosen.motion);
  if (typeof periods !== "number" || frequency === null || !(frequency > 0)) return chosen;
  return { ...chosen, duration: Math.min(Number(((periods * TURN) / frequency).toPrecision(DIGITS)), longest) };
}

/** Returns in how many periods every run of the plane has settled: that of the highest frequency has the shortest. */
function settledPeriods(description: Description, { x, y }: Plane, { frequency_scale }: ColumnScales): number {
  const cases = ends(x).flatMap((atX) =>
    ends(y).map((atY) => withValue(withValue(description, x.name, atX), y.name, atY)),
  );
  const highest = Math.max(...cases.map(({ motion }) => angularFrequency(motion) ?? 0));
  const dampings = cases.map(({ model }) => model["damping"]).filter((one) => typeof one === "number" && one > 0);
  const least = Math.min(...(dampings as number[])); // infinite where nothing is damped: then nothing decays
  const decayed = Math.ceil((DECAYS * highest) / (least * frequency_scale * TURN));
  return Math.min(Math.max(SETTLED, decayed), MOST);
}

/** Returns the first two values of an axis and its last: the first damping may be zero. */
const ends = ({ from, to, number }: Axis): readonly number[] => [from, from + (to - from) / (number - 1), to];

/** Where the case lasts longer than is needed, its runs in the map last as many periods as it does. */
function mapPeriods({ motion, duration }: Description, settled: number | null): number | null {
  const frequency = angularFrequency(motion);
  if (frequency === null || !(frequency > 0)) return null;
  const own = typeof duration === "number" ? (duration * frequency) / TURN : 0;
  return Math.max(Number(own.toPrecision(DIGITS - 2)), settled ?? STANDS);
}

/** A base motion with a period may have attractors besides rolling, which runs without a duration could not tell apart. */
function basinPeriods({ motion }: Description): number | null {
  return angularFrequency(motion) === null ? null : STANDS;
}

/** Of a duration; the periods that follow from it are rounded more coarsely, so that they come back the same. */
const DIGITS = 6;
