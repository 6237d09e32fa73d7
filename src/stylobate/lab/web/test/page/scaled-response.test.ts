import assert from "node:assert/strict";
import { test } from "node:test";
import type { Described, ResponseCurves } from "../../src/page/server/schema";
import type { Part } from "../../src/page/case/description";
import { ScaledResponse } from "../../src/page/charts/response-asking";

const CURVES: ResponseCurves = { angular_frequency: [], branches: [], backbone: [], critical: [], averaged: true };
const SIGNAL = new AbortController().signal;

/** A server that knows the slenderness of a column from its description, and counts how often it is asked. */
function server() {
  const asked: Part[] = [];
  const describe = (description: Part): Promise<Described> => {
    asked.push(description);
    const { slenderness } = description["column"] as { slenderness: number };
    return Promise.resolve({
      toml: "",
      python: "",
      column: { slenderness, frequency_scale: 1, frequency_parameter: 1 } as Described["column"],
    });
  };
  return { asked, scaled: new ScaledResponse({ response: () => Promise.resolve(CURVES), describe }) };
}

const bodyOf = (slenderness: number, damping = 0): Part => ({
  column: { shape: "dimensionless", slenderness },
  model: { kind: "slender", damping },
});

test("curves come with the slenderness of their own column, whatever column was before", async () => {
  const { scaled } = server();
  for (const slenderness of [0.1, 0.2, 0.1])
    assert.equal((await scaled.ask(bodyOf(slenderness), SIGNAL)).slenderness, slenderness);
});

test("a column is asked for once as long as it stays the same", async () => {
  const { asked, scaled } = server();
  for (const damping of [0, 0.1, 0.2]) await scaled.ask(bodyOf(0.2, damping), SIGNAL);
  assert.equal(asked.length, 1);
});
