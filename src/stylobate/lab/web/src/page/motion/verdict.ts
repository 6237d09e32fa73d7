/** The outcome, in a line that is read out. */

import type { Run as Answer } from "../server/schema";
import { button, element } from "../frame/dom";
import { capital, sentence, withUnit } from "../frame/format";
import { inShownUnits } from "../frame/units";

/** Outcomes that state how far a run was followed, not the response of the column. */
const UNDECIDED: readonly string[] = ["STILL_MOVING", "LIMIT_REACHED", "FAILED"];

export class Verdict {
  readonly root = element("div", { class: "verdict", "aria-live": "polite", "aria-atomic": "true" });
  readonly #badge = element("strong", { "aria-hidden": "true" });
  readonly #follow: () => void;
  readonly #vary: HTMLButtonElement;
  /** Which of two columns it is about; empty where one stands alone. */
  readonly #which = element("span", { class: "which" });
  readonly #shares = element("p", { class: "shares", "aria-live": "polite", hidden: true });
  #answer: Answer | null = null;
  #announced = "";

  /** `follow` hears that the run is to last until its outcome is decided, `vary` that small variations are wanted. */
  constructor(follow: () => void, vary: () => void) {
    this.#follow = follow;
    this.#vary = button("Vary it", { class: "small", title: "Repeat the run with 64 small variations" }, vary);
  }

  /** Offers small variations of the run, or none. */
  offerVariations(offered: boolean): void {
    this.#vary.hidden = !offered;
  }

  /** Says which of two columns the outcome is of; null: there is one. */
  setWhich(label: string | null): void {
    this.#which.textContent = label === null ? "" : `${capital(label)}: `;
  }

  /** Shows how often small variations end in each way, or that they are being computed; null: nothing. */
  showShares(line: string | null): void {
    this.#shares.textContent = line ?? "";
    this.#shares.hidden = line === null;
  }

  /** Shows the outcome of a run, whose length may be `stated` or as long as it was needed. */
  show(answer: Answer, stated: boolean): void {
    this.#answer = answer;
    this.setTime(0);
    const text = [answer.outcome, answer.reason, decisionOf(answer), answer.uncertain, ...answer.warnings].join("\n");
    if (text === this.#announced) return; // what has been read out once is not read out again
    this.#announced = text;
    const outcome = element("span", { class: "visually-hidden" }, `${capital(answer.label)}.`);
    const [, remedy] = reasonIn(answer.reason);
    const reason = element("span", { class: "reason" }, reasonLine(answer));
    const marks = answer.uncertain
      ? [
          element(
            "strong",
            { class: "badge unsure", title: "Rounding or the rest threshold could alter the outcome" },
            "Numerically uncertain",
          ),
        ]
      : [];
    const longer = stated && remedy ? [button("Simulate until decided", { class: "small" }, this.#follow)] : [];
    const warnings = answer.warnings.map((line) => element("p", { class: "warning" }, sentence(warningIn(line))));
    this.root.replaceChildren(
      element("p", {}, this.#which, outcome, this.#badge, ...marks, " ", reason, " ", ...longer, " ", this.#vary),
      this.#shares,
      ...warnings,
    );
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

/** Returns a reason without the duration that it asks for, and whether it asks for one. */
export function reasonIn(reason: string): readonly [why: string, longer: boolean] {
  const [why = "", remedy] = reason.split("; set duration to at least");
  return [inShownUnits(withoutOptions(why)), remedy !== undefined];
}

/** The page has no settings of the integration: what a reason says of them is for programs. */
function withoutOptions(line: string): string {
  return line.replace(/, max_steps = .*$/, "");
}

/** Returns a warning without the settings of the integration, with units as they are shown. */
export function warningIn(line: string): string {
  const other = /^the outcome depends on the settings of the integration: .* it is ([A-Z_]+)$/.exec(line)?.[1];
  if (other === undefined) return inShownUnits(line);
  const words = other.toLowerCase().replaceAll("_", " ");
  return `computed with other tolerances it is ${words}: rounding decides, so ask for a probability`;
}

/** Returns what a badge says at a time: what is to come is not said as if it had been. */
export function badgeAt({ outcome, label: name, decided_at: at }: Answer, time: number): string {
  const future = FUTURE[outcome];
  return future === undefined || at === null || time >= at ? capital(name) : `${future} at ${withUnit(at, "s")}`;
}

/** Of outcomes that a column comes to at an instant: how they are announced. */
const FUTURE: Readonly<Record<string, string>> = { OVERTURNED: "Will overturn", LIFTED_OFF: "Will lift off" };

/** Returns why a run ends as it does and when that was decided, as a sentence. */
export function reasonLine(answer: Answer): string {
  return `${sentence(reasonIn(answer.reason)[0])}${decisionOf(answer)}`;
}

/** Returns the verdict in plain text. */
export function verdictOf(answer: Answer): string {
  return `${capital(answer.label)}: ${reasonIn(answer.reason)[0].replace(/[.]$/, "")}.${decisionOf(answer)}`;
}

function decisionOf({ outcome, decided_at: at }: Answer): string {
  const reached = UNDECIDED.includes(outcome) ? "Simulated to" : "Decided at";
  return at === null ? "" : ` ${reached} ${withUnit(at, "s")}.`;
}
