/** The column of controls: preset, column, model, base motion, start and length. */

import {
  type About,
  type Kind,
  type Lesson,
  type Parameter,
  type Preset,
  kindNamed,
  kindsOf,
  partOfKind,
} from "../case/about";
import {
  type Description,
  type Part,
  type PartName,
  type Value,
  kindOf,
  tagOf,
  withPartValue,
  written,
} from "../case/description";
import { angularFrequency, withAngularFrequency } from "../case/frequency";
import { PLANAR, PlaneTurn, inOnePlane, isPlanar } from "../case/in-one-plane";
import type { ColumnScales } from "../case/quantities";
import { atScaleOf } from "../case/scaling";
import type { Branch, HasBranch } from "../case/starting";
import { button, choice, element, newId } from "../frame/dom";
import type { Wrong } from "../frame/problems";
import type { Source } from "../server/source";
import { NumberField } from "./number-field";
import { PartForm } from "./part-form";
import { RecordForm } from "./record-form";
import { StartForm } from "./start-form";

/** The numbers of the kinds that a part has been of: another kind that has them too begins with them. */
export class KeptNumbers {
  readonly #values = new Map<string, Value>();

  keep(kind: Kind, part: Part): void {
    for (const parameter of kind.parameters) {
      const value = part[parameter.name];
      if (value !== undefined) this.#values.set(quantityOf(parameter), value);
    }
  }

