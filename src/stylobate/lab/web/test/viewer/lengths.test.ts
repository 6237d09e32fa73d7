import assert from "node:assert/strict";
import { test } from "node:test";
import { lengthInWords, roundLength } from "../../src/viewer/lengths";

test("round lengths are 1, 2, 5 of a decade, the next from below", () => {
  const pairs = [
    [0.13, 0.2],
    [0.2, 0.2],
    [0.21, 0.5],
    [0.6, 1],
    [7, 10],
    [0.0034, 0.005],
  ] as const;
  for (const [length, round] of pairs) assert.ok(Math.abs(roundLength(length) / round - 1) < 1e-12, `${length}`);
});

test("lengths are written in the unit that needs no zeros", () => {
  const words = [
    [0.5, "0.5 m"],
    [10, "10 m"],
    [0.02, "2 cm"],
    [0.005, "5 mm"],
    [2000, "2 km"],
    [2e-5, "20 µm"],
  ] as const;
  for (const [length, text] of words) assert.equal(lengthInWords(length), text);
});
