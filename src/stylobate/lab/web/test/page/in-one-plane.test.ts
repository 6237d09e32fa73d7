import assert from "node:assert/strict";
import { test } from "node:test";
import type { Description } from "../../src/page/case/description";
import { inOnePlane, PlaneTurn } from "../../src/page/case/in-one-plane";
import { VIEW } from "./case";

const BEFORE: Description = { ...VIEW.description, spin: 0.5 };
const AFTER = inOnePlane(BEFORE);
const TURN = new PlaneTurn(BEFORE, AFTER);

test("what was changed for one plane is said in a line and comes back with another model", () => {
  assert.match(
    TURN.lineFor(AFTER),
    /^Planar rocking: the motion is now straight and the initial condition lies in its plane\./,
  );
  assert.deepEqual(TURN.undone(AFTER), BEFORE);
});

test("what the reader has changed meanwhile stays", () => {
  const motion = { ...AFTER.motion, acceleration: 0.2 };
  const changed = { ...AFTER, motion };
  assert.equal(
    TURN.lineFor(changed),
    "Planar rocking: the initial condition lies in its plane. Choose another model to restore the earlier values.",
  );
  assert.deepEqual(TURN.undone(changed), { ...BEFORE, motion });
});

test("a case that lies in one plane already is not said to be changed", () => {
  const straight = { ...AFTER, motion: { kind: "straight", acceleration: 0.1, angular_frequency: 2, direction: 0 } };
  assert.equal(new PlaneTurn(straight, inOnePlane(straight)).lineFor(straight), "");
});

test("a straight motion across the plane is said to be along x", () => {
  const across = { ...AFTER, motion: { kind: "straight", acceleration: 0.1, angular_frequency: 2, direction: 1 } };
  const turned = inOnePlane(across);
  assert.match(new PlaneTurn(across, turned).lineFor(turned), /the motion is now along x/);
});
