import assert from "node:assert/strict";
import { test } from "node:test";
import type { Description } from "../../src/page/case/description";
import { inOnePlane } from "../../src/page/case/in-one-plane";
import { atScaleOf } from "../../src/page/case/scaling";
import { VIEW } from "./case";

const CASE = VIEW.description;
const STONE: Description = {
  ...CASE,
  column: { shape: "solid", radius: 0.25, height: 5, density: 2700, gravity: 9.81 },
};

/** Acceleration over c g, the start over c, and frequency times duration: what a change of scale leaves as it is. */
function similarity({ motion, tilt, duration }: Description, c: number, g: number): readonly number[] {
  const [x] = tilt as readonly number[];
  return [Number(motion["acceleration"]) / (c * g), x! / c, Number(motion["angular_frequency"]) * Number(duration)];
}

test("a column with lengths takes over the motion of one without in units of its own", () => {
  const found = atScaleOf(STONE, CASE);
  const before = similarity(CASE, 0.1, 1);
  similarity(found, 0.1, 9.81).forEach((value, i) => {
    // Numbers are rounded to three digits, and two of them meet in the last.
    assert.ok(Math.abs(value / before[i]! - 1) < 0.011, `${value} ${before[i]}`);
  });
});

test("columns with lengths leave the base as it moves, and so does a motion that is not given by its acceleration", () => {
  const other = { ...STONE, column: { ...STONE.column, shape: "hollow", inner_radius: 0.2 } };
  assert.equal(atScaleOf(other, STONE), other);
  const orbit = { kind: "orbit", diameter: 0.012, rpm: 200 };
  assert.equal(atScaleOf({ ...STONE, motion: orbit }, { ...CASE, motion: orbit }).motion, orbit);
});

test("a case for a model that rocks in a plane lies in that plane", () => {
  const found = inOnePlane({ ...CASE, spin: 2 });
  assert.deepEqual(found["tilt"], [0.0386, 0]);
  assert.deepEqual(found["tilt_rate"], [-0.0075, 0]);
  assert.deepEqual(found.motion, { kind: "straight", acceleration: 0.065, angular_frequency: 1.8 });
  assert.equal(found["spin"], undefined);
  const shaken = inOnePlane({ ...CASE, motion: { kind: "orbit", diameter: 0.01, rpm: 60 } });
  assert.deepEqual(shaken.motion, { kind: "stroke", stroke: 0.01, frequency: 1 });
});
