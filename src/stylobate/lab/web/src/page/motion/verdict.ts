/** The outcome, in a line that is read out. */

import type { Run as Answer } from "../server/schema";
import { button, element } from "../frame/dom";
import { capital, sentence, withUnit } from "../frame/format";

/** Outcomes that state how far a run was followed, not the response of the column. */
const UNDECIDED: readonly string[] = ["STILL_MOVING", "LIMIT_REACHED", "FAILED"];

export class Verdict {
  readonly root = element("div", { class: "verdict", "aria-live": "polite", "aria-atomic": "true" });
  readonly #badge = element("strong", { "aria-hidden": "true" });
  readonly #lasting: (duration: number) => void;
  #answer: Answer | null = null;
  #announced = "";

  /** `lasting` hears how long the reader wants the run to be [s]. */
  constructor(lasting: (duration: number) => void) {
    this.#lasting = lasting;
  }

  show(answer: Answer): void {
    this.#answer = answer;
    this.setTime(0);
    const at = decisionOf(answer);
    const text = [answer.outcome, answer.reason, at, answer.uncertain, ...answer.warnings].join("\n");
    if (text === this.#announced) return; // what has been read out once is not read out again
    this.#announced = text;
    const outcome = element("span", { class: "visually-hidden" }, `${capital(answer.label)}.`);
    const reason = element("span", { class: "reason" }, `${sentence(answer.reason)}${at}`);
    const marks = answer.uncertain
      ? [element("strong", { class: "badge unsure", title: "Rounding or the rest threshold could alter the outcome" }, "Numerically uncertain")]
      : [];
    const wanted = durationWanted(answer.reason);
    const longer = wanted === null ? [] : [this.#followOn(wanted)];
    const warnings = answer.warnings.map((line) => element("p", { class: "warning" }, sentence(line)));
    this.root.replaceChildren(
      element("p", {}, outcome, this.#badge, ...marks, " ", reason, " ", ...longer),
      ...warnings,
    );
  }

  #followOn(duration: number): HTMLButtonElement {
    return button(`Simulate to ${withUnit(duration, "s", 4)}`, { class: "small" }, () => this.#lasting(duration));
  }

  /** Shows the outcome as it is known at a time of the run: the badge is hidden from readers of the screen. */
  setTime(time: number): void {
    if (this.#answer === null) return;
    const text = badgeAt(this.#answer, time);
    if (text === this.#badge.textContent) return;
    this.#badge.textContent = text;
    this.#badge.className = `badge ${this.#answer.outcome.toLowerCase()}`;
  }
}

/** Returns the duration that a reason asks for [s], rounded up a little; null where it asks for none. */
export function durationWanted(reason: string): number | null {
  const found = /set duration to at least ([\d.]+) s/.exec(reason);
  return found === null ? null : Number((Number(found[1]) * 1.005).toPrecision(4));
}

/** Returns what a badge says at a time: what is to come is not said as if it had been. */
export function badgeAt({ outcome, label: name, decided_at: at }: Answer, time: number): string {
  const future = FUTURE[outcome];
  return future === undefined || at === null || time >= at ? capital(name) : `${future} at ${withUnit(at, "s")}`;
}

/** Of outcomes that a column comes to at an instant: how they are announced. */
const FUTURE: Readonly<Record<string, string>> = { OVERTURNED: "Will overturn", LIFTED_OFF: "Will lift off" };

/** Returns the verdict in plain text. */
export function verdictOf(answer: Answer): string {
  return `${capital(answer.label)}: ${answer.reason.replace(/[.]$/, "")}.${decisionOf(answer)}`;
}

function decisionOf({ outcome, decided_at: at }: Answer): string {
  const reached = UNDECIDED.includes(outcome) ? "Simulated to" : "Decided at";
  return at === null ? "" : ` ${reached} ${withUnit(at, "s")}.`;
}
