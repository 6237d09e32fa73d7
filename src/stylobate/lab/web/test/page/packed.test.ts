import assert from "node:assert/strict";
import { test } from "node:test";
import { unpacked } from "../../src/page/server/packed";

test("packed lists are read at any depth, and all else stays", () => {
  const answer = {
    outcome: "ROLLING",
    series: { time: { packed: [[1, 2, [0, 5, 0, 0]]], rows: false }, azimuth: [null, 0.5] },
    branches: [
      {
        tilt: {
          packed: [
            [0, 0, [1, 2]],
            [2, 1, [314, -628]],
          ],
          rows: true,
        },
      },
    ],
    summary: [["label", "text"]],
  };
  assert.deepEqual(unpacked(answer), {
    outcome: "ROLLING",
    series: { time: [0, 0.5, 1, 1.5], azimuth: [null, 0.5] },
    branches: [
      {
        tilt: [
          [1, 3.14],
          [2, -3.14],
        ],
      },
    ],
    summary: [["label", "text"]],
  });
});

test("numbers are those of their decimals, to the last bit", () => {
  assert.deepEqual(unpacked({ packed: [[7, 0, [3, 1234567, 28980393]]], rows: false }), [3e-7, 0.1234567, 2.8980393]);
});
