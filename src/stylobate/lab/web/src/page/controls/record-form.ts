/** Which record: one that comes with the package, or files of the user's own. */

import type { About } from "../case/about";
import type { UploadedRecord } from "../server/schema";
import { Refused, type Source, Unreachable } from "../server/source";
import type { Part, Value } from "../case/description";
import { LENGTH, canFeel, feel, tableOf } from "./phone";
import { button, choice, element, newId } from "../frame/dom";
import { capital, sentence, formatted } from "../frame/format";

const UNITS = [
  ["", "unit: from the file"],
  ["g", "unit: g"],
  ["cm/s2", "unit: cm/s²"],
  ["m/s2", "unit: m/s²"],
  ["mm/s2", "unit: mm/s²"],
] as const;

const MOST_FILES = 3;
const MOVE = "Move this phone…";
/** Neither the page nor its server has the files of an upload. */
export const NOT_HERE = "The record of this case is not here any more. Choose its files again.";
const OWN = "\u0000own"; // no sample has this name

/** What the server asks for in its own words, and in those of this form. */
const ASKED: readonly (readonly [RegExp, string])[] = [
  [/state units, .*$/, "choose its unit above."],
  [/units must be left out or '(.*?)', which.*$/, "the file states the unit $1; choose “unit: from the file”."],
  [/state step\b.*$/, "enter the time step above."],
  [/name that \(units\)/, "choose that above"],
  [/List the files of the event together, or set single.*$/, "Choose all files of the event together, if it has more"],
  [/List the files of each event together$/, "Choose the files of one event only"],
  [/Set lengths to pad, or check/, "Check"],
];

/** Returns a line of the server with the names of the controls of this form. */
export function inWordsOfForm(line: string): string {
  return ASKED.reduce((text, [asked, here]) => text.replace(asked, here), line);
}

/** A record that was uploaded: what the server said of it, and what was sent. */
interface Kept {
  readonly received: UploadedRecord;
  readonly body: Part;
}

