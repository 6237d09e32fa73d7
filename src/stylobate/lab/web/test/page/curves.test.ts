import assert from "node:assert/strict";
import { test } from "node:test";
import { indexAfter, tiltAt } from "../../src/page/charts/orbit";
import { continuous, heightOf, linesOf } from "../../src/page/charts/response-lines";
import type { DrawnMotion } from "../../src/viewer/drawn-motion";

const BRANCH = {
  sense: "anticlockwise",
  branch: "upper",
  amplitude: [0.1, 0.08, 0.06, null],
  phase: [0, -1, -2, null],
  stable: [false, false, true, null],
};
const CURVES = {
  angular_frequency: [1, 2, 3, 4],
  branches: [BRANCH],
  backbone: [0.1, 0.1, 0.1, 0.1],
  critical: [],
  averaged: false,
};

test("every point of a branch is drawn, and the unstable part joins the stable one", () => {
  const [stable, unstable] = linesOf(CURVES, 0.1);
  assert.deepEqual(
    stable!.amplitude.map((value) => value !== null),
    [false, false, true, false],
  );
  assert.deepEqual(
    unstable!.amplitude.map((value) => value !== null),
    [true, true, true, false],
  );
});

test("two senses that are alike are one line, and those that differ are two", () => {
  const other = { ...BRANCH, sense: "clockwise" };
  const alike = linesOf({ ...CURVES, branches: [BRANCH, other] }, 0.1);
  assert.deepEqual(new Set(alike.map((one) => one.sense)), new Set(["both senses"]));
  const apart = linesOf({ ...CURVES, branches: [BRANCH, { ...other, amplitude: [0.1, 0.08, 0.05, null] }] }, 0.1);
  assert.deepEqual(new Set(apart.map((one) => one.sense)), new Set(["anticlockwise", "clockwise"]));
});

test("a phase that passes half a turn goes on", () => {
  const turned = continuous([3, -3, null, -2.5]).map((value) => value && Number(value.toFixed(3)));
  assert.deepEqual(turned, [3, 3.283, null, 3.783]);
});

test("the axis of amplitudes reaches a little beyond the highest point and never far beyond c", () => {
  const lines = linesOf(CURVES, 0.1);
  assert.ok(heightOf(lines) > 1 && heightOf(lines) < 1.25);
  assert.equal(heightOf(linesOf(CURVES, 0.001)), 1.25);
});

test("the dot of the orbit stands where the motion is, and at its ends before and after", () => {
  const motion = {
    time: [0, 1, 3],
    tilt: [
      [0, 0],
      [1, 2],
      [3, -2],
    ],
  } as unknown as DrawnMotion;
  assert.deepEqual(
    [tiltAt(motion, 0.5), tiltAt(motion, 2), tiltAt(motion, 3), tiltAt(motion, -1), tiltAt(motion, 9)],
    [
      ...[
        [0.5, 1],
        [2, 0],
        [3, -2],
        [0, 0],
        [3, -2],
      ],
    ],
  );
  assert.deepEqual([indexAfter([0, 1, 3], 1), indexAfter([0, 1, 3], 2.9), indexAfter([], 1)], [2, 2, 0]);
});
