import assert from "node:assert/strict";
import { test } from "node:test";
import { labelPlace } from "../../src/page/charts/response-plot";
import { edgeOf } from "../../src/page/motion/shares";

test("variations that all end alike are no edge, and those that differ are one", () => {
  const line = (...outcomes: ("OVERTURNED" | "SURVIVED")[]): string => edgeOf({ outcomes });
  assert.match(line("OVERTURNED", "OVERTURNED"), /^All 2 .* far from the edge/);
  assert.match(line("SURVIVED", "SURVIVED"), /^None of 2 .* not at the edge/);
  assert.match(line("OVERTURNED", "SURVIVED", "SURVIVED"), /^1 of 3 .* probability/);
});

test("a label stands to the right of its line, to the left of it, or beyond the marker, whichever is free", () => {
  const place = (x: number, marked: number | null, width = 80) => {
    const { at, align } = labelPlace(x, width, [0, 400], marked, 5);
    return `${align} ${at}`;
  };
  assert.equal(place(200, null), "left 205");
  assert.equal(place(200, 300), "left 205");
  assert.equal(place(200, 150), "left 205");
  assert.equal(place(200, 240), "right 195");
  assert.equal(place(350, null), "right 345");
  assert.equal(place(40, 60), "left 70"); // to the left it has no room
  assert.equal(place(40, 60, 345), "left 45"); // nowhere
});
