import assert from "node:assert/strict";
import { test } from "node:test";
import {
  niceAbove,
  niceBelow,
  POSITIONS,
  positionOf,
  scaleAbout,
  scaleBetween,
  ticks,
  valueAt,
} from "../../src/page/case/ranges";

const SCALES = [
  scaleBetween(0, 0.5),
  scaleBetween(-0.2, 0.2),
  scaleBetween(0.001, 20),
  scaleAbout(157.08, 1),
  scaleAbout(0, 10),
];

test("a slider that is put where a value stands gives that value to a step", () => {
  for (const scale of SCALES) {
    for (let position = 0; position <= POSITIONS; position += 1) {
      assert.ok(
        Math.abs(positionOf(valueAt(position, scale), scale) - position) <= 1,
        `${position} of ${JSON.stringify(scale)}`,
      );
    }
  }
});

test("the values of a slider rise with its position", () => {
  for (const scale of SCALES) {
    const values = Array.from({ length: POSITIONS + 1 }, (_, position) => valueAt(position, scale));
    values.slice(1).forEach((value, i) => assert.ok(value > values[i]!, `${value} after ${values[i]}`));
  }
});

test("the ends of a slider are exact, and what lies beyond them stands at them", () => {
  for (const scale of SCALES) {
    assert.equal(valueAt(0, scale), scale.from);
    assert.equal(valueAt(POSITIONS, scale), scale.to);
    assert.equal(positionOf(scale.to * 100 + 1, scale), POSITIONS);
    assert.equal(positionOf(scale.from - 1000, scale), 0);
  }
});

test("a slider about a value holds it, away from both ends", () => {
  for (const value of [1e-6, 0.05, 1, 3.5, 157.08, 2700]) {
    const position = positionOf(value, scaleAbout(value, 1));
    assert.ok(position > POSITIONS / 5 && position < (4 * POSITIONS) / 5, `${value} at ${position}`);
  }
});

test("the middle of an even slider about zero is zero, and not minus zero", () => {
  assert.ok(Object.is(valueAt(POSITIONS / 2, scaleBetween(-0.2, 0.2)), 0));
});

test("nice numbers hold a value between them and are at most 2.5 times apart", () => {
  for (let value = 1e-7; value < 1e7; value *= 1.07) {
    const [below, above] = [niceBelow(value), niceAbove(value)];
    assert.ok(below <= value * (1 + 1e-9) && value <= above * (1 + 1e-9), `${below} ${value} ${above}`);
    assert.ok(above / below <= 2.5 + 1e-9, `${below} ${above}`);
  }
  for (const nice of [0.001, 0.02, 0.5, 1, 200]) assert.deepEqual([niceBelow(nice), niceAbove(nice)], [nice, nice]);
});

test("ticks are round, equally far apart and within the range", () => {
  assert.deepEqual(ticks(0.5, 6, 5), [2, 4, 6]);
  assert.deepEqual(ticks(-0.1, 0.1, 4), [-0.1, -0.05, 0, 0.05, 0.1]);
  assert.deepEqual(ticks(1, 1, 4), []);
});
