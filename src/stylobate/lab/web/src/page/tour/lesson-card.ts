/** A lesson of the tour: a question, one control, and what the outcome means. */

import type { About, Lesson } from "../case/about";
import { type Description, isPart, written } from "../case/description";
import { mapQuantities, valueOf, withValue, type ColumnScales, type Quantity } from "../case/quantities";
import { NumberField } from "../controls/number-field";
import { button, element, newId } from "../frame/dom";
import { capital, frequencyText, words } from "../frame/format";
import { frequencyScaling } from "../frame/units";
import { START } from "../server/declared";
import type { View } from "../view/state";

export interface LessonHearing {
  readonly changed: (description: Description) => void;
  readonly gone: (lesson: Lesson) => void;
  readonly closed: () => void;
}

/** The control of a lesson: shows a case, and changes it. */
interface Control {
  readonly root: HTMLElement;
  readonly show: (description: Description) => void;
}

export class LessonCard {
  readonly root = element("section", { class: "panel lesson", "aria-label": "Lesson", hidden: true });
  readonly #about: About;
  readonly #hearing: LessonHearing;
  readonly #steps: readonly HTMLButtonElement[];
  readonly #question = element("h2", {});
  readonly #task = element("p", { class: "task" });
  readonly #control = element("div", { class: "lesson-control" });
  readonly #said = element("p", { class: "said", "aria-live": "polite" });
  readonly #restore = button("Back to the lesson", { class: "small", hidden: true }, () => {
    if (this.#lesson !== null) this.#hearing.gone(this.#lesson);
  });
  readonly #next: HTMLButtonElement;
  readonly #nextTitle = element("span", { class: "next-title" });
  #lesson: Lesson | null = null;
  #shown: readonly Control[] = [];
  #description: Description | null = null;
  #outcome: string | null = null;
  #critical: number | null = null;
  /** Whether the case is that of the lesson, but for its control. */
  #own = true;
  /** What small variations of the run add; empty where there are none. */
  #varied = "";

  constructor(about: About, hearing: LessonHearing) {
    this.#about = about;
    this.#hearing = hearing;
    this.#steps = about.lessons.map((lesson, i) =>
      button(String(i + 1), { class: "step", title: lesson.title, "aria-label": titleOf(lesson, i) }, () =>
        hearing.gone(lesson),
      ),
    );
    const list = element("ol", {}, ...this.#steps.map((one) => element("li", {}, one)));
    this.#next = button("Next", { class: "small next" }, () => this.#goOn());
    this.#next.append(this.#nextTitle);
    const close = button(
      "×",
      { class: "icon close-tour", "aria-label": "Close the tour", title: "Close the tour" },
      hearing.closed,
    );
    this.root.append(
      element("nav", { "aria-label": "Tour" }, list, this.#next, close),
      element("div", { class: "asked" }, this.#question, this.#task),
      this.#control,
      element("div", { class: "said-line" }, this.#said, this.#restore),
    );
  }

  /** Shows the lesson of a view, or none; the ranges of its control follow from the column. */
  show({ lesson: name, description, start }: View, scales: ColumnScales): void {
    const lesson = this.#about.lessons.find((one) => one.id === name) ?? null;
    this.#description = description;
    this.root.hidden = lesson === null;
    if (lesson !== this.#lesson) this.#begin(lesson, scales);
    for (const one of this.#shown) one.show(description);
    this.#own = lesson === null || isOf(lesson, description, start);
    this.#restore.hidden = this.#own;
    this.#say();
  }

  /** Says what an outcome means; null: it is not known yet, and what was said is no longer sure. */
  setOutcome(outcome: string | null): void {
    this.#outcome = outcome;
    this.#varied = "";
    this.#say();
  }

  /** Adds what small variations of the run say about its outcome. */
  setVaried(line: string): void {
    this.#varied = line;
    this.#say();
  }

  /** Takes the critical frequency of the case [rad/s]; null where it has none. */
  setCritical(frequency: number | null): void {
    this.#critical = frequency;
    this.#say();
  }

  #begin(lesson: Lesson | null, scales: ColumnScales): void {
    this.#lesson = lesson;
    this.#outcome = null;
    this.#said.textContent = "";
    if (lesson === null) return;
    const { lessons } = this.#about;
    const place = lessons.indexOf(lesson);
    this.#steps.forEach((step, i) => {
      if (i === place) {
        step.setAttribute("aria-current", "step");
        step.parentElement!.parentElement!.scrollLeft = step.offsetLeft - 2 * step.offsetWidth;
      } else step.removeAttribute("aria-current");
    });
    this.#question.textContent = lesson.question;
    this.#task.textContent = lesson.task;
    const next = lessons[(place + 1) % lessons.length];
    this.#nextTitle.textContent = next === undefined ? "" : `: ${next.title}`;
    this.#shown = this.#controlsOf(lesson, scales);
    this.#control.replaceChildren(...this.#shown.map((one) => one.root));
  }

  #goOn(): void {
    const { lessons } = this.#about;
    const next = lessons[(lessons.findIndex((one) => one === this.#lesson) + 1) % lessons.length];
    if (next !== undefined) this.#hearing.gone(next);
  }

  #controlsOf({ control, description }: Lesson, scales: ColumnScales): readonly Control[] {
    const quantity = mapQuantities(description, this.#about, scales).find((one) => one.name === control.number);
    return [
      ...(quantity === undefined ? [] : [this.#number(quantity, control.from ?? 0, control.to ?? 1)]),
      ...(control.options ? [this.#choices(control.options)] : []),
    ];
  }

  #number({ name, unit: kept }: Quantity, from: number, to: number): Control {
    const { unit, factor } = name === "angular_frequency" ? frequencyScaling() : { unit: kept, factor: 1 };
    const label = unit === "Hz" ? "Frequency" : capital(words(name));
    const range = [from, to].map((one) => rounded(one * factor, SHOWN)) as [number, number];
    const field = new NumberField({ name, label, symbol: "", unit, range }, (value) => {
      if (value !== null && this.#description !== null)
        this.#hearing.changed(withValue(this.#description, name, rounded(value / factor, KEPT)));
    });
    const shown = (value: number | undefined): number | null =>
      value === undefined ? null : rounded(value * factor, SHOWN);
    return { root: field.root, show: (description) => field.show(shown(valueOf(description, name))) };
  }

  #choices(options: NonNullable<Lesson["control"]["options"]>): Control {
    const name = newId("choice");
    const made = options.map(({ text, change }) => {
      const mark = element("input", { type: "radio", name });
      mark.addEventListener("change", () => {
        if (this.#description !== null) this.#hearing.changed({ ...this.#description, ...change } as Description);
      });
      return { mark, change, label: element("label", {}, mark, text) };
    });
    return {
      root: element("div", { class: "choices", role: "radiogroup" }, ...made.map((one) => one.label)),
      show: (description) => {
        for (const { mark, change } of made)
          mark.checked = Object.entries(change).every(
            ([part, value]) => isPart(value as never) && written(value as never) === written(description[part] ?? null),
          );
      },
    };
  }

  #say(): void {
    const own = this.#outcome === null ? undefined : this.#lesson?.said[this.#outcome];
    const text = this.#own ? own : CHANGED;
    if (text === undefined) return;
    const critical = this.#critical === null ? "" : ` ${frequencyText(this.#critical, 3)}`;
    // What “Vary it” was asked for is answered: the question gives way to the answer.
    const said = this.#varied === "" ? text : `${text.replace(/ ?Vary it: [^?]*\?/, "")} ${this.#varied}`;
    const line = said.replaceAll(/ ?\{critical\}/g, critical);
    if (line !== this.#said.textContent) this.#said.textContent = line;
  }
}

/** Digits of a number as it is shown, and as it is kept in another unit: what is kept is shown as it was written. */
const [SHOWN, KEPT] = [5, 6];

function rounded(value: number, digits: number): number {
  return Number(value.toPrecision(digits));
}

/** What a lesson says of a case that is not its own. */
const CHANGED = "This case is no longer that of the lesson: what the lesson says of it need not hold.";

/** Returns whether a case is that of a lesson, but for its control. */
export function isOf(
  { description: own, control, view }: Lesson,
  description: Description,
  start: View["start"],
): boolean {
  const changed = control.number === undefined ? null : valueOf(description, control.number);
  if (changed === undefined) return false;
  const expected = changed === null ? own : withValue(own, control.number!, changed);
  const chosen = (control.options ?? []).flatMap(({ change }) => Object.keys(change));
  const alike = (name: string): boolean => written(expected[name] ?? null) === written(description[name] ?? null);
  const parts = ["column", "model", "motion"].filter((name) => !chosen.includes(name));
  const started = (view["start"] ?? null) === null ? START.every(alike) : true;
  return start === (view["start"] ?? null) && started && parts.every(alike);
}

function titleOf(lesson: Lesson, place: number): string {
  return `Lesson ${place + 1}: ${lesson.title}`;
}