  /** Returns the numbers that were kept of those that the kind has. */
  of(kind: Kind): Part {
    const found = kind.parameters.map((one) => [one.name, this.#values.get(quantityOf(one))] as const);
    return Object.fromEntries(found.filter((one): one is readonly [string, Value] => one[1] !== undefined));
  }

  /** What was kept belongs to another case. */
  forget(): void {
    this.#values.clear();
  }
}

/** An amplitude in m is not one in m/s². */
function quantityOf({ name, unit }: Parameter): string {
  return `${name} [${unit ?? ""}]`;
}

export interface ControlsHearing {
  /** A number has been moved. */
  readonly edited: (description: Description) => void;
  /** Another start has been set, or a branch of steady rolling to start on. */
  readonly started: (description: Description, start: Branch | null) => void;
  /** Another case has been chosen. */
  readonly jumped: (description: Description) => void;
  readonly preset: (preset: Preset) => void;
  readonly lesson: (lesson: Lesson) => void;
  readonly sendRecord: Source["sendRecord"];
  readonly hasBranch: HasBranch;
}

export class Controls {
  readonly root: HTMLElement;
  readonly #about: About;
  readonly #hearing: ControlsHearing;
  readonly #presets: HTMLSelectElement;
  readonly #presetText = element("p", { class: "hint" });
  readonly #changed = element("span", { class: "changed unseen" });
  /** The preset that the case was, or is still. */
  #from: Preset | null = null;
  readonly #forms: Readonly<Record<PartName, PartForm>>;
  readonly #record: RecordForm;
  readonly #start: StartForm;
  readonly #duration: NumberField;
  readonly #kept: Readonly<Record<PartName, KeptNumbers>> = {
    column: new KeptNumbers(),
    model: new KeptNumbers(),
    motion: new KeptNumbers(),
  };
  #description: Description;
  /** What the model that rocks in one plane has changed of the case; null: nothing that could be changed back. */
  #turn: PlaneTurn | null = null;
  readonly #turned = element("p", { class: "hint", role: "status", hidden: true });
  readonly #motionSection: HTMLDetailsElement;
  /** Whether a lesson is open, which has the only control in view. */
  #learning: boolean | null = null;
  readonly #toy = element("p", { class: "hint warning", hidden: true }, TOY);

  constructor(about: About, first: Description, problems: HTMLElement, hearing: ControlsHearing) {
    this.#about = about;
    this.#hearing = hearing;
    this.#description = first;
    const id = newId("preset");
    const lessons = about.lessons.map((one, i) => [`${LESSON}${one.id}`, `${i + 1} ${one.title}`, "Lessons"] as const);
    const presets = about.presets.map((preset) => [preset.id, preset.title, "Cases"] as const);
    this.#presets = choice([["", "Your own case"], ...lessons, ...presets], { id }, (value) => this.#choose(value));
    this.#forms = { column: this.#form("column"), model: this.#form("model"), motion: this.#form("motion") };
    const reset = button("Reset", { class: "small" }, () => this.#choosePreset(this.#from?.id ?? ""));
    this.#changed.append("changed ", reset);
    this.#record = new RecordForm(about, hearing.sendRecord, (motion) =>
      hearing.jumped({ ...this.#description, motion }),
    );
    this.#forms.motion.root.insertBefore(this.#record.root, this.#forms.motion.root.lastElementChild);
    this.#forms.motion.root.append(this.#toy);
    this.#forms.model.root.append(this.#turned);
    this.#start = new StartForm(hearing.hasBranch, (description, start) => hearing.started(description, start));
    this.#duration = new NumberField(
      { name: "duration", label: "Duration", symbol: "t", unit: "s", range: null, top: 60, empty: "as needed" },
      (value) => hearing.edited({ ...this.#description, duration: value }),
    );
    const length = element("div", { class: "fields" }, this.#duration.root);
    this.#motionSection = section("Base motion", this.#forms.motion.root);
    this.root = element(
      "aside",
      { class: "controls", "aria-label": "Case" },
      element(
        "div",
        { class: "panel preset" },
        element("div", { class: "preset-head" }, element("label", { for: id }, "Preset"), this.#changed),
        this.#presets,
        this.#presetText,
        button("Upload a record…", { class: "wide", title: "Shake the column with files of your own" }, () =>
          this.#record.upload(),
        ),
      ),
      problems,
      this.#motionSection,
      section("Column", this.#forms.column.root),
      section("Model", this.#forms.model.root),
      section("Initial condition and duration", this.#start.root, length),
    );
  }

  get record(): RecordForm {
    return this.#record;
  }

  show(description: Description, scales: ColumnScales, start: Branch | null, lesson: string | null): void {
    this.#description = description;
    this.#fold(lesson !== null);
    this.#showPreset(description, lesson);
    for (const part of ["column", "model", "motion"] as const)
      this.#forms[part].show(description[part], kindOf(description, part));
    this.#record.show(description.motion);
    this.#toy.hidden = !isToy(description);
    this.#showTurn(description);
    this.#start.show(description, scales, start);
    const duration = description["duration"];
    this.#duration.show(typeof duration === "number" ? duration : null);
  }

  /** In a lesson only its own control is in view; afterwards the base motion is, where there is room. */
  #fold(learning: boolean): void {
    if (learning === this.#learning) return;
    this.#learning = learning;
    this.#motionSection.open = !learning && !matchMedia(NARROW).matches;
  }

  /** Shows which preset the case is, or which one it was changed from: its text stays while its numbers move. */
  #showPreset(description: Description, lesson: string | null): void {
    if (lesson !== null) {
      this.#presets.value = `${LESSON}${lesson}`;
      this.#presetText.hidden = true;
      this.#changed.classList.add("unseen");
      return;
    }
    const same = this.#about.presets.find((one) => written(one.description) === written(description));
    this.#from = same ?? this.#from;
    this.#presets.value = this.#from?.id ?? "";
    this.#presetText.textContent = this.#from?.about ?? "";
    this.#presetText.hidden = !this.#from?.about;
    this.#changed.classList.toggle("unseen", same !== undefined || this.#from === null);
  }

  /** Shows each problem beside the fields that it names. */
  setWrong(wrong: Wrong): void {
    for (const form of Object.values(this.#forms)) form.setWrong(wrong);
    this.#start.setWrong(wrong);
    this.#duration.setWrong(wrong.get("duration"));
  }

  #form(part: PartName): PartForm {
    return new PartForm(LABELS[part], kindsOf(this.#about, part), {
      chosen: (kind) => {
        const chosen = this.#ofKind(part, kind);
        const found = { ...this.#description, [part]: part === "motion" ? this.#withSample(chosen) : chosen };
        const scaled = part === "column" ? atScaleOf(found, this.#description) : found;
        this.#hearing.jumped(this.#fitted(part === "model" ? this.#turnedFor(kind.kind, scaled) : scaled));
      },
      changed: (name: string, value: Value) =>
        this.#hearing.edited(withPartValue(this.#description, part, name, value)),
    });
  }

  /** Returns the case in one plane for the model that rocks in one; any other model brings back what that changed. */
  #turnedFor(model: string, description: Description): Description {
    const rocks = isPlanar(this.#description);
    if (model !== PLANAR) return rocks ? (this.#turn?.undone(description) ?? description) : description;
    const found = inOnePlane(description);
    if (!rocks) this.#turn = new PlaneTurn(description, found);
    return found;
  }

  #showTurn(description: Description): void {
    const line = isPlanar(description) ? (this.#turn?.lineFor(description) ?? "") : "";
    if (line === this.#turned.textContent) return;
    this.#turned.textContent = line;
    this.#turned.hidden = line === "";
  }

  /** Returns the part as one of another kind, with what it has in common with those before; a motion goes as fast. */
  #ofKind(part: PartName, kind: Kind): Part {
    const before = this.#description[part];
    const kept = this.#kept[part];
    const known = kindNamed(this.#about, part, kindOf(this.#description, part));
    if (known !== undefined) kept.keep(known, before);
    const found = partOfKind(kind, tagOf(part), kept.of(kind));
    const frequency = part === "motion" ? angularFrequency(before) : null;
    return frequency === null ? found : withAngularFrequency(found, frequency);
  }

  /** A record needs to be one: the first sample, until another is chosen. */
  #withSample(motion: Part): Part {
    const sample = this.#about.samples[0];
    return motion["kind"] === "record" && sample !== undefined ? { ...motion, sample } : motion;
  }

  /** A run lasts as its base motion, or until its outcome is decided; above a base at rest it needs a length. */
  #fitted(description: Description): Description {
    const moves = kindNamed(this.#about, "motion", kindOf(description, "motion"))?.moves === true;
    return { ...description, duration: moves ? null : (description["duration"] ?? USUAL_DURATION) };
  }

  #choose(value: string): void {
    const lesson = this.#about.lessons.find((one) => value === `${LESSON}${one.id}`);
    if (lesson === undefined) return this.#choosePreset(value);
    this.#from = null;
    this.#hearing.lesson(lesson);
  }

  #choosePreset(id: string): void {
    const preset = this.#about.presets.find((one) => one.id === id);
    if (preset === undefined) return;
    for (const kept of Object.values(this.#kept)) kept.forget();
    this.#turn = null;
    this.#hearing.preset(preset);
  }
}

const LABELS: Readonly<Record<PartName, string>> = {
  column: "Shape of the column",
  model: "Model",
  motion: "Base motion",
};

/** Before the name of a lesson among the presets. */
const LESSON = "lesson ";

/** The column of the equations has its own unit of acceleration, and records have m/s². */
function isToy({ column, motion }: Description): boolean {
  return column["shape"] === "dimensionless" && motion["kind"] === "record";
}

const TOY =
  "The record is in m/s², but a dimensionless column has g = 1 m/s². Choose a shape with lengths, such as solid.";

const USUAL_DURATION = 60; // s

/** Narrow windows have all sections closed: what is to be seen comes first. */
const NARROW = "(max-width: 759px)";

function section(title: string, ...content: readonly HTMLElement[]): HTMLDetailsElement {
  const heading = element("summary", {}, element("h2", {}, title));
  return element("details", { class: "panel section" }, heading, ...content);
}
