import assert from "node:assert/strict";
import { test } from "node:test";
import { axisOf, spinBetween, tiltOf, twistOf } from "../../src/viewer/attitude";
import { attitudeAt, rotationTo } from "./made-up";

const ROUNDING = 1e-13;

function near(value: number, expected: number, tolerance = ROUNDING): void {
  assert.ok(Math.abs(value - expected) <= tolerance, `${value} is not ${expected} to ${tolerance}`);
}

test("the tilt vector of a rotation is the angle towards the azimuth it was made of", () => {
  for (const t of [0, 0.4, 3, 11, 40]) {
    const attitude = attitudeAt(t);
    const [x, y] = tiltOf(rotationTo(attitude));
    near(x, attitude.angle * Math.cos(attitude.azimuth));
    near(y, attitude.angle * Math.sin(attitude.azimuth));
  }
});

test("the tilt is found beyond a right angle, and is zero upright", () => {
  near(Math.hypot(...tiltOf(rotationTo({ azimuth: 1, angle: 2.5, twist: 0.3 }))), 2.5);
  assert.deepEqual(tiltOf([1, 0, 0, 0]), [0, 0]);
});

test("the twist comes back with its whole turns, whichever sign the quaternion has", () => {
  for (const twist of [-9.3, -0.2, 0, 3.5, 25.1]) {
    const rotation = rotationTo({ azimuth: 0.8, angle: 0.3, twist });
    near(twistOf(rotation, twist + 1), twist);
    near(twistOf([-rotation[0], -rotation[1], -rotation[2], -rotation[3]], twist - 1), twist);
  }
});

test("the axis has unit length", () => {
  near(Math.hypot(...axisOf(rotationTo({ azimuth: 2, angle: 0.7, twist: 5 }))), 1);
});

test("a body that turns about its own axis has that spin, however it leans", () => {
  const [from, to] = [0.2, 0.9].map((twist) => rotationTo({ azimuth: 1.1, angle: 0.6, twist })) as [never, never];
  near(spinBetween(from, to, 0.1), 7);
});

test("the spin of rolling round the rim without twist is (1 − cos θ) β̇ backwards, to the second order of the step", () => {
  // w3 = χ̇ − β̇ + β̇ cos θ
  const error = (step: number): number => {
    const at = (t: number) => rotationTo({ azimuth: 2 * t, angle: 0.4, twist: 0 });
    return Math.abs(spinBetween(at(-step / 2), at(step / 2), step) + 2 * (1 - Math.cos(0.4)));
  };
  assert.ok(error(0.1) < 1e-2);
  near(error(0.1) / error(0.05), 4, 0.1);
});
