import assert from "node:assert/strict";
import { test } from "node:test";
import type { Kind, Parameter } from "../../src/page/case/about";
import { KeptNumbers } from "../../src/page/controls/controls";
import { partOfKind } from "../../src/page/case/about";

const of = (kind: string, ...parameters: readonly Parameter[]): Kind => ({ kind, name: kind, parameters });
const ACCELERATION = { name: "acceleration", unit: "m/s²", default: 1.5 };
const CIRCULAR = of("circular", ACCELERATION, { name: "sense", default: 1 });
const STRAIGHT = of("straight", ACCELERATION, { name: "direction", unit: "rad", default: 0 });
const REST = of("rest");
const HARMONIC = of("harmonic", { name: "amplitude", unit: "m/s²", default: [1, 0, 0] });
const DISPLACEMENT = of("displacement", { name: "amplitude", unit: "m", default: [0.02, 0, 0] });

test("a number that two kinds have is kept, also by way of a kind that has it not", () => {
  const kept = new KeptNumbers();
  kept.keep(CIRCULAR, { kind: "circular", acceleration: 0.065, sense: -1 });
  kept.keep(REST, { kind: "rest" });
  assert.deepEqual(partOfKind(STRAIGHT, "kind", kept.of(STRAIGHT)), {
    kind: "straight",
    acceleration: 0.065,
    direction: 0,
  });
  kept.keep(STRAIGHT, { kind: "straight", acceleration: 0.2, direction: 1 });
  assert.deepEqual(kept.of(CIRCULAR), { acceleration: 0.2, sense: -1 });
});

test("numbers of one name in two units are two", () => {
  const kept = new KeptNumbers();
  kept.keep(HARMONIC, { kind: "harmonic", amplitude: [2, 1, 0] });
  assert.deepEqual(kept.of(DISPLACEMENT), {});
});

test("what is forgotten is not kept", () => {
  const kept = new KeptNumbers();
  kept.keep(CIRCULAR, { kind: "circular", acceleration: 0.065 });
  kept.forget();
  assert.deepEqual(kept.of(CIRCULAR), {});
});
