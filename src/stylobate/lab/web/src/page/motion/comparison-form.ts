/** The second column beside the first: what differs, of which value, and its outcome in words. */

import type { About } from "../case/about";
import { kindNamed } from "../case/about";
import type { Comparison, Difference } from "../case/comparison";
import { DIFFERENCES, differencesOf, firstComparison, otherModels } from "../case/comparison";
import { type Description, kindOf } from "../case/description";
import { NumberField } from "../controls/number-field";
import { button, choice, element } from "../frame/dom";
import { capital, sentence, words } from "../frame/format";
import type { Run as Answer } from "../server/schema";
import { badgeAt, reasonLine, warningIn } from "./verdict";

/** The value of a comparison, as the reader sets it. */
interface ValueControl {
  readonly root: HTMLElement;
  readonly show: (comparison: Comparison) => void;
}

/** Numbers that may differ, with the ends of their sliders. */
const NUMBERS: Readonly<Record<Exclude<Difference, "model">, readonly [label: string, from: number, to: number]>> = {
  damping: ["Second damping", 0, 0.5],
  size: ["Times the size", 0.2, 5],
  slenderness: ["Second slenderness", 0.02, 0.5],
};

export class ComparisonForm {
  readonly root = element("section", { class: "compare", "aria-label": "Second column" });
  readonly #about: About;
  readonly #changed: (comparison: Comparison | null) => void;
  readonly #differs: HTMLSelectElement;
  readonly #value = element("span", { class: "compare-value" });
  readonly #remove: HTMLButtonElement;
  readonly #outcome = element("p", { class: "compare-outcome", tabindex: 0, "aria-live": "polite", hidden: true });
  readonly #badge = element("strong");
  #control: ValueControl | null = null;
  /** For which difference, of which case, the control of the value was made. */
  #made = "";
  #description: Description | null = null;
  #answer: Answer | null = null;

  constructor(about: About, changed: (comparison: Comparison | null) => void) {
    this.#about = about;
    this.#changed = changed;
    const options = DIFFERENCES.map((one) => [one, `another ${one}`] as const);
    this.#differs = choice([["", "Compare with…"], ...options], { "aria-label": "Compare with" }, (name) => {
      const differs = DIFFERENCES.find((one) => one === name);
      if (this.#description === null) return;
      changed(differs === undefined ? null : firstComparison(differs, this.#description, about));
    });
    this.#remove = button("Remove", { class: "small", title: "Remove the second column", hidden: true }, () =>
      changed(null),
    );
    const row = element("div", { class: "compare-row" }, this.#differs, this.#value, this.#remove);
    this.root.append(row, this.#outcome);
  }

  /** Shows what differs of a second column beside that of a case; null: there is none. */
  show(description: Description, comparison: Comparison | null): void {
    this.#description = description;
    const offered = differencesOf(description);
    for (const option of this.#differs.options) {
      const differs = DIFFERENCES.find((one) => one === option.value);
      option.hidden = differs !== undefined && !offered.includes(differs) && differs !== comparison?.differs;
    }
    this.#differs.value = comparison?.differs ?? "";
    this.#remove.hidden = comparison === null;
    this.root.classList.toggle("on", comparison !== null);
    this.#showValue(description, comparison);
    if (comparison === null) this.say(null);
  }

  /** Shows the outcome of the second run with its label, a line in its place, or nothing. */
  say(found: string | { readonly answer: Answer; readonly label: string } | null): void {
    this.#answer = found === null || typeof found === "string" ? null : found.answer;
    this.#outcome.hidden = found === null;
    this.#outcome.classList.toggle("warning", typeof found === "string" && !found.endsWith("…"));
    if (found === null || typeof found === "string") return this.#outcome.replaceChildren(found ?? "");
    const { answer, label } = found;
    const warnings = answer.warnings.map((line) =>
      element("span", { class: "warning" }, ` ${sentence(warningIn(line))}`),
    );
    this.setTime(0);
    const which = element("span", { class: "which" }, `${capital(label)}: `);
    this.#outcome.replaceChildren(which, this.#badge, ` ${reasonLine(answer)}`, ...warnings);
  }

  /** Shows the outcome as it is known at a time of the run. */
  setTime(time: number): void {
    if (this.#answer === null) return;
    const text = badgeAt(this.#answer, time);
    if (text === this.#badge.textContent) return;
    this.#badge.textContent = text;
    this.#badge.className = `badge ${this.#answer.outcome.toLowerCase()}`;
  }

  #showValue(description: Description, comparison: Comparison | null): void {
    const wanted =
      comparison === null
        ? ""
        : [comparison.differs, comparison.differs === "model" && kindOf(description, "model")].join();
    if (wanted !== this.#made) {
      this.#made = wanted;
      this.#control = comparison === null ? null : this.#controlOf(comparison.differs, description);
      this.#value.replaceChildren(...(this.#control === null ? [] : [this.#control.root]));
    }
    if (comparison !== null) this.#control?.show(comparison);
  }

  #controlOf(differs: Difference, description: Description): ValueControl {
    return differs === "model" ? this.#models(description) : this.#number(differs);
  }

  #models(description: Description): ValueControl {
    const kinds = otherModels(description, this.#about).map(({ kind, name }) => [kind, words(name)] as const);
    const root = choice(kinds, { "aria-label": "Model of the second column" }, (value) =>
      this.#changed({ differs: "model", value }),
    );
    return {
      root,
      show: ({ value }) => {
        const kind = String(value);
        if (![...root.options].some((one) => one.value === kind))
          root.append(element("option", { value: kind }, words(kindNamed(this.#about, "model", kind)?.name ?? kind)));
        root.value = kind;
      },
    };
  }

  #number(differs: Exclude<Difference, "model">): ValueControl {
    const [label, from, to] = NUMBERS[differs];
    const looks = { name: `second_${differs}`, label, symbol: "", unit: "", range: [from, to] as const };
    const field = new NumberField(looks, (value) => {
      if (value !== null) this.#changed({ differs, value });
    });
    return { root: field.root, show: ({ value }) => field.show(Number(value)) };
  }
}
