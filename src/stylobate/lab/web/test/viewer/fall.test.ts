import assert from "node:assert/strict";
import { test } from "node:test";
import { axisOf, tiltOf } from "../../src/viewer/attitude";
import { type DrawnMotion, drawable } from "../../src/viewer/drawn-motion";
import { azimuthAtEnd, isFalling, lyingTilt, withFall } from "../../src/viewer/fall";
import { RADIUS, rolling } from "./made-up";

const P = 1.7; // rad/s

/** The column that rolls, as if it had overturned at the end of its motion: beyond the tilt α = atan c. */
function overturned(taper = 0.05): DrawnMotion {
  const motion = rolling();
  const column = { ...motion.column, top_radius: RADIUS - taper, slenderness: 0.03 };
  return { ...motion, column, outcome: "OVERTURNED" };
}

test("only a column that overturned falls, and what was computed stays as it was", () => {
  const motion = rolling();
  assert.equal(withFall(motion, P), motion);
  const before = overturned();
  const after = drawable(withFall(before, P));
  assert.ok(isFalling(after) && after.computed_until === before.time.at(-1));
  for (const name of ["time", "tilt", "rotation", "centre", "base"] as const)
    assert.deepEqual(after[name].slice(0, before.time.length), before[name], name);
});

test("a column falls about the point of the rim that touched last, in the plane in which it leaned", () => {
  const after = withFall(overturned(), P);
  const azimuth = azimuthAtEnd(overturned());
  const rim = after.contact_point.at(-1)!;
  for (let i = 401; i < after.time.length; i += 1) {
    const axis = axisOf(after.rotation[i]!);
    const centre = after.centre[i]!;
    const tilt = Math.acos(axis[2]);
    // From the rim to the centre of the bottom: a radius, at right angles to the axis.
    const [x, z] = [-RADIUS * Math.cos(tilt), RADIUS * Math.sin(tilt)];
    assert.ok(Math.abs(centre[0] - rim[0] - x * Math.cos(azimuth)) < 1e-12);
    assert.ok(Math.abs(centre[1] - rim[1] - x * Math.sin(azimuth)) < 1e-12);
    assert.ok(Math.abs(centre[2] - z) < 1e-12);
    const [tx, ty] = tiltOf(after.rotation[i]!);
    assert.ok(Math.abs(Math.atan2(ty, tx) - Math.atan2(Math.sin(azimuth), Math.cos(azimuth))) < 1e-9);
  }
});

for (const taper of [0.05, 0, -0.2]) {
  test(`a column whose top is ${taper} m narrower ends with its side on the base`, () => {
    const motion = withFall(overturned(taper), P);
    const tilt = Math.hypot(...motion.tilt.at(-1)!);
    assert.ok(Math.abs(tilt - lyingTilt(motion)) < 1e-12);
    const { column, centre, rotation } = motion;
    const axis = axisOf(rotation.at(-1)!);
    const lowestOfTop = centre.at(-1)![2] + column.height * axis[2] - column.top_radius * Math.sqrt(1 - axis[2] ** 2);
    assert.ok(Math.abs(lowestOfTop) < 1e-12, `${lowestOfTop}`);
  });
}

test("energy is kept in the fall, to the first order of its step", () => {
  const motion = withFall(overturned(), P);
  const tilts = motion.tilt.slice(400).map(([x, y]) => Math.hypot(x, y));
  const step = motion.time.at(-1)! - motion.time.at(-2)!;
  const alpha = Math.atan(motion.column.slenderness);
  const potential = (tilt: number): number => P * P * Math.cos(tilt - alpha);
  for (let i = 1; i + 1 < tilts.length - 1; i += 1) {
    const rate = (tilts[i + 1]! - tilts[i - 1]!) / (2 * step);
    const energy = 0.5 * rate * rate + potential(tilts[i]!) - potential(tilts[0]!);
    assert.ok(Math.abs(energy) < 0.02 * P * P, `${energy} at ${tilts[i]}`);
  }
});

test("a column that leans back at its end is not made to fall", () => {
  const motion = overturned();
  const back = { ...motion, column: { ...motion.column, slenderness: 0.5 } };
  assert.equal(withFall(back, P), back);
});
