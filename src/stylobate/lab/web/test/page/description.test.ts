import assert from "node:assert/strict";
import { test } from "node:test";
import { caseInWords } from "../../src/page/case/description";
import { VIEW } from "./case";

test("a case is described in one line, with all that makes it", () => {
  assert.equal(
    caseInWords(VIEW.description),
    "dimensionless, slenderness 0.1; slender, damping 0.1; circular, acceleration 0.065, angular frequency 1.8; " +
      "tilt 0.0386,-0.004; tilt rate -0.0075,0.0695. SI units.",
  );
});
