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

const periodsIn = ({ motion, duration }: Description): number =>
  (Number(duration) * angularFrequency(motion)!) / (2 * Math.PI);

test("a motion that is chosen in a plane lasts as many periods as the runs of the plane, whatever its frequency", () => {
  for (const kind of ["map", "basin"] as const) {
    for (const duration of [1, 60, 900]) {
      const of = { ...CASE, duration };
      for (const frequency of [0.6, 1.8, 4.9]) {
        const found = withLength(kind, of, withValue(of, "angular_frequency", frequency), Infinity);
        const wanted = Number(lengthOf(kind, of)["periods"]);
        assert.ok(Math.abs(periodsIn(found) / wanted - 1) < 1e-5, `${kind} ${duration} s at ${frequency} rad/s`);
      }
    }
  }
});

test("a map stays that of its case when a motion is chosen in it, and another in that", () => {
  for (const duration of [60, 907]) {
    let chosen: Description = { ...CASE, duration };
    const key = keyOf("map", chosen, PLANE);
    for (const frequency of [0.5, 4.937, 1.234567, 5]) {
      chosen = withLength("map", chosen, withValue(chosen, "angular_frequency", frequency), Infinity);
      assert.equal(keyOf("map", chosen, PLANE), key, `${duration} s, ${frequency} rad/s`);
    }
  }
});

test("a map follows rolling until it has settled, other motions for sixty periods, and a longer case as it lasts", () => {
  assert.deepEqual(lengthOf("map", CASE), { duration: null, periods: 200 });
  const thrown = { ...CASE, motion: { kind: "vertical", acceleration: 2, angular_frequency: 30 }, duration: 1 };
  assert.deepEqual(lengthOf("map", thrown), { duration: null, periods: 60 });
  const long = { ...CASE, duration: 900 };
  assert.ok(Math.abs(Number(lengthOf("map", long)["periods"]) / periodsIn(long) - 1) < 1e-3);
});

test("a start that is chosen in a basin leaves the map of the case as it is", () => {
  const chosen = withLength("map", CASE, CASE, Infinity);
  const start = withLength("basin", chosen, withValue(chosen, "tilt_x", 0.05), Infinity);
  assert.equal(start["duration"], chosen["duration"]);
});

test("under a motion that has no period the runs of a plane last as long as the case, and so does what is chosen", () => {
  const pulse = { ...CASE, motion: { kind: "half_sine", acceleration: 1, angular_frequency: 3 } };
  assert.deepEqual(lengthOf("map", pulse), { duration: 60 });
  assert.equal(withLength("map", pulse, withValue(pulse, "angular_frequency", 5), Infinity)["duration"], 60);
  const record = { ...CASE, motion: { kind: "record", sample: "el centro 1940" }, duration: null };
  assert.deepEqual(lengthOf("basin", record), { duration: null });
});

test("a run that is chosen is no longer than the server computes", () => {
  const slow = withValue(CASE, "angular_frequency", 0.01);
  assert.equal(withLength("basin", CASE, slow, 3600)["duration"], 3600);
});
