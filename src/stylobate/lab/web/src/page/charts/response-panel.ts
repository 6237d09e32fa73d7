/** The frequency response: curves of theory, exact orbits on request, and the frequency that is shown. */

import { button, element, newId, onResize } from "../frame/dom";
import { Elapsed } from "../frame/elapsed";
import { enlarging } from "../frame/enlarging";
import {
  axisLabel,
  capital,
  counted,
  formatted,
  frequencyText,
  plain,
  readNumber,
  unitWritten,
  words,
} from "../frame/format";
import { frequencyScaling, inShownUnits, isTaught, joined } from "../frame/units";
import type { ExactOrbits, Job as JobReport, ResponseCurves } from "../server/schema";
import type { Job } from "../server/job";
import { type Extent, FrequencyMarker } from "./frequency-marker";
import { AXIS_WIDTH } from "./plot-looks";
import { heightOf, linesOf } from "./response-lines";
import { type ExactOrbit, ResponsePlot } from "./response-plot";

/** Returns whose curves are shown, and how they were computed. */
function aboutCurves(curves: ResponseCurves, own: boolean): string {
  const how = curves.averaged ? "by averaging" : "in closed form";
  return own
    ? `Steady rolling, ${how}.`
    : `Steady rolling of a slender column that cannot spin, ${how}; exact orbits are those of this model.`;
}

/** Returns how many families of exact orbits there are, and where they bifurcate, which a glossary explains. */
function aboutExact(exact: ExactOrbits): string {
  const families = counted(exact.families.length, "family", "families");
  const { unit, factor } = frequencyScaling();
  const kinds = [...new Set(exact.bifurcations.map((one) => one.kind))];
  const found = kinds.map((kind) => {
    const places = exact.bifurcations.filter((one) => one.kind === kind).map((one) => one.angular_frequency);
    return `${words(kind)} at ${places
      .sort((a, b) => a - b)
      .map((one) => formatted(one * factor, 4))
      .join(", ")}`;
  });
  return `${families} of exact orbits; ${found.length > 0 ? joined(found.join("; "), unit) : "no bifurcation in the range"}. Click a dot to start on that orbit.`;
}

/** Returns the frequencies that are written differently: both senses of rolling may have the same one. */
function different(frequencies: readonly number[]): readonly number[] {
  return [...new Map(frequencies.map((one) => [formatted(one, 4), one])).values()];
}

export interface ResponseHearing {
  readonly frequency: (value: number) => void;
  readonly range: (range: readonly [number, number] | null) => void;
  /** Starts a run on an exact orbit. */
  readonly orbit: (orbit: ExactOrbit) => void;
  /** Starts the search for exact orbits. */
  readonly exact: (
    report: (report: JobReport) => void,
    ended: (last: JobReport | null, problems: readonly string[]) => void,
  ) => Job;
}

export class ResponsePanel {
  readonly root: HTMLElement;
  readonly #hearing: ResponseHearing;
  readonly #plots = element("div", { class: "response-plots empty" });
  readonly #amplitudeHost = element("div", { class: "plot amplitude", role: "img" });
  readonly #phaseHost = element("div", { class: "plot phase", role: "img" });
  readonly #note = element("p", { class: "note", "aria-live": "polite" });
  readonly #unit = element("span", { class: "unit" });
  readonly #legend = element("ul", { class: "legend" });
  readonly #ask: HTMLButtonElement;
  readonly #from: HTMLInputElement;
  readonly #to: HTMLInputElement;
  readonly #amplitude: ResponsePlot;
  readonly #phase: ResponsePlot;
  readonly #marker: FrequencyMarker;
  #curves: ResponseCurves | null = null;
  #exact: ExactOrbits | null = null;
  #job: Job | null = null;
  readonly #elapsed = new Elapsed((message) => this.report(message));
  #range: readonly [number, number] = [0.2, 4];
  #slenderness = 0.1;
  #frequency: number | null = null;
  /** Whether the curves are those of the model that is chosen. */
  #own = true;

