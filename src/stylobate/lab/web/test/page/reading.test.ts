import assert from "node:assert/strict";
import { test } from "node:test";
import { readNumber } from "../../src/page/frame/format";
import { wrongIn } from "../../src/page/frame/problems";
import { inShownUnits, setUnitsOf } from "../../src/page/frame/units";
import { badgeAt, reasonIn, warningIn } from "../../src/page/motion/verdict";
import { nextEvent } from "../../src/page/motion/transport";
import { shareOf } from "../../src/page/plane/classes";
import { roomFor } from "../../src/page/plane/plane-canvas";
import type { PlaneAxis, Run as Answer } from "../../src/page/server/schema";

test("numbers are read as they are written in most countries", () => {
  for (const text of ["0.02", "0,02", " 2e-2 "]) assert.equal(readNumber(text), 0.02, text);
  assert.equal(readNumber("\u22120.05"), -0.05);
  for (const text of ["", "abc", "0.02 g"]) assert.ok(Number.isNaN(readNumber(text)), text);
});

test("each quantity that a refusal names has the first line about it", () => {
  const wrong = wrongIn(["model: damping must be zero or positive, got -1.0", "tilt_rate: damping is too small"]);
  assert.equal(wrong.get("damping"), "model: damping must be zero or positive, got -1.0");
  assert.equal(wrong.get("tilt_rate"), "tilt_rate: damping is too small");
  assert.equal(wrong.get("radius"), undefined);
});

test("a column is said to be overturned from the instant on at which that is decided", () => {
  const answer = { outcome: "OVERTURNED", label: "overturned", decided_at: 11.37 } as Answer;
  assert.equal(badgeAt(answer, 0.6), "Will overturn at 11.4 s");
  assert.equal(badgeAt(answer, 11.37), "Overturned");
  assert.equal(badgeAt({ ...answer, outcome: "ROLLING", label: "rolling" }, 0), "Rolling");
});

test("an interval is rounded outward: nothing that is open is shown as certain", () => {
  const shown = (share: number, low: number, high: number): string | null =>
    shareOf({ code: 0, name: "", share, low, high });
  assert.equal(shown(1, 0.99627, 1), "100 % (99.6 to 100)");
  assert.equal(shown(0, 0, 0.00037), "0 % (0 to 0.1)");
});

test("starts along x and y are drawn to one scale, and other axes fill their room", () => {
  const axis = (name: string, units: string, reach: number): PlaneAxis => ({
    ...{ name, units },
    values: Array.from({ length: 5 }, (_, i) => reach * (i / 2 - 1)),
  });
  const room = { width: 300, height: 500 };
  const equal = roomFor({ x: axis("tilt_x", "rad", 0.1), y: axis("tilt_y", "rad", 0.1) }, room);
  assert.deepEqual(equal, { width: 300, height: 300 });
  const wide = roomFor({ x: axis("tilt_x", "rad", 0.2), y: axis("tilt_y", "rad", 0.1) }, room);
  assert.ok(Math.abs(wide.width / wide.height - 2) < 1e-12);
  assert.deepEqual(roomFor({ x: axis("tilt_x", "rad", 0.1), y: axis("tilt_rate_x", "rad s-1", 0.1) }, room), room);
});

test("a warning names no settings that the page does not have", () => {
  const line =
    "the outcome depends on the settings of the integration: with rest_energy 1e-06 and rtol 1e-07 it is AT_REST";
  assert.equal(
    warningIn(line),
    "computed with other tolerances it is at rest: rounding decides, so ask for a probability",
  );
  const failed = "the integration stopped: its step limit is reached, max_steps = 200000; raise max_steps";
  assert.deepEqual(reasonIn(failed), ["the integration stopped: its step limit is reached", false]);
  assert.equal(warningIn("it slips"), "it slips");
});

test("texts of a dimensionless column have its units", () => {
  setUnitsOf("dimensionless");
  assert.equal(
    inShownUnits("above 0.1 m/s² and 1.8 rad/s from 28.6 s on, 1 kg"),
    "above 0.1 g and 1.8 ω₀ from 28.6/ω₀ on, 1 kg",
  );
  setUnitsOf("solid");
  assert.equal(inShownUnits("60 s"), "60 s");
});

test("a reason is shown without the duration that it asks for", () => {
  const short = "the run is shorter than the 21 periods; set duration to at least 73.31 s";
  assert.deepEqual(reasonIn(short), ["the run is shorter than the 21 periods", true]);
  assert.deepEqual(reasonIn("it rolled once round"), ["it rolled once round", false]);
});

test("from event to event one comes through all of them, and from the last to the first", () => {
  const events = [3, 1, 2].map((time) => ({ kind: "impact", time }));
  const seen = [0, 1, 2, 3].map((time) => nextEvent(events, time, 10));
  assert.deepEqual(seen, [1, 2, 3, 1]);
  assert.equal(nextEvent([], 0, 10), null);
});
