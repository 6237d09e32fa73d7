import assert from "node:assert/strict";
import { test } from "node:test";
import { extremesOf } from "../../src/kernels/extremes";

const FREQUENCY = 9;
const END = (200 * Math.PI) / FREQUENCY;
const times = (many: number): number[] => Array.from({ length: many }, (_, k) => (k * END) / (many - 1));
const humps = (time: readonly number[]) => ({ humps: time.map((one) => Math.abs(Math.sin(FREQUENCY * one))) });

// Ten samples in each hump, and half a sample: both would show beats.
for (const many of [2000, 100]) {
  test(`${many} samples of 200 humps have each minimum, which is zero, and each maximum, which is one`, () => {
    const time = times(many);
    const found = extremesOf(humps, time, FREQUENCY)["humps"]!;
    const curve = [...time.map((one, k): readonly [number, number] => [one, humps(time).humps[k]!]), ...found];
    for (let part = 0; part < 50; part += 1) {
      const inside = curve.filter(([one]) => one >= (part * END) / 50 && one <= ((part + 1) * END) / 50);
      const values = inside.map(([, value]) => value);
      assert.ok(Math.min(...values) < 1e-3, `part ${part}: ${Math.min(...values)}`);
      assert.ok(Math.max(...values) > 1 - 1e-3);
    }
  });
}

test("what is level but for rounding has no extremes", () => {
  const level = (time: readonly number[]) => ({ level: time.map((one) => 0.3 + 1e-13 * Math.sin(1e5 * one)) });
  assert.deepEqual(extremesOf(level, times(500), FREQUENCY), {});
});

test("gaps and infinities are passed over", () => {
  const gaps = (time: readonly number[]) => ({
    gaps: time.map((one) => (Math.sin(one) > 0.9 ? null : Math.sin(one) < -0.9 ? Infinity : Math.cos(3 * one))),
  });
  const found = extremesOf(gaps, times(500), FREQUENCY)["gaps"]!;
  assert.ok(found.length > 0 && found.every(([, value]) => Number.isFinite(value)));
});
