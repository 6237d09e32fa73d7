import assert from "node:assert/strict";
import { test } from "node:test";
import { angularFrequency, isHorizontalHarmonic, withAngularFrequency } from "../../src/page/case/frequency";
import { belongs, defaultPlane, keyOf, quantitiesOf } from "../../src/page/plane/planes";
import { valueOf, withValue } from "../../src/page/case/quantities";
import { lengthOf } from "../../src/page/case/run-length";
import { exactRequest, planeRequest, responseRequest, usualRange } from "../../src/page/server/requests";
import type { Description } from "../../src/page/case/description";
import type { Plane, PlaneKind } from "../../src/page/view/state";
import { offered } from "../../src/page/case/offered";
import { ABOUT, VIEW } from "./case";

const CASE = VIEW.description;
const SCALES = { slenderness: 0.1, frequency_scale: 1 };

test("a quantity that is set reads as it was set, and leaves the others as they were", () => {
  const names = [...quantitiesOf("map", CASE, ABOUT, SCALES), ...quantitiesOf("basin", CASE, ABOUT, SCALES)].map(
    (one) => one.name,
  );
  assert.ok(names.length >= 8);
  for (const name of names) {
    const changed = withValue(CASE, name, 0.0123);
    assert.equal(valueOf(changed, name), 0.0123, name);
    for (const other of names)
      if (other !== name) assert.equal(valueOf(changed, other), valueOf(CASE, other), `${other} after ${name}`);
  }
});

test("each number of a case is offered for maps once", () => {
  const names = quantitiesOf("map", CASE, ABOUT, SCALES).map((one) => one.name);
  assert.equal(new Set(names).size, names.length);
  assert.deepEqual(names.slice(0, 2), ["acceleration", "angular_frequency"]);
});

const keyIn = (kind: PlaneKind, of: Description, plane: Plane) => keyOf(of, plane, lengthOf(kind, of, plane, SCALES));

test("a map is over frequency and strength where nothing is said, and holds the motion that is shown", () => {
  const quantities = quantitiesOf("map", CASE, ABOUT, SCALES);
  const plane = defaultPlane("map", CASE, quantities)!;
  assert.deepEqual([plane.x.name, plane.y.name], ["angular_frequency", "acceleration"]);
  for (const axis of [plane.x, plane.y]) {
    const value = valueOf(CASE, axis.name)!;
    assert.ok(axis.from < value && value < axis.to, axis.name);
  }
  assert.ok(belongs(plane, quantities));
  assert.ok(!belongs(plane, quantitiesOf("basin", CASE, ABOUT, SCALES)));
});

test("a picture stays that of its case when a motion in it is chosen, and not when another number moves", () => {
  const plane = defaultPlane("map", CASE, quantitiesOf("map", CASE, ABOUT, SCALES))!;
  const chosen = withValue(withValue(CASE, "angular_frequency", 3), "acceleration", 0.2);
  assert.equal(keyIn("map", chosen, plane), keyIn("map", CASE, plane));
  for (const name of ["damping", "slenderness", "tilt_x"]) {
    assert.notEqual(keyIn("map", withValue(CASE, name, 0.0321), plane), keyIn("map", CASE, plane), name);
  }
  assert.notEqual(keyIn("map", withValue(CASE, "duration", 9000), plane), keyIn("map", CASE, plane), "duration");
});

test("a basin's picture does not depend on the start that is shown in it", () => {
  const plane = defaultPlane("basin", CASE, quantitiesOf("basin", CASE, ABOUT, SCALES))!;
  const other = withValue(withValue(CASE, "tilt_x", 0.01), "tilt_y", 0.02);
  assert.equal(keyIn("basin", other, plane), keyIn("basin", CASE, plane));
});

for (const motion of [
  CASE.motion,
  { kind: "orbit", diameter: 0.012, rpm: 200 },
  { kind: "stroke", stroke: 0.1, frequency: 2 },
]) {
  test(`the frequency of a ${motion["kind"]} motion is set in the quantity in which it is given`, () => {
    const found = angularFrequency(withAngularFrequency(motion, 7.5))!;
    assert.ok(Math.abs(found - 7.5) < 1e-4);
  });
}

test("motions that are not harmonic, or not horizontal, have no response", () => {
  assert.ok(isHorizontalHarmonic(CASE.motion));
  assert.ok(!isHorizontalHarmonic({ kind: "record", sample: "el centro 1940" }));
  assert.ok(!isHorizontalHarmonic({ kind: "vertical", acceleration: 1, angular_frequency: 3 }));
  assert.ok(!isHorizontalHarmonic({ kind: "harmonic", amplitude: [1, 0, 0.5], angular_frequency: 3 }));
  assert.equal(responseRequest({ ...CASE, motion: { kind: "rest" } }, [1, 2]), null);
});

test("response curves do not depend on the frequency that is shown", () => {
  const at = (frequency: number) => withValue(CASE, "angular_frequency", frequency);
  assert.deepEqual(responseRequest(at(1.2), [0.2, 4]), responseRequest(at(2.4), [0.2, 4]));
});

test("exact orbits are those of the chosen model, and its curves those of the slender one", () => {
  const sliding = { ...CASE, model: { kind: "sliding", damping: 0.05, friction_coefficient: 0.3 } };
  assert.deepEqual(exactRequest(sliding, [0.2, 4])!["model"], sliding.model);
  assert.deepEqual(responseRequest(sliding, [0.2, 4])!["model"], { kind: "slender", damping: 0.05 });
});

test("the usual range holds the frequency that is shown", () => {
  for (const frequency of [0.01, 0.3, 1.8, 20.9, 157]) {
    const [low, high] = usualRange(1.2, frequency);
    assert.ok(low < frequency && frequency < high, `${low} ${frequency} ${high}`);
  }
});

test("what need not be given is not sent", () => {
  const plane = defaultPlane("basin", CASE, quantitiesOf("basin", CASE, ABOUT, SCALES))!;
  const described = { ...CASE, atol: null, model: { kind: "slender", passage_tilt: null } };
  const body = planeRequest("basin", described, plane, lengthOf("basin", described, plane, SCALES));
  assert.deepEqual(body["model"], { kind: "slender" });
  assert.ok(!("atol" in body) && !("duration" in body) && "periods" in body);
});

test("a map can vary the numbers in which a case is described, and begins with how the base moves", () => {
  const shaker = { ...CASE, column: { shape: "solid", radius: 0.03, height: 0.2, density: 1000 } };
  const about = offered(ABOUT);
  const moved = { ...shaker, motion: { kind: "orbit", diameter: 0.012, rpm: 200 } };
  const quantities = quantitiesOf("map", moved, about, SCALES);
  for (const name of ["rpm", "diameter", "radius", "height"])
    assert.ok(
      quantities.some((one) => one.name === name),
      name,
    );
  const plane = defaultPlane("map", moved, quantities)!;
  assert.deepEqual([plane.x.name, plane.y.name], ["rpm", "diameter"]);
  assert.ok(plane.x.from > 0 && plane.x.from < 200 && plane.x.to > 200);
});
