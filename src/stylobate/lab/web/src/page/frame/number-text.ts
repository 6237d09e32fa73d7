/** Why the text of a number field is refused, in one line. */

import { capital, plain, readNumber } from "./format";

/** Returns the refusal of a text that is no finite number, with a number that can be entered; "" for a number. */
export function numberProblem(name: string, text: string, example: number | null): string {
  if (Number.isFinite(readNumber(text))) return "";
  const given = text.trim();
  const short = given.length > LONGEST ? `${given.slice(0, LONGEST)}…` : given;
  const what =
    given === ""
      ? "a number is missing"
      : Math.abs(readNumber(given)) === Infinity
        ? `'${short}' is not a finite number`
        : `'${short}' is not a number`;
  return `${name}: ${what}. Enter a number such as ${plain(example ?? EXAMPLE) || EXAMPLE}.`;
}

/** Returns the refusal of two texts that are no range; "" for a range that rises. */
export function rangeProblem(
  name: string,
  from: string,
  to: string,
  example: { readonly from: number; readonly to: number },
): string {
  const problem = numberProblem(name, from, example.from) || numberProblem(name, to, example.to);
  if (problem !== "" || readNumber(from) < readNumber(to)) return problem;
  return `${name}: the range does not rise (got ${from.trim()} to ${to.trim()}). Enter a smaller start or a larger end.`;
}

/** Returns a label as it begins a line of its own. */
export function lineStart(label: string): string {
  return label === capital(label) && label.slice(1) === label.slice(1).toLowerCase() ? label.toLowerCase() : label;
}

const EXAMPLE = 0.05;

/** Characters of a refused text that a line quotes. */
const LONGEST = 24;
