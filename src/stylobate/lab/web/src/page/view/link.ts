/**
 * The view in the address bar, after the #: compact, and readable without this page.
 *
 * `column=dimensionless,slenderness:0.1&motion=circular,acceleration:0.065,angular_frequency:1.8&tilt=0.02,0`
 *
 * A part is its kind and its numbers; a vector in it is written `0.1/0.2`, what has parts of its own as JSON after `~`.
 * `lesson=critical` alone is a lesson, `case=temple` a preset; with `view=scene` the scene fills the window.
 */

import { type About, type Lesson, type Preset, kindNamed } from "../case/about";
import {
  type Description,
  PARTS,
  type Part,
  type PartName,
  type Value,
  isPart,
  isVector,
  tagOf,
} from "../case/description";
import { comparisonRead, comparisonWritten, DIFFERENCES } from "../case/comparison";
import { BRANCHES } from "../case/starting";
import { RUN } from "../server/declared";
import {
  type Axis,
  PLANE_KINDS,
  type Plane,
  TABS,
  type View,
  historiesFrom,
  isRange,
  isScene,
  ofPlanes,
  viewOf,
} from "./state";

/** A link that cannot be read; the message says why in one line. */
export class BrokenLink extends Error {}

export function linkOf(view: View): string {
  const { description } = view;
  const items = PARTS.map((part) => `${part}=${partWritten(description[part], tagOf(part))}`);
  for (const [name, value] of Object.entries(description)) {
    if ((PARTS as readonly string[]).includes(name) || value === null) continue;
    items.push(`${name}=${isVector(value) ? value.map(atom).join() : atom(value)}`);
  }
  if (view.range !== null) items.push(`range=${view.range.join()}`);
  for (const kind of PLANE_KINDS) {
    const plane = view[kind];
    if (plane !== null) items.push(`${kind}=${planeWritten(plane)}`);
  }
  if (view.histories !== null) items.push(`histories=${view.histories.join()}`);
  if (view.tab !== "orbit") items.push(`tab=${view.tab}`);
  if (view.filled) items.push("filled=true");
  if (view.start !== null) items.push(`start=${view.start}`);
  if (view.compared !== null) items.push(`beside=${comparisonWritten(view.compared)}`);
  if (view.lesson !== null) items.push(`lesson=${view.lesson}`);
  if (view.scene) items.push("view=scene");
  if (view.time !== null) items.push(`time=${view.time}`);
  if (view.speed !== null) items.push(`speed=${view.speed}`);
  return items.join("&");
}

/** Returns the view of `link`, or raises BrokenLink. */
export function viewFrom(link: string, about: About): View {
  const given = itemsOf(link);
  const looks: Record<string, Value> = {};
  const values: Record<string, Value> = {};
  for (const [name, text] of given) {
    if (isPartName(name)) values[name] = partRead(text, name, about);
    else if (name in LOOKS) looks[name] = LOOKS[name]?.(text) ?? null;
    else if (RUN.includes(name)) values[name] = text.includes(",") ? text.split(",").map(read) : read(text);
    else throw new BrokenLink(`${name} is not known`);
  }
  const { column, model, motion } = values;
  const lesson = about.lessons.find((one) => one.id === looks["lesson"]);
  if (lesson !== undefined && Object.keys(values).length === 0)
    return { ...viewOfLesson(lesson), scene: isScene(looks) };
  if (looks["case"] !== undefined) return { ...viewOfCase(String(looks["case"]), about), scene: isScene(looks) };
  if (!isPart(column)) throw new BrokenLink("column is missing");
  const description: Description = {
    ...values,
    column,
    model: isPart(model) ? model : { kind: "wobbling" },
    motion: isPart(motion) ? motion : { kind: "rest" },
  };
  return viewOf(description, looks);
}

