import assert from "node:assert/strict";
import { test } from "node:test";
import { server } from "../../src/page/server/api";
import { run } from "../../src/page/server/run";
import { VIEW } from "./case";

const REMARK = "start: averaged branch, approximate; no exact orbit was found from it";
const START = { tilt: [0.01, 0.02], tilt_rate: [0.03, 0.04], spin: 0, warnings: [REMARK] };

/** Answers requests in the place of the server; returns the bodies of the runs. */
function served(): unknown[] {
  const bodies: unknown[] = [];
  globalThis.fetch = (path, options) => {
    const begins = String(path) === "/api/start";
    if (!begins) bodies.push(JSON.parse(String(options?.body)));
    return Promise.resolve(Response.json(begins ? START : { warnings: ["another"] }));
  };
  return bodies;
}

const SIGNAL = new AbortController().signal;

test("what is remarked on a start on a branch stands before the warnings of the run, and is not sent with it", async () => {
  const bodies = served();
  const found = await run(server, { description: VIEW.description, start: "upper", remarks: [] }, SIGNAL);
  assert.deepEqual(found.answer.warnings, [REMARK, "another"]);
  assert.deepEqual(found.remarks, [REMARK]);
  const [body] = bodies as [Record<string, unknown>];
  assert.deepEqual(
    body["tilt"],
    START.tilt.map((one) => one * 1.001),
  );
  assert.ok(!("warnings" in body) && !("warnings" in found.description));
});

test("a start that is kept keeps its remarks", async () => {
  served();
  const found = await run(server, { description: VIEW.description, start: null, remarks: [REMARK] }, SIGNAL);
  assert.deepEqual(found.answer.warnings, [REMARK, "another"]);
});
