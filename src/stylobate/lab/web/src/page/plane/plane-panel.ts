/** An overturning map or a basin: its axes, its picture while it fills in, what its colours mean. */

import type { GridResult, Job as JobReport, PlaneAxis, PlaneBegun } from "../server/schema";
import { button, element } from "../frame/dom";
import { capital, counted, formatted, withUnit, words } from "../frame/format";
import { Elapsed } from "../frame/elapsed";
import { GRIDS } from "../server/declared";
import type { Job } from "../server/job";
import type { Quantity } from "../case/quantities";
import { type Axis, PLANES, type Plane, type PlaneKind } from "../view/state";
import type { Description, Part } from "../case/description";
import type { HasBranch } from "../case/starting";
import { AxesForm } from "./axes-form";
import { Cells } from "./cells";
import { Classes } from "./classes";
import type { Place } from "./plane-canvas";
import { PlaneCanvas } from "./plane-canvas";

export interface PlaneHearing {
  readonly axes: (plane: Plane) => void;
  readonly asked: () => void;
  readonly cancelled: () => void;
  /** Starts the motion of a cell. */
  readonly chosen: (x: readonly [string, number], y: readonly [string, number]) => void;
}

export class PlanePanel {
  readonly root: HTMLElement;
  readonly #kind: PlaneKind;
  readonly #hearing: PlaneHearing;
  readonly #canvas: PlaneCanvas;
  readonly #axesForm: AxesForm;
  readonly #go: HTMLButtonElement;
  readonly #progress = element("progress", { max: 1, hidden: true, "aria-label": "Progress" });
  readonly #readout = element("p", { class: "note readout", "aria-live": "polite" });
  readonly #problem = element("p", { class: "problem", role: "alert", hidden: true });
  readonly #classes = new Classes();
  #plane: Plane | null = null;
  #values: Place | null = null;
  #job: Job | null = null;
  /** What the server refused of the last job. */
  #refused: readonly string[] = [];
  readonly #elapsed = new Elapsed((message) => (this.#readout.textContent = message));
  #complete = false;
  #key = "";
  #shownKey = "";
  #axes: PlaneBegun["axes"] | null = null;
  #filled: Cells | null = null;
  /** How long runs of the case last, and those of the picture do. */
  #runs = "";
  #length = "";

