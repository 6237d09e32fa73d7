/** Tilt, twist and spin of a body from its rotation Rz(β) Ry(θ) Rz(χ − β). */

import type { Pair, Rotation, Triple } from "./drawn-motion";

/** Return the axis of the body: third column of the rotation matrix. */
export function axisOf([w, x, y, z]: Rotation): Triple {
  return [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)];
}

/** Return the tilt vector θ(cos β, sin β) [rad]. */
export function tiltOf(rotation: Rotation): Pair {
  const [ax, ay, az] = axisOf(rotation);
  const across = Math.hypot(ax, ay);
  const scale = across === 0 ? 1 : Math.atan2(across, az) / across;
  return [ax * scale, ay * scale];
}

/** Return the twist χ [rad] that is `near` this one: a rotation fixes it up to whole turns. */
export function twistOf([w, , , z]: Rotation, near: number): number {
  const twist = 2 * Math.atan2(z, w); // half the sum of the angles about z, β + (χ − β)
  return twist + 2 * Math.PI * Math.round((near - twist) / (2 * Math.PI));
}

/** Return the mean rate about the body's own axis [rad/s] of a turn from `a` to `b` at an even rate. */
export function spinBetween(a: Rotation, b: Rotation, elapsed: number): number {
  // a⁻¹ b: the turn as the body sees it.
  const w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const x = a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2];
  const y = a[0] * b[2] - a[2] * b[0] - a[3] * b[1] + a[1] * b[3];
  const z = a[0] * b[3] - a[3] * b[0] - a[1] * b[2] + a[2] * b[1];
  const side = w < 0 ? -1 : 1;
  const sine = Math.hypot(x, y, z);
  if (sine === 0 || elapsed === 0) return 0;
  return ((2 * Math.atan2(sine, side * w)) / (sine * elapsed)) * side * z;
}
