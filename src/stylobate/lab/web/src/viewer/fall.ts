/**
 * The fall that follows a run: the run ends as soon as the column cannot come back, a long time before it lies.
 *
 * Nothing of it is computed by the model: a rigid body turns about the point of its rim that touches last, in the plane
 * in which it leans, from the last tilt at the last rate, on a base that stands still, until its side lies on the base.
 */

import type { DrawnMotion, Pair, Rotation, Triple } from "./drawn-motion";
import { leaningPose } from "./moment";

/** A motion with its fall: what is drawn from `computed_until` on was not computed. */
export interface FallingMotion extends DrawnMotion {
  readonly computed_until: number;
}

const STEP = 0.02; // of an integration, in 1/p
const LONGEST = 20; // of a fall, in 1/p

export function isFalling(motion: DrawnMotion): motion is FallingMotion {
  return "computed_until" in motion;
}

/** Return up to where a motion was computed; what is drawn later is its fall, or the end of its run [s]. */
export function computedUntil(motion: DrawnMotion): number {
  return isFalling(motion) ? motion.computed_until : motion.time.at(-1)!;
}

/** Return the azimuth in which the column leans at the end of its motion [rad]. */
export function azimuthAtEnd({ tilt }: DrawnMotion): number {
  const [x, y] = tilt.at(-1)!;
  return Math.atan2(y, x);
}

/** Return the tilt at which the side of the column lies on the base [rad]. */
export function lyingTilt({ column }: DrawnMotion): number {
  return Math.PI / 2 - Math.atan2(column.top_radius - column.radius, column.height);
}

/**
 * Return an overturned motion with its fall drawn on.
 *
 * @param frequency - p = √(m g R/I) of the column about a point of its rim [rad/s]
 */
export function withFall(motion: DrawnMotion, frequency: number): DrawnMotion {
  if (motion.outcome !== "OVERTURNED" || !(frequency > 0)) return motion;
  const azimuth = azimuthAtEnd(motion);
  const tilts = fallingTilts(motion, azimuth, frequency);
  if (tilts === null) return motion;
  const step = STEP / frequency;
  const end = motion.time.at(-1)!;
  const poses = tilts.map((tilt, i) => poseOf(motion, azimuth, tilt, (i + 1) * STEP));
  const last = <Value>(values: readonly Value[]): Value[] => [...values, ...poses.map(() => values.at(-1)!)];
  const joined = <Name extends keyof Pose>(name: Name): NonNullable<Pose[Name]>[] =>
    [...motion[name]!, ...poses.map((pose) => pose[name])] as NonNullable<Pose[Name]>[];
  const fall = {
    time: [...motion.time, ...tilts.map((_, i) => end + (i + 1) * step)],
    tilt: joined("tilt"),
    tilt_rate: last(motion.tilt_rate),
    twist: last(motion.twist),
    spin: motion.spin && [...motion.spin, ...tilts.map(() => 0)],
    footprint: last(motion.footprint),
    contact_point: last(motion.contact_point),
    resting: [...motion.resting, ...tilts.map(() => 0)],
    clearance: motion.clearance && joined("clearance"),
    base: last(motion.base),
    rotation: joined("rotation"),
    centre: joined("centre"),
    friction_demand: motion.friction_demand && last(motion.friction_demand),
    computed_until: end,
  };
  return { ...motion, ...fall };
}

/** Return the tilts of θ̈ = p² sin(θ + incline − α) at equal steps until the side lies; null where it does not fall. */
function fallingTilts(motion: DrawnMotion, azimuth: number, frequency: number): number[] | null {
  const { incline, incline_direction } = motion.plane;
  const lean = incline * Math.cos(azimuth - incline_direction) - Math.atan(motion.column.slenderness);
  const [x, y] = motion.tilt.at(-1)!;
  const [rateX, rateY] = motion.tilt_rate.at(-1)!;
  const end = lyingTilt(motion);
  const found: number[] = [];
  let [tilt, rate] = [Math.hypot(x, y), (rateX * Math.cos(azimuth) + rateY * Math.sin(azimuth)) / frequency];
  while (tilt < end) {
    if (found.length * STEP > LONGEST || tilt < 0) return null;
    rate += STEP * Math.sin(tilt + lean);
    tilt = Math.min(tilt + STEP * rate, end);
    found.push(tilt);
  }
  return found;
}

interface Pose {
  readonly tilt: Pair;
  readonly rotation: Rotation;
  readonly centre: Triple;
  readonly clearance: number;
}

/** Return the pose at a tilt, `after` so many 1/p, about the last point of contact; a column in flight comes down on it. */
function poseOf(
  { footprint, twist, column, clearance }: DrawnMotion,
  azimuth: number,
  tilt: number,
  after: number,
): Pose {
  const height = (clearance?.at(-1) ?? 0) * Math.max(1 - after, 0);
  const lean = { azimuth, tilt, twist: twist.at(-1)! };
  const { rotation, centre } = leaningPose(column.radius, footprint.at(-1)!, lean, height);
  return { tilt: [tilt * Math.cos(azimuth), tilt * Math.sin(azimuth)], rotation, centre, clearance: height };
}