  constructor(kind: PlaneKind, hasBranch: HasBranch, hearing: PlaneHearing) {
    this.#kind = kind;
    this.#hearing = hearing;
    this.#canvas = new PlaneCanvas(
      (cell) => this.#point(cell),
      (cell) => this.#choose(cell),
    );
    this.#axesForm = new AxesForm(GRIDS[kind].starts ? null : hasBranch, {
      axes: hearing.axes,
      judged: () => this.#showProblems(),
    });
    this.#go = button("Compute", { class: "primary small" }, () => this.#pressed());
    const bar = element("div", { class: "plane-bar" }, this.#axesForm.root, this.#progress, this.#go);
    this.root = element(
      "div",
      { class: `plane-panel ${kind}` },
      bar,
      this.#problem,
      this.#canvas.root,
      this.#readout,
      this.#classes.legend,
    );
  }

  /** Shows the axes and the values of the case; a picture of another case is marked as one. */
  show(
    plane: Plane,
    quantities: readonly Quantity[],
    description: Description,
    values: Place | null,
    length: Part,
    key: string,
  ): void {
    this.#plane = plane;
    this.#values = values;
    this.#runs = lengthInWords(length) + (GRIDS[this.#kind].starts ? "" : startInWords(plane));
    this.#key = key;
    this.#axesForm.show(plane, quantities, description);
    if (this.#shownKey !== key) this.#stop(); // nobody sees the rest of an earlier case
    const stale = this.#axes !== null && this.#shownKey !== key;
    this.root.classList.toggle("stale", stale);
    if (this.#axes === null) this.#rest(plane, quantities);
    else this.#redraw();
    if (stale) this.#readout.textContent = STALE;
  }

  /** The job that fills the picture from now on. */
  follow(
    start: (
      report: (report: JobReport) => void,
      ended: (last: JobReport | null, problems: readonly string[]) => void,
    ) => Job,
  ): void {
    this.#job?.cancel();
    this.#complete = false;
    this.#shownKey = this.#key;
    this.#length = this.#runs;
    this.#filled = null;
    this.#go.textContent = "Cancel";
    this.#axesForm.fold(); // the picture needs the room
    this.#progress.hidden = false;
    this.#progress.removeAttribute("value");
    this.root.classList.remove("stale");
    this.#elapsed.begin("Starting…");
    this.#job = start(
      (report) => this.#take(report),
      (last, problems) => this.#end(last, problems),
    );
    this.#refuse([]);
  }

  /** Returns the place of a cell in the window [px], and its size: for those who test the page. */
  clientPlace(cell: Place): Place {
    return this.#canvas.clientPlace(cell);
  }

  get axes(): PlaneBegun["axes"] | null {
    return this.#axes;
  }

  get filled(): Cells | null {
    return this.#filled;
  }

  /** Whether the picture of this case is all there, or on its way. */
  get current(): boolean {
    return this.#shownKey === this.#key && (this.#complete || this.#job !== null);
  }

  get running(): boolean {
    return this.#job !== null;
  }

  redraw(): void {
    this.#canvas.redraw();
  }

  #pressed(): void {
    if (this.#job === null) {
      this.#hearing.asked();
      return;
    }
    this.#stop();
    this.#readout.textContent = "Cancelled. The computed cells stay.";
    this.#hearing.cancelled();
  }

  #stop(): void {
    if (this.#job === null) return;
    this.#job.cancel();
    this.#end(null, []);
  }

  #take(report: JobReport): void {
    for (const event of report.events) {
      if ("axes" in event) this.#begin(event);
      else this.#filled?.take(event);
    }
    if (report.done > 0) {
      this.#progress.max = report.total;
      this.#progress.value = report.done;
      this.#elapsed.end();
      this.#readout.textContent = `${report.done} of ${counted(report.total, "run")}`;
    } else this.#elapsed.begin(`${report.note ? capital(report.note) : "Starting"}…`);
    if (report.events.length > 0) {
      this.#classes.report(this.#filled);
      this.#redraw();
    }
  }

  #begin({ axes, names }: PlaneBegun): void {
    this.#axes = axes;
    this.#filled = new Cells(axes.x.values.length, axes.y.values.length);
    this.#classes.take(names);
  }

  #end(last: JobReport | null, problems: readonly string[]): void {
    this.#job = null;
    this.#elapsed.end();
    this.#go.textContent = "Compute";
    this.#progress.hidden = true;
    this.#refuse(problems);
    this.#complete = last?.state === "done";
    if (this.#complete) this.#finish(last?.result as GridResult);
    else this.#readout.textContent = ""; // a job that has ended does nothing any more
    this.#redraw();
  }

  #finish({ runs, uncertain, codes, classes }: GridResult): void {
    this.#classes.takeFinal(classes);
    this.#filled?.takeAll(codes);
    const unsure = uncertain ? `, ${uncertain} of them numerically uncertain` : "";
    this.#readout.textContent = `${counted(runs, "run")}${this.#length}${unsure}. Click a cell to see its motion.`;
    this.#classes.report(this.#filled);
  }

  /** Before anything is computed: the axes alone. */
  #rest(plane: Plane, quantities: readonly Quantity[]): void {
    const computedAxis = (axis: Axis): PlaneAxis => ({
      name: axis.name,
      values: Array.from(
        { length: axis.number },
        (_, i) => axis.from + ((axis.to - axis.from) * i) / (axis.number - 1),
      ),
      units: quantities.find((one) => one.name === axis.name)?.unit ?? "",
    });
    this.#canvas.show(
      { axes: { x: computedAxis(plane.x), y: computedAxis(plane.y) }, cells: null, looks: new Map() },
      this.#values,
    );
    this.#readout.textContent = `${PLANES[this.#kind][2]}, then click a cell to see its motion.`;
  }

  #redraw(): void {
    if (this.#axes === null) return;
    this.#canvas.show({ axes: this.#axes, cells: this.#filled, looks: this.#classes.looks }, this.#shownValues());
    const { x, y } = this.#axes;
    this.#canvas.canvas.setAttribute(
      "aria-label",
      `${PLANES[this.#kind][1]} over ${words(x.name)} and ${words(y.name)}; arrow keys select a cell, Enter starts its motion`,
    );
  }

  #shownValues(): Place | null {
    const [x, y] = [this.#axes?.x.name, this.#axes?.y.name];
    return x === this.#plane?.x.name && y === this.#plane?.y.name ? this.#values : null;
  }

  #point(cell: Place | null): void {
    if (cell === null || this.#axes === null || this.#filled === null) return;
    if (this.#shownKey !== this.#key) {
      this.#readout.textContent = STALE; // its outcomes are not those of the case beside it
      return;
    }
    const { x, y } = this.#axes;
    const name = this.#classes.nameOf(this.#filled.at(...cell));
    const value = (axis: PlaneAxis, index: number): string =>
      `${words(axis.name)} ${withUnit(axis.values[index], axis.units ?? "")}`;
    this.#readout.textContent = `${value(x, cell[0])}, ${value(y, cell[1])}: ${name}`;
  }

  #choose([ix, iy]: Place): void {
    if (this.#shownKey !== this.#key) this.#readout.textContent = STALE;
    if (this.#axes === null || this.#filled === null || this.#shownKey !== this.#key) return;
    const { x, y } = this.#axes;
    const [valueX, valueY] = [x.values[ix], y.values[iy]];
    if (typeof valueX === "number" && typeof valueY === "number")
      this.#hearing.chosen([x.name, valueX], [y.name, valueY]);
  }

  #refuse(problems: readonly string[]): void {
    this.#refused = problems;
    this.#showProblems();
  }

  /** Shows what the server refused and why an axis is none; nothing is computed over an axis that is not shown. */
  #showProblems(): void {
    const wrong = this.#axesForm.problems;
    this.#go.disabled = wrong.length > 0 && this.#job === null; // a job can still be cancelled
    const lines = [...wrong, ...this.#refused];
    this.#problem.textContent = lines.join(" ");
    this.#problem.hidden = lines.length === 0;
  }
}

const STALE = "This picture shows an earlier case. Compute it again.";

function startInWords({ start }: Plane): string {
  return start === undefined ? ", all from the start of the case" : `, each from the ${start} branch of its own motion`;
}

function lengthInWords({ periods, duration }: Part): string {
  if (typeof periods === "number") return ` of ${formatted(periods)} periods of the base`;
  return typeof duration === "number" ? ` of ${withUnit(duration, "s")}` : "";
}
