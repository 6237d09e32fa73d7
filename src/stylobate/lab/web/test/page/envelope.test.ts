import assert from "node:assert/strict";
import { test } from "node:test";
import { envelopeOf } from "../../src/page/charts/envelope";

const time = Array.from({ length: 5000 }, (_, i) => i / 50); // 100 s
const swings = (perSecond: number): number[] => time.map((t) => t * Math.sin(2 * Math.PI * perSecond * t));

test("rounding makes no swings", () => {
  assert.equal(
    envelopeOf(
      time,
      time.map((_, i) => 0.4 + (i % 2) * 1e-4),
      500,
    ),
    null,
  );
  assert.notEqual(
    envelopeOf(
      time,
      time.map((_, i) => 0.4 + (i % 2) * 1e-2),
      500,
    ),
    null,
  );
});

test("swings that can be seen one by one have no envelope", () => {
  assert.equal(envelopeOf(time, swings(0.5), 500), null);
  assert.equal(
    envelopeOf(
      time,
      time.map(() => 1),
      500,
    ),
    null,
  );
});

test("an envelope holds every value and is touched by the swings everywhere", () => {
  const values = swings(3);
  const band = envelopeOf(time, values, 500)!;
  time.forEach((t, i) => {
    const k = band.time.findIndex((end, at) => at % 2 === 1 && t <= end + 1e-9);
    assert.ok(k > 0 && band.low[k]! <= values[i]! && values[i]! <= band.high[k]!);
  });
  // Its height grows with the swings, whose ends lie between samples.
  const near = (t: number): number => 0.6 + 0.03 * t;
  band.time.forEach((t, k) => assert.ok(Math.abs(band.high[k]! - t) < near(t) && Math.abs(band.low[k]! + t) < near(t)));
});

test("where nothing is known there is no band", () => {
  const gap = swings(3).map((value, i) => (i > 1000 && i < 4000 ? null : value));
  assert.ok(envelopeOf(time, gap, 150)!.time.every((t) => t <= 22 || t >= 78));
});
