import assert from "node:assert/strict";
import { test } from "node:test";
import { withValue } from "../../src/page/case/quantities";
import { isStanding, standing, startAlike, startKind, startOf } from "../../src/page/case/starting";
import { VIEW } from "./case";

const CASE = VIEW.description;

test("a start on a branch depends on column, model and motion, and on nothing else of a case", () => {
  for (const name of ["angular_frequency", "acceleration", "damping", "slenderness"])
    assert.ok(!startAlike(withValue(CASE, name, 0.0321), CASE), name);
  for (const name of ["tilt_x", "tilt_rate_y", "spin", "duration"])
    assert.ok(startAlike(withValue(CASE, name, 0.0321), CASE), name);
});

test("a column that is set upright and still stands, whatever is left of its start", () => {
  assert.ok(!isStanding(CASE));
  assert.ok(isStanding(standing(CASE)));
  assert.ok(isStanding({ ...CASE, ...startOf(standing(CASE)) }));
  assert.ok(startAlike(standing(CASE), CASE));
});

test("a start is named by the branch that is followed, or by what is set", () => {
  assert.equal(startKind(CASE, "upper"), "upper");
  assert.equal(startKind(CASE, null), "set");
  assert.equal(startKind(standing(CASE), null), "standing");
});
