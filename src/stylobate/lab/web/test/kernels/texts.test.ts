import assert from "node:assert/strict";
import { test } from "node:test";
import { filled, general } from "../../src/kernels/general";
import { asPython, asToml } from "../../src/kernels/snippets";

test("numbers are written as Python's format g writes them", () => {
  const known: readonly (readonly [number, number, string])[] = [
    [0.1, 5, "0.1"],
    [1234567, 4, "1.235e+06"],
    [0.0001234, 3, "0.000123"],
    [0.00001234, 3, "1.23e-05"],
    [100, 3, "100"],
    [1000, 3, "1e+03"],
    [125.7, 10, "125.7"],
    [-2.5, 4, "-2.5"],
    [0, 4, "0"],
    [Infinity, 4, "inf"],
    [NaN, 4, "nan"],
  ];
  for (const [value, digits, text] of known) assert.equal(general(value, digits), text);
});

test("gaps of a text are filled, with the digits that they name", () => {
  const text = "after {n} periods; set duration to at least {needed:.10g} s";
  assert.equal(filled(text, { n: 10, needed: 125.7 }), "after 10 periods; set duration to at least 125.7 s");
  assert.equal(filled("{other}", {}), "{other}");
});

test("a description is a file for the command line and a program", () => {
  const description = {
    column: { shape: "dimensionless", slenderness: 0.1 },
    model: { kind: "slender", damping: null },
    motion: { kind: "elliptic", amplitude: [0.1, 0.2], angular_frequency: 2 },
    tilt: [0.05, 0],
    duration: 20,
  };
  const toml = asToml(description);
  assert.equal(
    toml,
    [
      "tilt = [0.05, 0]",
      "duration = 20",
      "",
      "[column]",
      'shape = "dimensionless"',
      "slenderness = 0.1",
      "",
      "[model]",
      'kind = "slender"',
      "",
      "[motion]",
      'kind = "elliptic"',
      "amplitude = [0.1, 0.2]",
      "angular_frequency = 2",
      "",
    ].join("\n"),
  );
  assert.ok(asPython(description).includes(`tomllib.loads("""\n${toml}""")`));
});