  constructor(hearing: ResponseHearing) {
    this.#hearing = hearing;
    this.#ask = button("Exact orbits", { class: "small" }, () => this.#askExact());
    this.#ask.title = "Continue the exact periodic orbits of the model over the range";
    [this.#from, this.#to] = [this.#rangeField("from"), this.#rangeField("to")];
    const range = element("span", { class: "range-fields" }, "Ω", this.#from, "–", this.#to, this.#unit);
    const heading = element(
      "header",
      {},
      element("h2", {}, "Frequency response"),
      this.#ask,
      enlarging(() => this.root, "the response"),
    );
    const footer = element("footer", {}, this.#legend, range);
    this.#plots.append(this.#amplitudeHost, this.#phaseHost);
    this.root = element(
      "section",
      { class: "panel chart response", "aria-label": "Frequency response" },
      heading,
      this.#plots,
      footer,
      this.#note,
    );
    const frequencies = (): string =>
      isTaught() ? axisLabel("frequency", "Hz") : axisLabel("angular frequency", "rad/s");
    // A lesson has no phases: there the axis of the amplitudes stands alone.
    this.#amplitude = new ResponsePlot(
      "amplitude",
      this.#amplitudeHost,
      [() => (isTaught() ? frequencies() : ""), () => (isTaught() ? "tilt [°]" : "|θ|/c")],
      () => this.#marker.show(this.#frequency),
    );
    this.#phase = new ResponsePlot("phase", this.#phaseHost, [frequencies, "ψ [rad]"]);
    this.#plots.addEventListener("pointerdown", (event) => this.#chooseOrbit(event), { capture: true });
    this.#marker = new FrequencyMarker(this.#plots, () => this.#extent(), hearing.frequency);
    for (const [host, { plot }] of [
      [this.#amplitudeHost, this.#amplitude],
      [this.#phaseHost, this.#phase],
    ] as const) {
      onResize(host, (width, height) => {
        plot.setSize({ width, height });
        this.#marker.show(this.#frequency);
      });
    }
  }

  /** Shows curves over their range. */
  show(curves: ResponseCurves, slenderness: number, range: readonly [number, number]): void {
    this.#curves = curves;
    this.root.hidden = false;
    this.#slenderness = slenderness;
    this.showRange(range);
    this.report(this.#about);
    this.#draw();
  }

  /** Says whether the curves are those of the model that is chosen: curves stay when only the model changes. */
  setOwn(own: boolean): void {
    if (own === this.#own) return;
    this.#own = own;
    if (this.#curves === null) return;
    this.report(this.#about);
    this.#draw();
  }

  /** Takes the curves away, and the card: the motion of the case has no response. */
  clear(): void {
    this.#curves = null;
    this.root.hidden = true;
  }

  showRange(range: readonly [number, number]): void {
    this.#unit.textContent = unitWritten("rad/s");
    this.#range = range;
    if (document.activeElement !== this.#from) this.#from.value = plain(range[0]);
    if (document.activeElement !== this.#to) this.#to.value = plain(range[1]);
    this.#marker.show(this.#frequency);
  }

  showFrequency(frequency: number | null): void {
    this.#frequency = frequency;
    this.#marker.show(frequency);
    this.#amplitude.showMarker(frequency);
  }

  report(text: string): void {
    this.#note.textContent = text;
  }

  /** Forgets exact orbits: they were those of another case. */
  forgetExact(): void {
    this.#job?.cancel();
    this.#job = null;
    this.#elapsed.end();
    this.#ask.textContent = "Exact orbits";
    this.root.classList.remove("exact");
    if (this.#exact === null) return;
    this.#exact = null;
    this.report(this.#about);
    this.#draw();
  }

  allowExact(allowed: boolean): void {
    this.#ask.hidden = !allowed;
  }

  redraw(): void {
    this.#amplitude.plot.redraw(false);
    this.#phase.plot.redraw(false);
  }

  get exact(): ExactOrbits | null {
    return this.#exact;
  }

  /** Returns what is to be known of the orbits while they are shown, else of the curves. */
  get #about(): string {
    if (this.#exact !== null) return aboutExact(this.#exact);
    return this.#curves === null ? "" : aboutCurves(this.#curves, this.#own);
  }

  /** A press on the dot of an orbit is not one on the marker. */
  #chooseOrbit(event: PointerEvent): void {
    if (this.#exact === null || event.button !== 0) return;
    const plot = [this.#amplitude, this.#phase].find((one) => one.plot.root.contains(event.target as Node));
    const orbit = plot?.orbitAt(event.clientX, event.clientY) ?? null;
    if (orbit === null) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.#hearing.orbit(orbit);
  }

  #askExact(): void {
    if (this.#job !== null) {
      this.forgetExact();
      this.report(this.#about);
      return;
    }
    this.#ask.textContent = "Cancel";
    this.root.classList.add("exact");
    this.#elapsed.begin("Computing exact orbits…");
    this.#job = this.#hearing.exact(
      ({ note }) => {
        if (note) this.#elapsed.begin(`${capital(inShownUnits(note))}…`);
      },
      (last, problems) => this.#found(last, problems),
    );
  }

  #found(last: JobReport | null, problems: readonly string[]): void {
    this.#job = null;
    this.#elapsed.end();
    this.#ask.textContent = "Exact orbits";
    if (last?.state !== "done") {
      this.root.classList.remove("exact");
      this.report(problems.join(" "));
      return;
    }
    this.#exact = last.result as ExactOrbits;
    this.report(this.#about);
    this.#draw();
  }

  #draw(): void {
    const curves = this.#curves;
    this.#plots.classList.toggle("empty", curves === null); // without curves there is nothing to read off
    const lines = curves === null ? [] : linesOf(curves, this.#slenderness);
    const c = this.#slenderness;
    const tilts =
      this.#exact?.families.flatMap((one) => one.mean_tilt.map((tilt) => (tilt === null ? null : tilt / c))) ?? [];
    const picture = {
      frequency: curves?.angular_frequency ?? [...this.#range],
      lines,
      backbone: curves?.backbone.map((value) => (value === null ? null : value / c)) ?? [null, null],
      critical: different((curves?.critical ?? []).flatMap((one) => one.angular_frequency ?? [])),
      pale: !this.#own || (curves?.averaged === true && this.#exact !== null),
      exact: this.#exact,
      slenderness: c,
      range: this.#range,
      height: heightOf(lines, tilts),
    };
    this.#amplitude.show(picture);
    this.#phase.show(picture);
    this.#nameLines(
      new Set(lines.filter((one) => one.amplitude.some((value) => value !== null)).map((one) => one.sense)),
      picture.critical.some((one) => this.#range[0] < one && one < this.#range[1]),
    );
    const critical = picture.critical.map((one) => frequencyText(one)).join(", ") || "no frequency";
    const summary =
      lines.length === 0
        ? "no curves"
        : `${[...new Set(lines.map((one) => one.sense))].join(" and ")}; stable from ${critical} on`;
    this.#amplitudeHost.setAttribute("aria-label", `Amplitude of steady rolling over angular frequency: ${summary}`);
    this.#phaseHost.setAttribute("aria-label", "Phase of steady rolling over angular frequency");
  }

  #nameLines(senses: ReadonlySet<string>, critical: boolean): void {
    const how = this.#curves?.averaged === true ? "averaged, stable" : "stable";
    const items = [...senses].map((sense) => [
      "line",
      sense === "clockwise" ? "vermilion" : "blue",
      isTaught() ? how : `${how}, ${sense}`,
    ]);
    if (senses.size > 0) items.push(["thin", "muted", "unstable"]);
    if (senses.size > 0 && !isTaught()) items.push(["dotted", "muted", "backbone"]);
    if (critical) items.push(["upright", "muted", "critical frequency"]);
    if (this.#exact !== null)
      items.push(["dot", "green", "exact"], ["ring", "green", "exact, unstable"], ["diamond", "purple", "bifurcation"]);
    this.#legend.replaceChildren(
      ...items.map(([kind, colour, text]) =>
        element("li", {}, element("span", { class: `key ${kind} ${colour}` }), text ?? ""),
      ),
    );
  }

  #extent(): Extent {
    const { width } = this.#amplitudeHost.getBoundingClientRect();
    const room = this.#amplitude.plot.over.getBoundingClientRect();
    const left = room.left - this.#plots.getBoundingClientRect().left || AXIS_WIDTH;
    return { left, width: room.width || Math.max(width - AXIS_WIDTH, 1), range: this.#range };
  }

  #rangeField(which: "from" | "to"): HTMLInputElement {
    const field = element("input", {
      ...{ id: newId(which), class: "number tiny", type: "text", inputmode: "decimal", autocomplete: "off" },
      "aria-label": `Response ${which} angular frequency`,
    });
    field.addEventListener("change", () => this.#readRange());
    return field;
  }

  #readRange(): void {
    const [from, to] = [readNumber(this.#from.value), readNumber(this.#to.value)];
    const empty = this.#from.value.trim() === "" && this.#to.value.trim() === "";
    const right = 0 < from && from < to && Number.isFinite(to);
    for (const field of [this.#from, this.#to]) field.setAttribute("aria-invalid", String(!right && !empty));
    if (right || empty) {
      this.report(this.#about);
      this.#hearing.range(right ? [from, to] : null);
    } else this.report("The range must rise from above zero; leave both fields empty for the default range.");
  }
}
