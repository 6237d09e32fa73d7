import assert from "node:assert/strict";
import { test } from "node:test";
import type { About } from "../../src/page/case/about";
import { Job } from "../../src/page/server/job";
import { type Contents, recorded } from "../../src/page/server/recorded";
import type { Job as JobReport, Run } from "../../src/page/server/schema";
import { type Layer, NotMine, Refused, layered } from "../../src/page/server/source";

const SIGNAL = new AbortController().signal;
const CASE = { tilt: [0.02, 0], column: { shape: "dimensionless", slenderness: 0.1 } };
const SAME = { column: { slenderness: 0.1, shape: "dimensionless" }, tilt: [0.02, 0.0] };
const ORBITS = { families: [], bifurcations: [] };

const FILES: Readonly<Record<string, unknown>> = {
  first: { outcome: "ROLLING" },
  second: ORBITS,
  third: { problems: ["no orbit was found"] },
};
const CONTENTS: Contents = {
  about: { version: "1" } as About,
  answers: [
    { ask: "simulate", question: CASE, name: "first" },
    { ask: "exact", question: { description: CASE }, name: "second" },
    { ask: "exact", question: { description: { ...CASE, spin: 1 } }, name: "third" },
  ],
};
const layer = recorded(CONTENTS, (name) => Promise.resolve(FILES[name]));

test("an answer is found by its question, whatever the order of its names", async () => {
  const source = layered([layer]);
  assert.deepEqual(await source.simulate(SAME, SIGNAL), FILES["first"]);
  assert.equal((await source.about()).version, "1");
});

test("what is not recorded is refused in one line that says what to install", async () => {
  const source = layered([layer]);
  const other = { ...CASE, tilt: [0.03, 0] };
  for (const asked of [
    source.simulate(other, SIGNAL),
    source.variations(CASE, SIGNAL),
    source.describe(CASE),
    source.startJob("exact", { description: other }),
    source.sendRecord({ files: [] }),
  ]) {
    await assert.rejects(asked, (error) => {
      assert.ok(error instanceof Refused);
      assert.equal(error.problems.length, 1);
      assert.match(
        error.problems[0] ?? "",
        /^This page has no answer for .* Install stylobate and run “stylobate lab”/,
      );
      return true;
    });
  }
});

test("layers are asked in their order: what one does not answer, the next does", async () => {
  const computed = { outcome: "OVERTURNED" } as Run;
  const second: Layer = { simulate: () => Promise.resolve(computed) };
  const none: Layer = { simulate: () => Promise.reject(new NotMine()) };
  assert.equal(await layered([none, {}, second]).simulate(CASE, SIGNAL), computed);
  assert.deepEqual(await layered([layer, second]).simulate(CASE, SIGNAL), FILES["first"]);
  assert.equal(await layered([layer, second]).simulate({ ...CASE, spin: 1 }, SIGNAL), computed);
});

test("a refusal or a failure of a layer is the answer: no other layer is asked", async () => {
  const refusing: Layer = { simulate: () => Promise.reject(new Refused(422, ["damping must be positive"])) };
  const next: Layer = { simulate: () => assert.fail("asked") };
  await assert.rejects(layered([refusing, next]).simulate(CASE, SIGNAL), /damping must be positive/);
});

test("a refusal is recorded as one", async () => {
  const asked = layered([layer]).startJob("exact", { description: { ...CASE, spin: 1 } });
  await assert.rejects(asked, (error) => error instanceof Refused && error.problems[0] === "no orbit was found");
});

test("a recorded job has ended when it is asked after", async () => {
  const reports: JobReport[] = [];
  const last = await new Promise((ended) => {
    new Job(
      layered([layer]),
      "exact",
      { description: SAME },
      { report: (one) => reports.push(one), ended: (report) => ended(report) },
    );
  });
  assert.deepEqual((last as JobReport).result, ORBITS);
  assert.equal(reports.length, 1);
});
