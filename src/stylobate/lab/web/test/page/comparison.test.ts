import assert from "node:assert/strict";
import { test } from "node:test";
import { comparedCase, comparisonRead, comparisonWritten, differencesOf } from "../../src/page/case/comparison";
import { firstComparison, labelsOf, obstacle } from "../../src/page/case/comparison";
import type { Description } from "../../src/page/case/description";
import { BrokenLink, linkOf, viewFrom } from "../../src/page/view/link";
import { ABOUT, VIEW } from "./case";

const BARE = VIEW.description;
const SOLID: Description = {
  ...BARE,
  column: { shape: "solid", radius: 0.5, height: 5, density: 2700, gravity: 9.81 },
};
const about = {
  ...ABOUT,
  shapes: ABOUT.shapes.map((shape) => ({
    ...shape,
    parameters: shape.parameters.map((one) =>
      one.name === "radius" || one.name === "height" ? { ...one, unit: "m" } : one,
    ),
  })),
};

test("the second column has the motion and the start of the first, and one thing of its own", () => {
  const damped = comparedCase(BARE, { differs: "damping", value: 0.02 }, ABOUT);
  assert.deepEqual(damped, { ...BARE, model: { kind: "slender", damping: 0.02 } });
  const slimmer = comparedCase(BARE, { differs: "slenderness", value: 0.05 }, ABOUT);
  assert.deepEqual(slimmer, { ...BARE, column: { shape: "dimensionless", slenderness: 0.05 } });
});

test("another size is another size in all lengths, and of the same stone under the same gravity", () => {
  const { column } = comparedCase(SOLID, { differs: "size", value: 2 }, about);
  assert.deepEqual(column, { shape: "solid", radius: 1, height: 10, density: 2700, gravity: 9.81 });
});

test("another model keeps the damping, and a spin only if it has one", () => {
  const spinning = { ...BARE, spin: 2 };
  assert.equal(comparedCase(spinning, { differs: "model", value: "sliding" }, ABOUT)["spin"], 2);
  const back = comparedCase(
    { ...spinning, model: { kind: "sliding", damping: 0.3 } },
    { differs: "model", value: "slender" },
    ABOUT,
  );
  assert.deepEqual(back.model, { kind: "slender", damping: 0.3 });
  assert.equal("spin" in back, false);
});

test("a column without lengths has a slenderness, one with lengths a size, and what it has not is refused", () => {
  assert.deepEqual(
    [differencesOf(BARE), differencesOf(SOLID)].map((one) => one[2]),
    ["slenderness", "size"],
  );
  assert.match(obstacle(BARE, { differs: "size", value: 2 }) ?? "", /no size/);
  assert.match(obstacle(BARE, { differs: "model", value: "slender" }) ?? "", /same model/);
  assert.equal(obstacle(SOLID, { differs: "size", value: 2 }), null);
});

test("what is compared first differs from the case, and the labels say in what", () => {
  for (const differs of differencesOf(BARE)) {
    const [first, second] = labelsOf(BARE, firstComparison(differs, BARE, ABOUT));
    assert.notEqual(first, second);
    assert.ok(first.startsWith(differs) && second.startsWith(differs));
  }
});

test("a link keeps what is compared, and says what is wrong with a comparison", () => {
  const view = { ...VIEW, compared: { differs: "damping", value: 0.02 } } as const;
  assert.match(linkOf(view), /&beside=damping:0.02/);
  assert.deepEqual(viewFrom(`#${linkOf(view)}`, ABOUT).compared, view.compared);
  assert.throws(() => viewFrom(`#${linkOf(VIEW)}&beside=colour:3`, ABOUT), BrokenLink);
  for (const text of ["damping:", "damping:-1", "size:big", "model:", "3"]) assert.equal(comparisonRead(text), null);
  assert.equal(comparisonWritten({ differs: "model", value: "sliding" }), "model:sliding");
});
