import assert from "node:assert/strict";
import { test } from "node:test";
import type { Pair } from "../../src/viewer/drawn-motion";
import { isNear, pulledTilt, wayOnBase } from "../../src/viewer/pull";

const close = (found: Pair, wanted: Pair): void =>
  found.forEach((value, k) => assert.ok(Math.abs(value - wanted[k]!) < 1e-12, `${found} is not ${wanted}`));

test("a way to the right of the screen goes to the camera's right, one up the screen away from it", () => {
  close(wayOnBase([2, 0], [1, 0], 0.5), [2, 0]);
  close(wayOnBase([0, -2], [1, 0], 0.5), [0, 4]);
  // Seen from the side of +x, the screen's right is +y, and away is −x.
  close(wayOnBase([2, -1], [0, 1], 0.5), [-2, 2]);
  close(wayOnBase([0, -3], [1, 0], 0), wayOnBase([0, -3], [1, 0], 0.1));
});

test("a column leans as far as the point that is held was pulled, up to its limit, and along its own line", () => {
  close(pulledTilt([0.01, 0], [0.1, 0.2], 10, 1, false), [0.02, 0.02]);
  const far = pulledTilt([0, 0], [3, 4], 1, 0.1, false);
  close(far, [0.06, 0.08]);
  close(pulledTilt([0.01, 0.5], [0.1, 5], 10, 1, true), [0.02, 0]);
});

test("a pointer is on a column between its points, or a little beside them", () => {
  const square: readonly Pair[] = [
    [0, 0],
    [10, 0],
    [10, 40],
    [0, 40],
    [5, 20],
  ];
  assert.ok(isNear(square, [5, 39], 0));
  assert.ok(!isNear(square, [12, 20], 1));
  assert.ok(isNear(square, [12, 20], 3));
  assert.ok(!isNear([], [0, 0], 100));
});
