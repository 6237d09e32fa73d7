import assert from "node:assert/strict";
import { test } from "node:test";
import { extentBeside, extentOf } from "../../src/viewer/extent";
import { spaced } from "../../src/viewer/figure-labels";
import { leaningMoment, momentAt } from "../../src/viewer/moment";
import { tiltOf } from "../../src/viewer/attitude";
import { rolling } from "./made-up";

test("two columns side by side have their rooms apart, on one slab that holds both", () => {
  const motion = rolling();
  const small = { ...motion, column: { ...motion.column, radius: 0.2, top_radius: 0.2, height: 2 } };
  for (const [one, other] of [
    [motion, small],
    [small, motion],
  ] as const) {
    const [first, second] = [extentOf(one), extentOf(other)];
    const { extent, place } = extentBeside(first, second);
    assert.ok(place + second.room.low[0] > first.room.high[0]);
    assert.ok(extent.slab[0] <= first.slab[0] && extent.slab[2] >= place + second.slab[2]);
    assert.deepEqual([extent.room.low[0], extent.room.high[0]], [first.room.low[0], place + second.room.high[0]]);
  }
});

test("words that would overlap are moved apart, and stay in the picture", () => {
  assert.deepEqual(spaced([100, 300], [40, 40], 400), [100, 300]);
  const [a, b] = spaced([190, 210], [40, 60], 400) as [number, number];
  assert.ok(b - a >= 100 && a >= 40 && b <= 340);
  const [c, d] = spaced([210, 190], [40, 60], 400) as [number, number];
  assert.ok(c - d >= 100);
  assert.deepEqual(spaced([5], [40], 400), [40]);
});

test("a column that is leaned as it leans already stands where it stood", () => {
  const motion = rolling();
  const moment = momentAt(motion, 7);
  const leaned = leaningMoment(motion, 7, tiltOf(moment.rotation));
  for (const name of ["rotation", "centre", "contact"] as const)
    leaned[name].forEach((value, k) => assert.ok(Math.abs(value - moment[name][k]!) < 2e-5, name));
});
