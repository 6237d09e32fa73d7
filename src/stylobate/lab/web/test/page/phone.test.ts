import assert from "node:assert/strict";
import { test } from "node:test";
import { type Felt, tableOf } from "../../src/page/controls/phone";

/** A phone that reports every 17 ms, lies still for half a second, and is then tilted more and more. */
const felt: readonly Felt[] = Array.from({ length: 180 }, (_, k) => {
  const time = 3 + 0.017 * k;
  return { time, x: 0.3 + 2 * Math.max(0, time - 3.5), y: -0.1 };
});

test("the record of a phone begins at rest and has what the phone feels at equal steps", () => {
  const [head, ...lines] = tableOf(felt).trimEnd().split("\n");
  assert.equal(head, "time [s],x [m/s2],y [m/s2]");
  const rows = lines.map((line) => line.split(",").map(Number));
  assert.equal(rows.length, Math.floor((179 * 0.017) / 0.02) + 1);
  rows.forEach(([time = NaN, x = NaN, y = NaN], k) => {
    assert.ok(Math.abs(time - 0.02 * k) < 1e-9);
    assert.ok(Math.abs(x - 2 * Math.max(0, time - 0.5)) < 0.02, `at ${time}`); // linear across the corner
    assert.equal(y, 0);
  });
});

test("lost reports are bridged by a line", () => {
  const rows = tableOf([felt[0]!, felt[10]!, felt[170]!]).trimEnd().split("\n").slice(1);
  const middle = rows[Math.floor(rows.length / 2)]!.split(",").map(Number);
  const whole = felt[170]!.x - felt[10]!.x;
  assert.ok(middle[1]! > 0.3 * whole && middle[1]! < 0.7 * whole);
});
