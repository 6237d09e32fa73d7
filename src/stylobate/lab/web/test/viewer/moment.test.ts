import assert from "node:assert/strict";
import { test } from "node:test";
import { drawable, type DrawnMotion } from "../../src/viewer/drawn-motion";
import { momentAt, placeOf, slerp } from "../../src/viewer/moment";
import { attitudeAt, RADIUS, rolling, rotationTo } from "./made-up";

test("at a sample a moment is that sample, exactly", () => {
  const motion = rolling();
  for (const i of [0, 1, 57, 400]) {
    const moment = momentAt(motion, motion.time[i]!);
    assert.deepEqual(moment.rotation, motion.rotation[i]);
    assert.deepEqual(moment.centre, motion.centre[i]);
    assert.deepEqual(moment.contact, motion.contact_point[i]);
    assert.deepEqual(moment.base, motion.base[i]);
  }
});

test("before the first sample and after the last the motion stands", () => {
  const motion = rolling();
  assert.deepEqual(momentAt(motion, -5).centre, motion.centre[0]);
  assert.deepEqual(momentAt(motion, 500).centre, motion.centre[400]);
});

test("a place lies between the samples about it", () => {
  const times = [0, 1, 3, 7];
  assert.deepEqual(placeOf(times, 2), { index: 1, part: 0.5 });
  assert.deepEqual(placeOf(times, 6), { index: 2, part: 0.75 });
  assert.deepEqual(placeOf([4], 9), { index: 0, part: 0 });
});

test("between samples rotation and contact are right to the second order of the step", () => {
  const [coarse, fine] = [101, 201].map((samples) => {
    const motion = rolling(samples);
    const errors = motion.time.slice(1).map((end, i) => errorsAt(motion, 0.5 * (motion.time[i]! + end)));
    return [0, 1].map((k) => Math.max(...errors.map((error) => error[k]!)));
  }) as [number[], number[]];
  for (const k of [0, 1]) {
    assert.ok(fine[k]! < 5e-3, `error ${fine[k]}`);
    const order = Math.log2(coarse[k]! / fine[k]!);
    assert.ok(Math.abs(order - 2) < 0.1, `order ${order}`);
  }
});

function errorsAt(motion: DrawnMotion, time: number): [rotation: number, contact: number] {
  const moment = momentAt(motion, time);
  const exact = attitudeAt(time);
  const turned = rotationTo(exact).map((value, k) => value - moment.rotation[k]!);
  const [x, y] = [RADIUS * Math.cos(exact.azimuth), RADIUS * Math.sin(exact.azimuth)];
  return [Math.hypot(...turned), Math.hypot(moment.contact[0] - x, moment.contact[1] - y)];
}

test("slerp keeps unit length, goes at an even rate and takes the shorter way", () => {
  const [from, to] = [0, 1].map((twist) => rotationTo({ azimuth: 0.3, angle: 0.2, twist })) as [never, never];
  const third = slerp(from, to, 1 / 3);
  const exact = rotationTo({ azimuth: 0.3, angle: 0.2, twist: 1 / 3 });
  third.forEach((value, k) => assert.ok(Math.abs(value - exact[k]!) < 1e-14));
  const other = slerp(from, (to as number[]).map((value) => -value) as never, 1 / 3);
  other.forEach((value, k) => assert.ok(Math.abs(value - exact[k]!) < 1e-14));
});

test("a motion that cannot be drawn is refused in one line that names what is wrong", () => {
  const motion = rolling(11);
  assert.throws(() => drawable({ ...motion, time: [] }), /time must hold one sample at least/);
  assert.throws(
    () => drawable({ ...motion, centre: motion.centre.slice(1) }),
    /centre must have a sample for each of the 11 times, got 10/,
  );
  assert.throws(
    () => drawable({ ...motion, column: { ...motion.column, radius: -1 } }),
    /column.radius must be positive, got -1/,
  );
  assert.equal(drawable(motion), motion);
});
