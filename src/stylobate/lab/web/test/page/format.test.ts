import assert from "node:assert/strict";
import { test } from "node:test";
import { axisLabel, counted, plain, formatted, unitWritten, withUnit } from "../../src/page/frame/format";
import { setUnitsOf } from "../../src/page/frame/units";

test("numbers have the digits that are asked for and no idle zeros", () => {
  assert.deepEqual([plain(0.1 + 0.2), plain(2700), plain(1 / 3, 3), plain(1e-9)], ["0.3", "2700", "0.333", "1e-9"]);
  assert.deepEqual(
    [formatted(-0.25), formatted(1e-9), formatted(null), formatted(Number.NaN)],
    ["−0.25", "1·10^−9", "–", "–"],
  );
});

test("units of results are written as people write them", () => {
  assert.deepEqual(["m s-2", "rad s-1", "kg m2", "m/s²", "rad", "1", "", "kg/m³", "kg m²"].map(unitWritten), [
    ...["m/s²", "rad/s", "kg m²", "m/s²", "rad", "", "", "kg/m³", "kg m²"],
  ]);
});

test("axes state their unit unless there is none", () => {
  assert.equal(axisLabel("angular_frequency", "rad s-1"), "angular frequency [rad/s]");
  assert.equal(axisLabel("slenderness", "1"), "slenderness");
  assert.equal(withUnit(0.0651, "m/s²"), "0.0651 m/s²");
});

test("one is not several", () => {
  assert.deepEqual(
    [counted(1, "run"), counted(2, "run"), counted(0, "family", "families")],
    ["1 run", "2 runs", "0 families"],
  );
});

test("a column without scale has its own units, with the same numbers", () => {
  setUnitsOf("dimensionless");
  try {
    assert.equal(axisLabel("angular_frequency", "rad s-1"), "angular frequency [ω₀]");
    assert.deepEqual(
      [withUnit(0.065, "m/s²"), withUnit(60, "s"), withUnit(0.1, "rad")],
      ["0.065 g", "60/ω₀", "0.1 rad"],
    );
  } finally {
    setUnitsOf("solid");
  }
  assert.equal(withUnit(60, "s"), "60 s");
});
