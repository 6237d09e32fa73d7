/** What became of the column, in a line that is read out. */

import type { Answer } from "../server/answers";
import { element } from "../frame/dom";
import { capital, told } from "../frame/format";

/** Outcomes that tell how far a run was followed, not what became of the column. */
const UNDECIDED: readonly string[] = ["STILL_MOVING", "LIMIT_REACHED", "FAILED"];

export class Verdict {
  readonly root = element("div", { class: "verdict", "aria-live": "polite", "aria-atomic": "true" });
  #told = "";

  show(answer: Answer): void {
    const at = decisionOf(answer);
    const text = [answer.outcome, answer.reason, at, answer.uncertain, ...answer.warnings].join("\n");
    if (text === this.#told) return; // what has been read out once is not read out again
    this.#told = text;
    const badge = element("strong", { class: `badge ${answer.outcome.toLowerCase()}` }, capital(answer.told));
    const reason = element("span", { class: "reason" }, `${sentence(answer.reason)}${at}`);
    const marks = answer.uncertain
      ? [element("strong", { class: "badge unsure", title: "A small change could alter the outcome" }, "Uncertain")]
      : [];
    const warnings = answer.warnings.map((line) => element("p", { class: "warning" }, sentence(line)));
    this.root.replaceChildren(element("p", {}, badge, ...marks, " ", reason), ...warnings);
  }
}

/** Returns the verdict in plain text. */
export function verdictOf(answer: Answer): string {
  return `${capital(answer.told)}: ${answer.reason.replace(/[.]$/, "")}.${decisionOf(answer)}`;
}

function decisionOf({ outcome, decided_at: at }: Answer): string {
  const reached = UNDECIDED.includes(outcome) ? "Followed to" : "Decided at";
  return at === null ? "" : ` ${reached} ${told(at, 3)}\u00a0s.`;
}

function sentence(line: string): string {
  const text = capital(line.trim());
  return text === "" || /[.!?]$/.test(text) ? text : `${text}.`;
}
