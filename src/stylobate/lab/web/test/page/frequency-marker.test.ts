import assert from "node:assert/strict";
import { test } from "node:test";
import { placeOf } from "../../src/page/charts/frequency-marker";

test("a frequency beyond the range is not drawn as one at its end", () => {
  assert.deepEqual(placeOf(2, [1, 3]), { share: 0.5, side: "inside" });
  assert.deepEqual(placeOf(3, [1, 3]), { share: 1, side: "inside" });
  assert.deepEqual(placeOf(0.5, [1, 3]), { share: 0, side: "below" });
  assert.deepEqual(placeOf(4, [1, 3]), { share: 1, side: "above" });
});
