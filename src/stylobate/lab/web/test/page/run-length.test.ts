import assert from "node:assert/strict";
import { test } from "node:test";
import type { Description } from "../../src/page/case/description";
import { angularFrequency } from "../../src/page/case/frequency";
import { keyOf } from "../../src/page/plane/planes";
import { withValue } from "../../src/page/case/quantities";
import { lengthOf, withLength } from "../../src/page/case/run-length";
import { VIEW } from "./case";

const CASE = VIEW.description;
const AXIS = { from: 0.5, to: 5, number: 64 };
const PLANE = { x: { name: "angular_frequency", ...AXIS }, y: { name: "acceleration", ...AXIS } };

const TILTS = { x: { name: "tilt_x", ...AXIS }, y: { name: "tilt_y", ...AXIS } };
const SCALES = { slenderness: 0.1, frequency_scale: 1 };
const lengthIn = (kind: "map" | "basin", of: Description, plane = PLANE, scales = SCALES) =>
  lengthOf(kind, of, plane, scales);
const chosenIn = (kind: "map" | "basin", of: Description, chosen: Description, longest = Infinity) =>
  withLength(lengthIn(kind, of), chosen, longest);
const keyIn = (of: Description) => keyOf(of, PLANE, lengthIn("map", of));

const periodsIn = ({ motion, duration }: Description): number =>
  (Number(duration) * angularFrequency(motion)!) / (2 * Math.PI);

test("a motion that is chosen in a plane lasts as many periods as the runs of the plane, whatever its frequency", () => {
  for (const kind of ["map", "basin"] as const) {
    for (const duration of [1, 60, 900]) {
      const of = { ...CASE, duration };
      for (const frequency of [0.6, 1.8, 4.9]) {
        const found = chosenIn(kind, of, withValue(of, "angular_frequency", frequency));
        const wanted = Number(lengthIn(kind, of)["periods"]);
        assert.ok(Math.abs(periodsIn(found) / wanted - 1) < 1e-5, `${kind} ${duration} s at ${frequency} rad/s`);
      }
    }
  }
});

test("a map stays that of its case when a motion is chosen in it, and another in that", () => {
  for (const duration of [60, 907]) {
    let chosen: Description = { ...CASE, duration };
    const key = keyIn(chosen);
    for (const frequency of [0.5, 4.937, 1.234567, 5]) {
      chosen = chosenIn("map", chosen, withValue(chosen, "angular_frequency", frequency));
      assert.equal(keyIn(chosen), key, `${duration} s, ${frequency} rad/s`);
    }
  }
});

test("a map follows rolling until it has settled, other motions for sixty periods, and a longer case as it lasts", () => {
  const slow = { x: { ...PLANE.x, to: 3 }, y: PLANE.y };
  assert.deepEqual(lengthIn("map", CASE, slow), { duration: null, periods: 200 });
  const thrown = { ...CASE, motion: { kind: "vertical", acceleration: 2, angular_frequency: 30 }, duration: 1 };
  assert.deepEqual(lengthIn("map", thrown), { duration: null, periods: 60 });
  const long = { ...CASE, duration: 9000 };
  assert.ok(Math.abs(Number(lengthIn("map", long)["periods"]) / periodsIn(long) - 1) < 1e-3);
});

test("a start that is chosen in a basin leaves the map of the case as it is", () => {
  const chosen = chosenIn("map", CASE, CASE);
  const start = chosenIn("basin", chosen, withValue(chosen, "tilt_x", 0.05));
  assert.equal(start["duration"], chosen["duration"]);
});

test("under a motion that has no period the runs of a plane last as long as the case, and so does what is chosen", () => {
  const pulse = { ...CASE, motion: { kind: "half_sine", acceleration: 1, angular_frequency: 3 } };
  assert.deepEqual(lengthIn("map", pulse), { duration: 60 });
  assert.equal(chosenIn("map", pulse, withValue(pulse, "angular_frequency", 5))["duration"], 60);
  const record = { ...CASE, motion: { kind: "record", sample: "el centro 1940" }, duration: null };
  assert.deepEqual(lengthIn("basin", record), { duration: null });
});

test("a run that is chosen is no longer than the server computes", () => {
  const slow = withValue(CASE, "angular_frequency", 0.01);
  assert.equal(chosenIn("basin", CASE, slow, 3600)["duration"], 3600);
});

test("where forty decay times of the column last longer than 200 periods, runs last as long, at the highest frequency", () => {
  const decays = (frequency: number, damping: number, scale = 1) =>
    Math.ceil((40 * frequency) / (damping * scale * 2 * Math.PI));
  assert.equal(lengthIn("map", CASE)["periods"], decays(5, 0.1));
  assert.equal(lengthIn("map", CASE, PLANE, { ...SCALES, frequency_scale: 0.5 })["periods"], decays(5, 0.1, 0.5));
  assert.equal(lengthIn("basin", withValue(CASE, "angular_frequency", 6), TILTS)["periods"], decays(6, 0.1));
  const damped = { x: PLANE.x, y: { name: "damping", from: 0, to: 0.5, number: 11 } };
  assert.equal(lengthIn("map", CASE, damped)["periods"], decays(5, 0.05));
  assert.equal(lengthIn("map", withValue(CASE, "damping", 0.001))["periods"], 1000);
  assert.equal(lengthIn("map", withValue(CASE, "damping", 0))["periods"], 200);
});
