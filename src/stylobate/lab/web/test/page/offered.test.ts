import assert from "node:assert/strict";
import { test } from "node:test";
import type { About, Kind, Parameter } from "../../src/page/case/about";
import { partOfKind } from "../../src/page/case/about";
import { offered } from "../../src/page/case/offered";
import { ABOUT } from "./case";

const needed = (name: string, from: number | null = null, to: number | null = null): Parameter => ({
  ...{ name, default: null, needed: true, from, to },
});

/** Kinds as a server sends them: numbers that are needed have no value. */
const SERVED: About = {
  ...ABOUT,
  shapes: [
    {
      kind: "solid",
      name: "solid",
      about: "A solid cylinder; lengths in m, density in kg/m³.",
      parameters: [needed("radius"), needed("height"), needed("density"), { name: "gravity", default: 9.80665 }],
    },
  ],
  models: [
    { kind: "other", name: "other", parameters: [needed("stiffness", 0.1, 10), { name: "patch", default: null }] },
  ],
  motions: [
    {
      kind: "elliptic",
      name: "elliptic",
      parameters: [needed("amplitude"), needed("phase"), needed("angular_frequency")],
    },
    {
      kind: "record",
      name: "record",
      about: "A record: the file path, or the sample.",
      parameters: [
        { name: "path", default: null },
        { name: "processing", default: [] },
        { name: "scale", default: null },
      ],
    },
  ],
};

const kind = (kinds: readonly Kind[], name: string): Kind => kinds.find((one) => one.kind === name)!;

test("every number that a kind needs has a first value, so that choosing it gives a case that runs", () => {
  const { shapes, models, motions } = offered(SERVED);
  for (const one of [...shapes, ...models, ...motions]) {
    for (const { name, needed: must, default: first } of one.parameters) {
      if (must) assert.notEqual(first, null, `${one.kind}.${name}`);
    }
  }
  assert.deepEqual(partOfKind(kind(motions, "elliptic"), "kind", {})["amplitude"], [1, 0.5]);
});

test("a number that need not be given stays ungiven", () => {
  const part = partOfKind(kind(offered(SERVED).models, "other"), "kind", {});
  assert.deepEqual(part, { kind: "other", stiffness: 1 });
});

test("a record is set by numbers only: which one it is has controls of its own", () => {
  const record = kind(offered(SERVED).motions, "record");
  assert.deepEqual(
    record.parameters.map((one) => one.name),
    ["scale"],
  );
});

test("a kind is described in one sentence, its units beside its numbers", () => {
  assert.equal(kind(offered(SERVED).shapes, "solid").about, "A solid cylinder. Give its density or its mass.");
});

test("another kind keeps the numbers that both have", () => {
  const before = { shape: "hollow", radius: 0.3, inner_radius: 0.2, height: 2 };
  const solid = partOfKind(kind(offered(SERVED).shapes, "solid"), "shape", before);
  assert.deepEqual(solid, { shape: "solid", radius: 0.3, height: 2, density: 2700, gravity: 9.80665 });
});
