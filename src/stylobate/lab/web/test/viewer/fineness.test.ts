import assert from "node:assert/strict";
import { test } from "node:test";
import { finenessOf } from "../../src/viewer/renderer";

const PHONE = 390 * 190;
const DESKTOP = 640 * 280;

test("a picture is as fine as the screen of a phone, and not finer than can be filled", () => {
  assert.deepEqual(finenessOf(PHONE, 3, false), { moving: 3, still: 3 });
  assert.deepEqual(finenessOf(PHONE, 4, false), { moving: 3, still: 3 });
  const { moving } = finenessOf(2560 * 1300, 3, false);
  assert.ok(moving > 1.5 && moving < 2);
});

test("a processor draws a phone's picture finely, and a large one as coarsely as before while it moves", () => {
  assert.ok(finenessOf(PHONE, 3, true).moving > 2);
  assert.deepEqual(finenessOf(DESKTOP, 1, true), { moving: 1, still: 2 });
  assert.equal(finenessOf(2560 * 1300, 2, true).moving, 1);
});