const LOOKS: Readonly<Record<string, (text: string) => Value>> = {
  range: (text) => {
    const range = text.split(",").map(read);
    if (!isRange(range)) throw new BrokenLink(`range must be two rising frequencies, got ${text}`);
    return range;
  },
  ...ofPlanes((kind) => (text: string) => planeRead(kind, text)),
  histories: (text) => {
    const pair = historiesFrom(text.split(","));
    if (pair === null) throw new BrokenLink(`histories must be two quantities of a run, got ${text}`);
    return pair;
  },
  tab: (text) => {
    if (!(TABS as readonly string[]).includes(text)) throw new BrokenLink(`tab must be one of ${TABS.join(", ")}`);
    return text;
  },
  filled: (text) => text === "true",
  start: (text) => {
    if (!(BRANCHES as readonly string[]).includes(text))
      throw new BrokenLink(`start must be one of ${BRANCHES.join(", ")}, got ${text}`);
    return text;
  },
  beside: (text) => {
    if (comparisonRead(text) === null)
      throw new BrokenLink(`beside must be one of ${DIFFERENCES.join(", ")} with its value, got ${text}`);
    return text;
  },
  view: (text) => {
    if (text !== "scene") throw new BrokenLink(`view must be scene, got ${text}`);
    return text;
  },
  lesson: (text) => text,
  case: (text) => text,
  time: (text) => {
    if (!(text !== "" && Number(text) >= 0)) throw new BrokenLink(`time must be zero or positive, got ${text}`);
    return Number(text);
  },
  speed: (text) => {
    if (!(Number(text) > 0)) throw new BrokenLink(`speed must be positive, got ${text}`);
    return Number(text);
  },
};

function itemsOf(link: string): [string, string][] {
  return link
    .replace(/^#/, "")
    .split("&")
    .filter((item) => item !== "")
    .map((item) => {
      const place = item.indexOf("=");
      if (place < 1) throw new BrokenLink(`${item} has no value`);
      return [item.slice(0, place), item.slice(place + 1)];
    });
}

function isPartName(name: string): name is PartName {
  return (PARTS as readonly string[]).includes(name);
}

function partWritten(part: Part, tag: string): string {
  const rest = Object.entries(part).filter(([name, value]) => name !== tag && value !== null);
  return [String(part[tag]), ...rest.map(([name, value]) => `${name}:${inPart(value)}`)].join();
}

function inPart(value: Value): string {
  if (isVector(value) && value.every((one) => !isVector(one) && !isPart(one))) {
    return value.length === 1 ? `${atom(value[0] ?? null)}/` : value.map(atom).join("/");
  }
  return atom(value);
}

function atom(value: Value): string {
  if (isVector(value) || isPart(value)) return `~${encodeURIComponent(JSON.stringify(value))}`;
  if (typeof value !== "string") return value === null ? "none" : String(value);
  // A name that could be read as a number has a mark before it.
  return `${/^[-+.\d'~]|^(none|true|false)$/.test(value) ? "'" : ""}${encodeURIComponent(value)}`;
}

function partRead(text: string, part: PartName, about: About): Part {
  const [kind = "", ...items] = text.split(",");
  const known = kindNamed(about, part, kind);
  if (known === undefined) throw new BrokenLink(`${part} ${kind} is not known`);
  const pairs = items.map((item): [string, Value] => {
    const place = item.indexOf(":");
    if (place < 1) throw new BrokenLink(`${part} ${item} has no value`);
    const name = item.slice(0, place);
    if (!isKnown(name, part, about, kind)) throw new BrokenLink(`${part} ${kind} has no ${name}`);
    return [name, readInPart(item.slice(place + 1))];
  });
  return { [tagOf(part)]: kind, ...Object.fromEntries(pairs) };
}

function isKnown(name: string, part: PartName, about: About, kind: string): boolean {
  const parameters = kindNamed(about, part, kind)?.parameters ?? [];
  // What a kind has besides its numbers (the sample of a record, the members of a sum) is for the server to judge.
  return parameters.some((one) => one.name === name) || part === "motion" || name === "gravity";
}

function readInPart(text: string): Value {
  if (!text.includes("/")) return read(text);
  return text.replace(/\/$/, "").split("/").map(read);
}

function read(text: string): Value {
  if (text === "none") return null;
  if (text === "true" || text === "false") return text === "true";
  const decoded = unescaped(text);
  if (decoded.startsWith("'")) return decoded.slice(1);
  if (decoded.startsWith("~")) return fromJson(decoded.slice(1));
  const number = Number(decoded);
  if (/^[-+.\d]/.test(decoded)) {
    if (!Number.isFinite(number)) throw new BrokenLink(`${decoded} is no number`);
    return number;
  }
  return decoded;
}

function unescaped(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    throw new BrokenLink(`${text} is not well formed`);
  }
}