export class RecordForm {
  readonly root: HTMLElement;
  readonly #sendRecord: Source["sendRecord"];
  readonly #changed: (motion: Part) => void;
  readonly #source: HTMLSelectElement;
  readonly #own: HTMLElement;
  readonly #files = element("input", { type: "file", multiple: true });
  /** The records in an archive. */
  readonly #record = element("select", { "aria-label": "Record in the archive", hidden: true });
  readonly #units = choice(UNITS, { "aria-label": "Unit of the record" }, () =>
    this.#send(this.#chosen, this.#record.value),
  );
  readonly #step = element("input", {
    inputmode: "decimal",
    "aria-label": "Time step of the record [s], if the file states none",
    placeholder: "time step [s]: from the file",
  });
  readonly #summary = element("p", { class: "hint", "aria-live": "polite" });
  readonly #warnings = element("div", { class: "warnings", "aria-live": "polite" });
  readonly #problem = element("p", { class: "problem", role: "alert", hidden: true });
  readonly #known = new Map<string, Kept>();
  readonly #phone = button(MOVE, { class: "wide", hidden: !canFeel() }, () => void this.#feel());
  #motion: Part = {};
  /** The files that were chosen last. */
  #chosen: readonly File[] = [];
  /** Whether files are to be chosen, while the motion is still that of a sample. */
  #choosing = false;

  constructor(about: About, sendRecord: Source["sendRecord"], changed: (motion: Part) => void) {
    this.#sendRecord = sendRecord;
    this.#changed = changed;
    const [id, fileId] = [newId("record"), newId("files")];
    const samples = about.samples.map((name) => [name, capital(name)] as const);
    this.#source = choice([...samples, [OWN, "Your own files…"]], { id }, (value) => this.#choose(value));
    this.#files.id = fileId;
    this.#files.addEventListener("change", () => this.#send([...(this.#files.files ?? [])]));
    this.#record.addEventListener("change", () => this.#send(this.#chosen, this.#record.value));
    const label = element(
      "label",
      { for: fileId, class: "visually-hidden" },
      "Files of the record: one to three, or a zip archive",
    );
    const again = button("Choose files…", { class: "wide" }, () => this.#files.click());
    this.#step.addEventListener("change", () => this.#send(this.#chosen, this.#record.value));
    this.#files.classList.add("visually-hidden");
    this.#files.tabIndex = -1; // the button beside it is the one to reach
    this.#own = element(
      "div",
      { class: "own-record" },
      label,
      this.#files,
      again,
      this.#record,
      this.#units,
      this.#step,
    );
    const source = element("div", { class: "field choice" }, element("label", { for: id }, "Record"), this.#source);
    const said = [this.#summary, this.#warnings, this.#problem];
    this.root = element("div", { class: "record" }, source, this.#own, this.#phone, ...said);
    this.#takeDrops();
  }

  show(motion: Part): void {
    const { kind, sample: before } = this.#motion;
    if (motion["kind"] !== kind || motion["sample"] !== before) this.#choosing = false;
    this.#motion = motion;
    this.root.hidden = motion["kind"] !== "record" && !this.#choosing;
    if (this.root.hidden) return;
    const { sample, upload } = motion;
    const own = this.#choosing || typeof sample !== "string";
    this.#source.value = own ? OWN : sample;
    this.#own.hidden = !own;
    const known = typeof upload === "string" ? this.#known.get(upload) : undefined;
    this.#summary.textContent = known ? summaryOf(known.received) : "";
    this.#summary.hidden = !known;
    this.#offerRecords(known);
    const lines = (known?.received.warnings ?? []).map(inWordsOfForm);
    this.#warnings.replaceChildren(...lines.map((line) => element("p", { class: "warning" }, sentence(line))));
    if (!own) this.#report(null);
  }

  /** Sends an upload once more that the server does not hold any more; false where this page has not its files. */
  async restore(upload: Value | undefined): Promise<boolean> {
    const kept = typeof upload === "string" ? this.#known.get(upload) : undefined;
    if (kept === undefined) return false;
    return (await this.#sendRecord(kept.body)).upload === upload;
  }

  /** Asks for the files of an upload that neither the server nor this page has. */
  askAgain(): void {
    const section = this.root.closest("details");
    if (section !== null) section.open = true;
    this.#report(NOT_HERE);
  }

  /** Asks for files, whatever the base motion is. */
  upload(): void {
    const section = this.root.closest("details");
    if (section !== null) section.open = true;
    this.#choose(OWN);
  }

  #choose(value: string): void {
    if (value !== OWN) {
      this.#choosing = false;
      this.#changed({ kind: "record", sample: value, scale: this.#motion["scale"] ?? 1 });
      return;
    }
    this.#choosing = true; // the motion stays until there are files
    this.show(this.#motion);
    this.#files.click();
  }

  #report(problem: string | null): void {
    this.#problem.textContent = problem ?? "";
    this.#problem.hidden = problem === null;
  }

  /** Offers the records of the archive from which the record that is shown was taken. */
  #offerRecords(known: Kept | undefined): void {
    const records = known?.received.records ?? [];
    this.#record.hidden = records.length < 2;
    this.#record.replaceChildren(...records.map((name) => element("option", { value: name }, name)));
    const given = known?.body["record"];
    this.#record.value = typeof given === "string" ? given : (records[0] ?? "");
  }

  /** Takes files that are dropped on the form. */
  #takeDrops(): void {
    this.root.addEventListener("dragover", (event) => event.preventDefault());
    this.root.addEventListener("drop", (event) => {
      event.preventDefault();
      void this.#send([...(event.dataTransfer?.files ?? [])]);
    });
  }

  /** Sends the files of an event, or an archive with the name of a record in it. */
  async #send(files: readonly File[], record = ""): Promise<void> {
    if (files.length === 0) return;
    if (files !== this.#chosen) this.#record.replaceChildren(); // they were those of another archive
    this.#chosen = files;
    this.#choosing = typeof this.#motion["upload"] !== "string";
    if (files.length > MOST_FILES) {
      this.#report(`A record has at most ${MOST_FILES} files, one for each direction; ${files.length} were chosen.`);
      return;
    }
    const contents = await Promise.all(files.map(async (file) => ({ name: file.name, content: await base64(file) })));
    const named = record === "" ? {} : { record };
    await this.#take({ files: contents, units: this.#units.value || null, step: stepIn(this.#step.value), ...named });
  }

  /** Takes what a phone feels while it is tilted and shaken as a record. */
  async #feel(): Promise<void> {
    this.#phone.disabled = true;
    this.#report(null);
    try {
      const felt = await feel(LENGTH, (left) => (this.#phone.textContent = `Tilt and shake it: ${left} s`));
      const content = btoa(tableOf(felt));
      await this.#take({ files: [{ name: "phone.csv", content }], units: null, step: null });
    } catch (error) {
      this.#report(error instanceof Error ? error.message : String(error));
    } finally {
      this.#phone.disabled = false;
      this.#phone.textContent = MOVE;
    }
  }

  async #take(body: Part): Promise<void> {
    try {
      const received = await this.#sendRecord(body);
      this.#known.set(received.upload, { received, body });
      this.#report(null);
      this.#changed({ kind: "record", upload: received.upload, scale: this.#motion["scale"] ?? 1 });
    } catch (error) {
      if (error instanceof Unreachable)
        this.#report("The server does not answer. Choose the files again when it does.");
      else this.#report(error instanceof Refused ? error.problems.map(inWordsOfForm).join(" ") : String(error));
    }
  }
}

/** Returns a time step as it is sent: what is no number is refused there. */
function stepIn(text: string): number | string | null {
  const written = text.trim().replace(",", ".");
  return written === "" ? null : Number.isFinite(Number(written)) ? Number(written) : text;
}

function summaryOf(record: UploadedRecord): string {
  const peaks = Object.entries(record.peaks).map(([axis, peak]) => `${axis} ${formatted(peak)} m/s²`);
  const length = `${record.samples} samples, ${formatted(record.duration)} s in steps of ${formatted(record.step)} s`;
  return `${record.name}: ${length}; peaks ${peaks.join(", ")}.`;
}

/** Returns the content of a file in base64. */
async function base64(file: File): Promise<string> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const pieces: string[] = [];
  // In pieces: a call takes only so many arguments.
  for (let at = 0; at < bytes.length; at += 0x8000)
    pieces.push(String.fromCharCode(...bytes.subarray(at, at + 0x8000)));
  return btoa(pieces.join(""));
}
