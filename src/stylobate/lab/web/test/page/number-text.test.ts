import assert from "node:assert/strict";
import { test } from "node:test";
import { lineStart, numberProblem, rangeProblem } from "../../src/page/frame/number-text";

test("a text that is no number is quoted, with a number that can be entered", () => {
  assert.equal(numberProblem("damping", " abc ", 0.1), "damping: 'abc' is not a number. Enter a number such as 0.1.");
  assert.match(numberProblem("tilt x", "NaN", 0.02), /^tilt x: 'NaN' is not a number/);
  assert.match(numberProblem("acceleration", "1e400", 0.065), /'1e400' is not a finite number.* 0\.065\.$/);
  assert.match(numberProblem("damping", " ", null), /^damping: a number is missing\. Enter a number such as 0\.05\.$/);
  assert.equal(numberProblem("damping", "0,5", 0.1), "");
  assert.ok(numberProblem("damping", "x".repeat(500), 0.1).length < 100);
});

test("a range that does not rise is refused by its name", () => {
  const shown = { from: 0.5, to: 5 };
  assert.equal(rangeProblem("angular frequency", "0.5", "9", shown), "");
  assert.match(rangeProblem("angular frequency", "9", "5", shown), /^angular frequency: .*\(got 9 to 5\)/);
  assert.match(rangeProblem("angular frequency", "5", "5", shown), /does not rise/);
  assert.match(rangeProblem("angular frequency", "1", "abc", shown), /'abc' is not a number.* 5\.$/);
});

test("a line begins with the label as it is written inside a line", () => {
  assert.equal(lineStart("Angular frequency"), "angular frequency");
});