function fromJson(text: string): Value {
  try {
    return JSON.parse(text) as Value;
  } catch {
    throw new BrokenLink(`${text} is not well formed`);
  }
}

function planeWritten(plane: Plane): string {
  const axes = [plane.x, plane.y].map((axis) => [axis.name, axis.from, axis.to, axis.number].join(":"));
  return [...axes, ...(plane.start === undefined ? [] : [plane.start])].join();
}

function planeRead(what: string, text: string): Value {
  const parts = text.split(",");
  const start = BRANCHES.find((one) => one === parts[2]);
  const axes = (start === undefined ? parts : parts.slice(0, 2)).map((part): Axis | null => {
    const [name = "", from, to, number, ...more] = part.split(":");
    const axis = { name, from: Number(from), to: Number(to), number: Number(number) };
    const whole = Number.isInteger(axis.number) && axis.number > 1;
    return /^[a-z_]+$/.test(name) && axis.from < axis.to && whole && more.length === 0 ? axis : null;
  });
  const [x, y] = axes;
  if (!x || !y || axes.length > 2 || x.name === y.name) {
    throw new BrokenLink(`${what} must be two axes, name:from:to:number, got ${text}`);
  }
  return { x: { ...x }, y: { ...y }, ...(start === undefined ? {} : { start }) };
}

/** Returns the line for a link that cannot be followed. */
export function inWords(reason: string): string {
  return `This link cannot be opened: ${reason.replace(/\.$/, "")}. The first lesson is shown instead.`;
}

// Views of presets, lessons and links

function viewOfCase(name: string, about: About): View {
  const preset = about.presets.find((one) => one.id === name);
  if (preset === undefined) throw new BrokenLink(`case ${name} is not known`);
  return viewOfPreset(preset);
}

export function viewOfPreset(preset: Preset): View {
  return viewOf(preset.description, preset.view ?? {});
}

export function viewOfLesson(lesson: Lesson): View {
  return viewOf(lesson.description, { ...lesson.view, lesson: lesson.id });
}

/** Returns the view with which the page opens: a question. */
export function firstView(about: About): View {
  const [opening] = about.lessons;
  if (opening === undefined) throw new Error("the server has no lessons");
  return viewOfLesson(opening);
}

/** Returns the view of a link, or that of the first lesson with a line that says what is wrong with the link. */
export function viewOfLink(link: string, about: About): readonly [view: View, problem: string | null] {
  if (link === "" || link === "#") return [firstView(about), null];
  try {
    return [viewFrom(link, about), null];
  } catch (error) {
    if (error instanceof BrokenLink) return [firstView(about), inWords(error.message)];
    throw error;
  }
}

// The address bar

/** Browsers refuse more than some hundred changes in half a minute: while a slider is dragged, a few a second do. */
const PAUSE = 250; // ms

/** The address bar follows the view: at every change, and with an entry in the history at every jump. */
export class Address {
  #due: ReturnType<typeof setTimeout> | null = null;
  #view: View | null = null;

  /** Writes the view into the address, soon. */
  replace(view: View): void {
    this.#view = view;
    this.#due ??= setTimeout(() => this.flush(), PAUSE);
  }

  /** Writes the view into the address, as a new entry of the history. */
  push(view: View): void {
    this.flush();
    history.pushState(null, "", `#${linkOf(view)}`);
  }

  /** Writes at once what is due. */
  flush(): void {
    if (this.#due !== null) clearTimeout(this.#due);
    this.#due = null;
    if (this.#view !== null) history.replaceState(null, "", `#${linkOf(this.#view)}`);
    this.#view = null;
  }
}
