import assert from "node:assert/strict";
import { test } from "node:test";
import { labelBeside } from "../../src/page/charts/response-plot";
import { edgeOf } from "../../src/page/motion/shares";

test("variations that all end alike are no edge, and those that differ are one", () => {
  const line = (...outcomes: ("OVERTURNED" | "SURVIVED")[]): string => edgeOf({ outcomes });
  assert.match(line("OVERTURNED", "OVERTURNED"), /^All 2 .* far from the edge/);
  assert.match(line("SURVIVED", "SURVIVED"), /^None of 2 .* not at the edge/);
  assert.match(line("OVERTURNED", "SURVIVED", "SURVIVED"), /^1 of 3 .* probability/);
});

test("a label stands beside its own line where it is free, and is shorter where there is less room", () => {
  const texts = [
    { text: "critical 1.4", width: 80 },
    { text: "1.4", width: 30 },
  ];
  const label = (x: number, marked: number | null) => {
    const { text, place } = labelBeside(x, texts, [0, 400], marked, 5);
    return `${text}, ${place.align} ${place.at}`;
  };
  assert.equal(label(200, null), "critical 1.4, left 205");
  assert.equal(label(200, 300), "critical 1.4, left 205");
  assert.equal(label(200, 150), "critical 1.4, left 205");
  assert.equal(label(200, 240), "critical 1.4, right 195");
  assert.equal(label(350, null), "critical 1.4, right 345");
  assert.equal(label(40, 60), "1.4, right 35");
  assert.equal(label(20, 40), "1.4, left 25"); // nowhere free
});
