import assert from "node:assert/strict";
import { test } from "node:test";
import type { Run as Answer, Series } from "../../src/page/server/schema";
import { brokenAt } from "../../src/page/frame/exports";
import type { HistoryName, RunShown } from "../../src/page/charts/history-kinds";
import { chosenHistories, historyOf, offeredHistories } from "../../src/page/charts/history-kinds";

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
  extremes: {},
};

function run(series: Partial<Series>, frequency: number | null = null): RunShown {
  const rest = { column: { slenderness: 0.1 }, drawn: { friction_coefficient: 0.4 }, measures: {} };
  return { answer: { series: { ...STILL, ...series }, ...rest } as unknown as Answer, frequency };
}

const usual = (series: Partial<Series>): readonly HistoryName[] => chosenHistories(run(series), null);

test("only what a run has is offered, and of the base only the directions in which it moves", () => {
  assert.deepEqual(offeredHistories(run({})), ["tilt", "base_y"]);
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
  assert.deepEqual(chosenHistories(run({ rolling_rate: [1, 1, 1] }), ["base_y", "slip_speed"]), [
    "base_y",
    "rolling_rate",
  ]);
});

test("short lengths are written in millimetres, from where they began to where they end", () => {
  const displacement = [
    [0, 0],
    [-0.002, 0],
    [0.016, 0],
  ] as const;
  const x = historyOf("displacement_x", run({ displacement }));
  assert.equal(x.label, "x [mm]");
  assert.deepEqual(x.values, [0, -2, 16]);
  assert.equal(x.note, "−2 to 16 mm, at the end 16");
});

test("the rate of rolling is held against that of the base, in its own sense", () => {
  const clockwise = historyOf("rolling_rate", run({ rolling_rate: [-2, -1.9, -2.1] }, 2));
  assert.equal(clockwise.level?.value, -2);
});

test("friction at the instant of lifting off hides nothing of what it was before", () => {
  const before = Array.from({ length: 200 }, () => 0.2);
  const demand = historyOf("friction_demand", run({ friction_demand: [...before, 2e13] }));
  assert.ok(demand.limits[1] <= 0.5);
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

test("a peak that lies between the samples and beyond the plot is reported off the scale", () => {
  const found = run({ friction_demand: [0.1, 0.11, 0.12] });
  const peaked = {
    ...found,
    answer: { ...found.answer, measures: { ...found.answer.measures, peak_friction_demand: 0.607 } },
  };
  const demand = historyOf("friction_demand", peaked);
  assert.ok(demand.limits[1] < 0.607);
  assert.equal(demand.note, "largest 0.607, off the scale");
});

test("extremes between the samples are drawn at their times, of vectors those of the component", () => {
  const extremes = {
    friction_demand: [[0.5, 0]],
    base_acceleration_y: [[1.5, 0.75]],
    base_acceleration_x: [[1.2, 9]],
  } as const;
  const found = run({ friction_demand: [0.1, 0.2, 0.1], extremes });
  const demand = historyOf("friction_demand", found);
  assert.deepEqual(
    [demand.time, demand.values],
    [
      [0, 0.5, 1, 2],
      [0.1, 0, 0.2, 0.1],
    ],
  );
  const base = historyOf("base_y", found);
  assert.deepEqual(
    [base.time, base.values],
    [
      [0, 1, 1.5, 2],
      [1, -1, 0.75, 0.5],
    ],
  );
});
