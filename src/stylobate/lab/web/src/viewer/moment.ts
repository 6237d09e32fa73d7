/** A motion at one instant between its samples. */

import type { DrawnMotion, Pair, Rotation, Triple } from "./drawn-motion";

export interface Moment {
  readonly time: number;
  readonly rotation: Rotation;
  readonly centre: Triple;
  readonly footprint: Pair;
  readonly contact: Pair;
  readonly clearance: number;
  readonly base: Triple;
  readonly twist: number;
  readonly resting: boolean;
}

/** Where a time lies among samples: after this one, by this part of the way to the next. */
export interface Place {
  readonly index: number;
  readonly part: number;
}

export function placeOf(times: readonly number[], time: number): Place {
  const last = times.length - 1;
  if (!(time > times[0]!)) return { index: 0, part: 0 };
  if (time >= times[last]!) return { index: last, part: 0 };
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle]! <= time) low = middle;
    else high = middle;
  }
  return { index: low, part: (time - times[low]!) / (times[high]! - times[low]!) };
}

/** Positions run straight between samples, rotations at an even rate; at a sample both are the sample. */
export function momentAt(motion: DrawnMotion, time: number): Moment {
  const { index, part } = placeOf(motion.time, time);
  const next = Math.min(index + 1, motion.time.length - 1);
  const pair = (values: readonly Pair[]): Pair => {
    const [a, b] = [values[index]!, values[next]!];
    return [mix(a[0], b[0], part), mix(a[1], b[1], part)];
  };
  const triple = (values: readonly Triple[]): Triple => {
    const [a, b] = [values[index]!, values[next]!];
    return [mix(a[0], b[0], part), mix(a[1], b[1], part), mix(a[2], b[2], part)];
  };
  const number = (values: readonly number[]): number => mix(values[index]!, values[next]!, part);
  return {
    time,
    rotation: slerp(motion.rotation[index]!, motion.rotation[next]!, part),
    centre: triple(motion.centre),
    footprint: pair(motion.footprint),
    contact: pair(motion.contact_point),
    clearance: motion.clearance === null ? 0 : number(motion.clearance),
    base: triple(motion.base),
    twist: number(motion.twist),
    resting: motion.resting[index] === 1,
  };
}

/** Return a motion at an instant, but with another tilt, about the rim of the circle on which the column stands then. */
export function leaningMoment(motion: DrawnMotion, time: number, [x, y]: Pair): Moment {
  const moment = momentAt(motion, time);
  const { radius } = motion.column;
  const [azimuth, tilt] = [Math.atan2(y, x), Math.hypot(x, y)];
  const [fx, fy] = moment.footprint;
  return {
    ...moment,
    ...leaningPose(radius, moment.footprint, { azimuth, tilt, twist: moment.twist }, 0),
    contact: [fx + radius * Math.cos(azimuth), fy + radius * Math.sin(azimuth)],
    clearance: 0,
    resting: tilt === 0,
  };
}

/** Return rotation and centre of the bottom of a column that leans on its rim, `height` above the base. */
export function leaningPose(
  radius: number,
  [x, y]: Pair,
  { azimuth, tilt, twist }: { readonly azimuth: number; readonly tilt: number; readonly twist: number },
  height: number,
): { readonly rotation: Rotation; readonly centre: Triple } {
  const across = radius * (1 - Math.cos(tilt));
  const [half, turn] = [tilt / 2, twist / 2];
  // Rz(β) Ry(θ) Rz(χ − β), real part first.
  const rotation: Rotation = [
    Math.cos(half) * Math.cos(turn),
    -Math.sin(half) * Math.sin(azimuth - turn),
    Math.sin(half) * Math.cos(azimuth - turn),
    Math.cos(half) * Math.sin(turn),
  ];
  const centre: Triple = [
    x + across * Math.cos(azimuth),
    y + across * Math.sin(azimuth),
    height + radius * Math.sin(tilt),
  ];
  return { rotation, centre };
}

function mix(a: number, b: number, part: number): number {
  return part === 0 ? a : a + (b - a) * part;
}

const NEARLY_ONE = 1 - 1e-10; // cosine above which the sine of the angle is lost in rounding

/** Return the rotation this part of the shorter way from `a` to `b`. */
export function slerp(a: Rotation, b: Rotation, part: number): Rotation {
  if (part === 0) return a;
  const cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const side = cosine < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(1, side * cosine));
  const even = side * cosine > NEARLY_ONE;
  const p = even ? 1 - part : Math.sin((1 - part) * angle) / Math.sin(angle);
  const q = side * (even ? part : Math.sin(part * angle) / Math.sin(angle));
  const sum: Rotation = [p * a[0] + q * b[0], p * a[1] + q * b[1], p * a[2] + q * b[2], p * a[3] + q * b[3]];
  const length = Math.hypot(...sum);
  return [sum[0] / length, sum[1] / length, sum[2] / length, sum[3] / length];
}
