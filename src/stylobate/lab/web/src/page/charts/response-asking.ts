/** The frequency response of the case that is shown: curves at once, exact orbits on request. */

import { type Part, isPart, without, written } from "../case/description";
import { angularFrequency, withAngularFrequency } from "../case/frequency";
import type { ColumnScales } from "../case/quantities";
import { mayTurn, offBranch } from "../case/starting";
import type { Job as JobReport, ResponseCurves } from "../server/schema";
import type { Job } from "../server/job";
import { Latest } from "../server/latest";
import { exactRequest, isSlender, responseRequest, usualRange } from "../server/requests";
import { type JobRequest, type Source, Unreachable } from "../server/source";
import type { View } from "../view/state";
import { ResponsePanel } from "./response-panel";
import type { ExactOrbit } from "./response-plot";

/** Response curves with the slenderness of the very column that they are of: they are drawn in units of it. */
export interface ScaledCurves {
  readonly curves: ResponseCurves;
  readonly slenderness: number;
}

export class ScaledResponse {
  readonly #source: Pick<Source, "response" | "describe">;
  /** The column that was described last: most requests are of the same one. */
  #known = { column: "", slenderness: 0 };

  constructor(source: Pick<Source, "response" | "describe">) {
    this.#source = source;
  }

  async ask(body: Part, signal: AbortSignal): Promise<ScaledCurves> {
    const [curves, slenderness] = await Promise.all([
      this.#source.response(body, signal),
      this.#slenderness(body["column"]),
    ]);
    return { curves, slenderness };
  }

  /** The run of the case may be answered later than its curves, or not at all: the column is asked for by itself. */
  async #slenderness(given: Part[string] | undefined): Promise<number> {
    const column = isPart(given) ? given : {};
    const wanted = written(column);
    if (wanted === this.#known.column) return this.#known.slenderness;
    const answer = await this.#source.describe({ column, duration: 1 });
    if (answer.column === undefined) throw new Error("the server did not describe the column");
    this.#known = { column: wanted, slenderness: answer.column.slenderness };
    return answer.column.slenderness;
  }
}

/** Why a run is not started on an orbit of a column that may turn. */
const SPINS = "These orbits spin about the axis at a rate that is unknown here. Start on the upper branch instead.";

export type JobStart = (
  kind: string,
  request: JobRequest,
  report: (report: JobReport) => void,
  ended: (last: JobReport | null, problems: readonly string[]) => void,
) => Job;

export interface AskingHearing {
  readonly edited: (changes: Partial<View>) => void;
  readonly start: JobStart;
  readonly lost: (error: Unreachable) => void;
  /** The critical frequency of the case is known [rad/s]; null: it has none. */
  readonly critical: (frequency: number | null) => void;
}

export class ResponseAsking {
  readonly panel: ResponsePanel;
  readonly #offers: Source["offers"];
  readonly #lost: (error: Unreachable) => void;
  readonly #critical: (frequency: number | null) => void;
  readonly #curves: Latest<Part, ScaledCurves>;
  #view: View;
  #scales: ColumnScales;
  #asked = { curves: "", exact: "" };

  constructor(source: Source, view: View, scales: ColumnScales, { edited, start, lost, critical }: AskingHearing) {
    this.#view = view;
    this.#scales = scales;
    this.#offers = source.offers;
    this.#lost = lost;
    this.#critical = critical;
    this.panel = new ResponsePanel({
      frequency: (value) => edited({ description: this.#at(value) }),
      orbit: (orbit) => {
        if (mayTurn(this.#view.description)) this.panel.report(SPINS);
        else edited({ description: this.#on(orbit), start: null });
      },
      range: (range) => edited({ range }),
      exact: (report, ended) =>
        start("exact", { description: exactRequest(this.#view.description, this.#range) ?? {} }, report, ended),
    });
    const scaled = new ScaledResponse(source);
    this.#curves = new Latest((body, signal) => scaled.ask(body, signal), {
      answered: (found) => this.#take(found),
      failed: (error) => this.#fail(error),
    });
  }

  /** Shows the response of a view; a `jump` does not wait for curves that are due. */
  show(view: View, scales: ColumnScales, jump: boolean): void {
    this.#view = view;
    this.#scales = scales;
    this.panel.showFrequency(angularFrequency(view.description.motion));
    this.panel.showRange(this.#range);
    this.panel.setOwn(isSlender(view.description));
    this.#checkExact();
    this.#ask(jump);
  }

  /** Forgets what was asked: it is to be asked again. */
  forget(): void {
    this.#asked.curves = "";
  }

  get #range(): readonly [number, number] {
    const { range, description } = this.#view;
    return range ?? usualRange(this.#scales.frequency_scale, angularFrequency(description.motion));
  }

  #at(frequency: number): View["description"] {
    const { description } = this.#view;
    return { ...description, motion: withAngularFrequency(description.motion, frequency) };
  }

  /** Returns the case on an exact orbit, whose base motion begins at phase zero. */
  #on({ frequency, tilt, tilt_rate }: ExactOrbit): View["description"] {
    const description = this.#at(frequency);
    const motion = without(description.motion, "start_phase", "ramp");
    // Rounding the frequency to what a field shows would leave the orbit; few motions hold it in other units.
    const exactly = "angular_frequency" in motion ? { ...motion, angular_frequency: frequency } : motion;
    return { ...description, motion: exactly, ...offBranch({ tilt, tilt_rate }) };
  }

  /** Exact orbits of another case are taken away. */
  #checkExact(): void {
    const request = exactRequest(this.#view.description, this.#range);
    // Orbits that were found stay while the range is changed: they are those of the case all the same.
    const wanted = request === null ? "none" : written(without(request, "angular_frequency_range"));
    if (wanted !== this.#asked.exact) this.panel.forgetExact();
    this.#asked.exact = wanted;
    this.panel.allowExact(request !== null && this.#offers("exact", { description: request }));
  }

  #ask(jump: boolean): void {
    const body = responseRequest(this.#view.description, this.#range);
    const wanted = body === null ? `none ${this.#range.join()}` : written(body);
    if (wanted === this.#asked.curves) return;
    this.#asked.curves = wanted;
    if (body !== null) return this.#curves.want(body, { jump });
    this.#curves.cancel();
    this.#critical(null);
    this.panel.clear();
  }

  #take({ curves, slenderness }: ScaledCurves): void {
    this.panel.show(curves, slenderness, this.#range);
    this.#critical(curves.critical[0]?.angular_frequency ?? null);
  }

  #fail(error: unknown): void {
    if (error instanceof Unreachable) return this.#lost(error);
    this.panel.report(error instanceof Error ? error.message : String(error)); // the last good curves stay
  }
}
