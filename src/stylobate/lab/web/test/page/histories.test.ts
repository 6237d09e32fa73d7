import assert from "node:assert/strict";
import { test } from "node:test";
import type { Answer, Series } from "../../src/page/server/answers";
import { brokenAt } from "../../src/page/frame/captioned";
import { chosenHistories, historiesOf } from "../../src/page/charts/history-kinds";

const STILL: Series = {
  time: [0, 1, 2],
  amplitude: [0, 0, 0],
  azimuth: [null, null, null],
  rolling_rate: [null, null, null],
  base_acceleration: [
    [0, 1, 0],
    [0, -1, 0],
    [0, 0.5, 0],
  ],
};

function answer(series: Partial<Series>): Answer {
  return {
    series: { ...STILL, ...series },
    column: { slenderness: 0.1 },
    drawn: { friction_coefficient: 0.4 },
  } as unknown as Answer;
}

const usual = (series: Partial<Series>) =>
  chosenHistories(historiesOf(answer(series), null), null).map((one) => one?.name);

test("only what a run tells is offered, and of the base only the directions in which it moves", () => {
  const names = historiesOf(answer({}), null).map(({ name }) => name);
  assert.deepEqual(names, ["tilt", "base_y"]);
});

test("a column that tilts shows its tilt, and what its contact must bear or else how it rolls", () => {
  const tilts = { amplitude: [0.01, 0.02, 0.05], rolling_rate: [1, 1, 1] };
  assert.deepEqual(usual(tilts), ["tilt", "rolling_rate"]);
  assert.deepEqual(usual({ ...tilts, friction_demand: [0.1, 0.2, 0.1] }), ["tilt", "friction_demand"]);
});

test("a column that slides upright shows how far it came, in the direction in which it went farthest", () => {
  const displacement = [
    [0, 0],
    [0.001, -0.004],
    [0.002, -0.012],
  ] as const;
  assert.deepEqual(usual({ displacement, friction_demand: [0, 0.4, 0.4] }), ["displacement_y", "friction_demand"]);
  assert.deepEqual(usual({ displacement, amplitude: [0, 0.05, 0] })[0], "tilt");
});

test("what is chosen is shown where the run has it, and what suits the run where not", () => {
  const offered = historiesOf(answer({ rolling_rate: [1, 1, 1] }), null);
  const names = chosenHistories(offered, ["base_y", "slip_speed"]).map((one) => one?.name);
  assert.deepEqual(names, ["base_y", "rolling_rate"]);
});

test("short lengths are told in millimetres, from where they began to where they end", () => {
  const displacement = [
    [0, 0],
    [-0.002, 0],
    [0.016, 0],
  ] as const;
  const x = historiesOf(answer({ displacement }), null).find(({ name }) => name === "displacement_x");
  assert.equal(x?.label, "x [mm]");
  assert.deepEqual(x?.values, [0, -2, 16]);
  assert.equal(x?.note, "−2 to 16 mm, at the end 16");
});

test("the rate of rolling is held against that of the base, in its own sense", () => {
  const clockwise = historiesOf(answer({ rolling_rate: [-2, -1.9, -2.1] }), 2);
  assert.equal(clockwise.find(({ name }) => name === "rolling_rate")?.level?.value, -2);
});

test("friction at the instant of lifting off hides nothing of what it was before", () => {
  const before = Array.from({ length: 200 }, () => 0.2);
  const [, demand] = historiesOf(answer({ friction_demand: [...before, 2e13] }), null);
  assert.ok((demand?.limits[1] ?? Infinity) <= 0.5);
});

test("a line that is too long is broken between words, and no word is lost", () => {
  const text = "it rolled once round in each of the last ten periods";
  const lines = brokenAt(text, (line) => line.length <= 16);
  assert.equal(lines.join(" "), text);
  assert.ok(lines.every((line) => line.length <= 16));
  assert.deepEqual(
    brokenAt("unbreakable", () => false),
    ["unbreakable"],
  );
});
