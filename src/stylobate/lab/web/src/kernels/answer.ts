/** The answer to a question for one run, computed in the page. */

import type { Part } from "../page/case/description";
import type { DrawnMotion, Run, RunEvent, Series } from "../page/server/schema";
import { type Case, caseOf, numberOf } from "./case";
import { demandsOf } from "./demands";
import { filled, general } from "./general";
import { Refused } from "../page/server/source";
import type { Kernels, Numbers } from "./kernels";
import { asPython, asToml } from "./snippets";
import type { Finished, Program } from "./program";

/** A base motion has ended if less than this fraction of it is left. */
const NO_TIME = 1e-12;

/** A run that has been computed, with what is read from it. */
interface Computed {
  readonly kernels: Kernels;
  readonly asked: Case;
  readonly program: Program;
  readonly finished: Finished;
  readonly numbers: Float64Array;
  /** Polynomials of its base motion. */
  readonly pieces: Float64Array | undefined;
}

export async function simulated(kernels: Kernels, description: Part): Promise<Run> {
  const asked = await caseOf(kernels, description);
  const program = await kernels.program(asked.program);
  const computed = decided(kernels, asked, program, description);
  return answered(computed, description);
}

/** Runs a case for its duration, or else until its outcome is decided. */
function decided(kernels: Kernels, asked: Case, program: Program, description: Part): Computed {
  const { most_periods } = kernels.described;
  const given = description["duration"];
  const periodic = asked.shaking.lasts === Infinity ? (asked.shaking.period ?? 0) : 0;
  let duration = numberOf(given, usualDuration(kernels, asked), "duration");
  let found = computed(kernels, asked, program, duration);
  while ((given === undefined || given === null) && periodic > 0) {
    const needed = Math.min(verdict(found, "needed"), most_periods * periodic);
    if (!(duration < needed)) break;
    const longer = computed(kernels, asked, program, needed);
    if (outcomeOf(longer).name === "FAILED") break;
    [found, duration] = [longer, needed];
  }
  return found;
}

/** Returns the first duration of a run that states none: NaN without a usual one. */
export function usualDuration(kernels: Kernels, { shaking, column }: Case): number {
  const { rules, free_tail } = kernels.described;
  if (shaking.lasts === Infinity) return rules.steady * (shaking.period ?? NaN);
  return shaking.lasts > 0 ? shaking.lasts + free_tail / (column["frequency_parameter"] ?? NaN) : NaN;
}

function computed(kernels: Kernels, asked: Case, program: Program, duration: number, finer = false): Computed {
  const { rtol, most_steps, finer: shares } = kernels.described;
  if (Number.isNaN(duration)) throw new Refused(422, [kernels.described.texts.no_duration]);
  const { traces } = program.described;
  const accuracy = finer ? shares : { rtol, rest_share: 1, passage_share: 1 };
  const table = asked.shaking.table?.(duration);
  const own = { ...asked.numbers, ...table?.numbers };
  const numbers = numbersOf(program, { ...own, duration, ...accuracy, max_steps: most_steps, traces });
  const pieces = table?.pieces;
  return { kernels, asked, program, finished: program.run(numbers, pieces), numbers, pieces };
}

/** Returns the numbers of a run in the order of its program. */
export function numbersOf(program: Program, values: Numbers): Float64Array {
  return Float64Array.from(program.described.names, (name) => values[name] ?? NaN);
}

function answered(found: Computed, description: Part): Run {
  const { kernels, asked, program, finished } = found;
  const { column } = asked;
  const scale = log(found, "time_scale", "setup");
  const outcome = outcomeOf(found);
  const events = eventsOf(found, scale);
  const [changes, doubts] = repeated(found);
  const reason = reasonOf(found);
  const peak = log(found, "peak_tilt");
  const limit = numberOf(description["friction_coefficient"], Infinity, "friction_coefficient");
  const loads = program.demands(finished.stretches, limit);
  const demands = demandsOf(kernels, loads, limit, log(found, "capacity", "setup"));
  const measures = { ...measuresOf(found, scale, events), ...demands.measures };
  const samples = new Samples(kernels, program.samples(finished.stretches, sampleCount(found, description)));
  const decidedAt = log(found, "decided") * scale;
  return {
    toml: asToml(kernels.own.shown(description)),
    python: asPython(kernels.own.shown(description)),
    column: columnNumbers(column),
    outcome: outcome.name as Run["outcome"],
    label: outcome.label as Run["label"],
    reason,
    decided_at: decidedAt,
    uncertain: verdict(found, "uncertain") > 0 || changes,
    planar: log(found, "three_dimensional") === 0,
    warnings: [...demands.warnings, ...doubts],
    events,
    measures,
    summary: [
      ...summaryOf(
        column,
        measures,
        events.filter(({ kind }) => !kernels.described.repeating.includes(kind)),
        peak,
      ),
      ...demands.rows,
    ],
    thresholds: {},
    drawn: drawnOf(found, samples, description, {
      outcome: outcome.name as Run["outcome"],
      decided_at: decidedAt,
      title: `${outcome.label}: ${reason.split(";")[0]}`,
    }),
    series: seriesOf(found, samples),
  };
}

export function columnNumbers(column: Numbers): Run["column"] {
  const { consistent, ...numbers } = column;
  const uplift = (column["slenderness"] ?? NaN) * (column["gravity"] ?? NaN);
  return { ...numbers, uplift_acceleration: uplift } as unknown as Run["column"];
}

function outcomeOf(found: Computed): { readonly name: string; readonly label: string } {
  return found.kernels.described.outcomes[verdict(found, "outcome")] ?? { name: "FAILED", label: "failed" };
}

function verdict(found: Computed, name: string): number {
  const column = found.kernels.described.common.columns.verdict[name];
  return column === undefined ? NaN : (found.finished.verdict[column] ?? NaN);
}

function log(found: Computed, name: string, group: "log" | "setup" = "log"): number {
  const column = found.kernels.described.common.columns[group][name];
  return column === undefined ? NaN : (found.finished.row[column] ?? NaN);
}

/** Returns whether a run in doubt falls or not with finer thresholds, and a line about it. */
function repeated(found: Computed): readonly [boolean, readonly string[]] {
  const { kernels, asked, program, finished } = found;
  if (!(verdict(found, "in_doubt") > 0)) return [false, []];
  const duration = found.numbers[program.described.names.indexOf("duration")] ?? NaN;
  const again = computed(kernels, asked, program, duration, true);
  const energy = log(again, "rest_energy", "setup");
  program.run(found.numbers, found.pieces); // the samples are taken from the memory of the program
  const { fallen, finer } = kernels.described;
  const [before, after] = [verdict(found, "outcome"), verdict(again, "outcome")];
  if (outcomeOf(again).name === "FAILED" || fallen.includes(before) === fallen.includes(after)) return [false, []];
  const passage = again.finished.row[kernels.described.common.columns.setup["passage_tilt"] ?? 0] ?? 0;
  const given = passage > 0 && !finished.planar ? `passage_tilt ${general(passage, 2)}, ` : "";
  const settings = `with ${given}rest_energy ${general(energy, 2)} and rtol ${general(finer.rtol, 2)}`;
  const line = `the outcome depends on the settings of the integration: ${settings} it is ${outcomeOf(again).name}`;
  return [true, [line]];
}

// Reasons

function reasonOf(found: Computed): string {
  const { texts, outcomes, rules, programs, most_steps, common } = found.kernels.described;
  const { codes } = common;
  const status = log(found, "status");
  const outcome = outcomes[verdict(found, "outcome")]?.name ?? "";
  const own = texts.statuses[status] ?? "";
  const described = programs[found.asked.program];
  if (outcome === "FAILED") {
    const limit = status === codes.unseen ? texts.unseen : texts.step_limit;
    return texts.stopped + (own === "" ? filled(limit, { most: most_steps }) : own);
  }
  const weight = 1 + log(found, "minimum_vertical", "setup");
  if (outcome === "OVERTURNED" && (!described?.proves || weight <= 0)) return texts.unproved;
  if (outcome === "AT_REST") {
    if (status === codes.rested) return texts.stands[0];
    const releases = log(found, "releases");
    const times = releases === 1 ? "1 time" : `${releases} times`;
    const left = verdict(found, "base_left");
    const stops = left > 0 && left < Infinity ? filled(texts.standing_before_end, { left }) : "";
    return `${texts.stands_at_end}${releases > 0 ? `, uplifted ${times} before` : ""}${stops}`;
  }
  if (own !== "") return own;
  if (found.asked.shaking.lasts < Infinity) return survivalOf(found);
  const after = verdict(found, "repeats_after") || verdict(found, "nearest");
  return filled(texts.grounds[verdict(found, "ground")] ?? "", {
    ...rules,
    after: after === 1 ? "each period" : `${after} periods`,
    needed: verdict(found, "needed"),
  });
}

/** Returns the reason of a column that moves at the end of a run, after its base motion or without any. */
function survivalOf(found: Computed): string {
  const { texts } = found.kernels.described;
  const [left, share] = [verdict(found, "base_left"), verdict(found, "energy_share")];
  const lasts = found.asked.shaking.lasts;
  if (left > NO_TIME * lasts) return filled(texts.before_end, { left });
  const moving = lasts > 0 ? filled(texts.after_end, { after: Math.max(0, -left) }) : texts.moving;
  return moving + (share < 1 ? filled(texts.safe, { share: 100 * share }) : texts.open);
}

function eventsOf(found: Computed, scale: number): readonly RunEvent[] {
  const { texts, common } = found.kernels.described;
  const wide = found.program.described.trace_width;
  const [kind = 0, start = 1] = [common.columns.trace["kind"], common.columns.trace["start"]];
  const events: RunEvent[] = [];
  for (let first = 0; first < found.finished.events.length; first += wide) {
    const name = texts.trace_events[found.finished.events[first + kind] ?? -1] ?? "";
    if (name !== "") events.push({ kind: name, time: (found.finished.events[first + start] ?? NaN) * scale });
  }
  const last = texts.final_events[log(found, "status")] ?? "";
  if (last !== "") events.push({ kind: last, time: log(found, "time") * scale });
  return events;
}

// Measures

function measuresOf(found: Computed, scale: number, events: readonly RunEvent[]): Run["measures"] {
  const slenderness = found.asked.column["slenderness"] ?? NaN;
  const peak = log(found, "peak_tilt");
  const [x, y] = [verdict(found, "tilt_x"), verdict(found, "tilt_y")];
  const first = Math.hypot(found.asked.numbers["tilt_x"] ?? 0, found.asked.numbers["tilt_y"] ?? 0);
  const least = Math.min(first, log(found, "minimum_tilt"), Math.hypot(x, y));
  const known: Record<string, number | null> = {
    peak_tilt: peak,
    peak_tilt_over_c: peak / slenderness,
    time_of_peak_tilt: log(found, "peak_at") * scale,
    minimum_tilt: log(found, "reached_vertical") > 0 ? 0 : least,
    least_passage: finite(log(found, "closest_passage")),
    turns: verdict(found, "turns"),
    steps: log(found, "steps"),
    impacts: events.filter((event) => event.kind === "impact").length,
  };
  const span = verdict(found, "span");
  if (!Number.isNaN(span)) {
    known["mean_rolling_rate"] = (2 * Math.PI * verdict(found, "turned")) / (span * scale);
    known["repetition"] = finite(verdict(found, "returns"));
    known["repeats_after"] = verdict(found, "repeats_after");
    known["mean_tilt_late"] = verdict(found, "mean_tilt");
    known["minimum_tilt_late"] = verdict(found, "minimum_tilt");
  }
  return known as unknown as Run["measures"];
}

function finite(value: number): number | null {
  return Number.isFinite(value) ? value : null;
}

/** Number of listed events at most. */
const LISTED = 4;

function summaryOf(
  column: Numbers,
  measures: Run["measures"],
  events: readonly RunEvent[],
  peak: number,
): [string, string][] {
  const of = (name: string): number => column[name] ?? NaN;
  const scale = `ω0 = ${general(of("frequency_scale"), 5)} rad/s`;
  const least = of("slenderness") * of("gravity");
  const rows: [string, string][] = [
    ["column", `c = ${general(of("slenderness"), 5)}, ${scale}, mass ${general(of("mass"), 6)} kg`],
    ["uplifts above", `${general(least, 5)} m/s² of horizontal acceleration`],
    ["peak tilt", `${general(peak, 6)} rad, ${general(measures.peak_tilt_over_c ?? NaN, 4)} c`],
  ];
  if (peak > 0) {
    rows.push(["time of the peak tilt", `${(measures.time_of_peak_tilt ?? NaN).toFixed(4)} s`]);
    rows.push(["turns of the contact point", (measures.turns ?? NaN).toFixed(3)]);
  }
  const rate = (measures as Readonly<Record<string, number | null | undefined>>)["mean_rolling_rate"];
  if (typeof rate === "number") rows.push(["mean rolling rate", `${general(rate, 6)} rad/s`]);
  const listed = events.slice(0, LISTED).map((event) => `${event.kind} at ${event.time.toFixed(4)} s`);
  if (events.length > LISTED) listed.push(`and ${events.length - LISTED} more`);
  rows.push(["events", listed.join(", ") || "none"], ["steps", String(measures.steps)]);
  return rows;
}

// Samples

/** Samples of a run, read by the names of their columns. */
class Samples {
  readonly length: number;
  readonly #numbers: Float64Array;
  readonly #columns: Numbers;
  readonly #wide: number;

  constructor(kernels: Kernels, numbers: Float64Array) {
    this.#columns = kernels.described.common.columns.sample;
    this.#wide = kernels.described.common.sizes.sample;
    this.#numbers = numbers;
    this.length = numbers.length / this.#wide;
  }

  at(k: number, name: string): number {
    return this.#numbers[k * this.#wide + (this.#columns[name] ?? NaN)] ?? NaN;
  }

  each<Value>(read: (k: number) => Value): Value[] {
    return Array.from({ length: this.length }, (_, k) => read(k));
  }

  column(name: string): number[] {
    return this.each((k) => this.at(k, name));
  }

  known(name: string): (number | null)[] {
    return this.each((k) => finite(this.at(k, name)));
  }

  pairs(name: string): [number, number][] {
    return this.each((k) => [this.at(k, `${name}_x`), this.at(k, `${name}_y`)]);
  }

  triples(name: string): [number, number, number][] {
    return this.each((k) => [this.at(k, `${name}_x`), this.at(k, `${name}_y`), this.at(k, `${name}_z`)]);
  }
}

/** Returns the number of samples for a smooth plot of a run; the page cannot show more. */
function sampleCount(found: Computed, description: Part): number {
  const { per_period, fewest, most } = found.kernels.described.samples;
  const ends = found.asked.shaking.lasts < Infinity;
  const own = found.numbers[found.program.described.names.indexOf("duration")];
  const duration = ends ? own : description["duration"];
  if (typeof duration !== "number") return most;
  const frequency = Math.max(found.asked.shaking.frequency, found.asked.column["frequency_scale"] ?? NaN);
  const wanted = (per_period * duration * frequency) / (2 * Math.PI);
  return Math.trunc(Math.min(Math.max(wanted, fewest), most));
}

function seriesOf(found: Computed, samples: Samples): Series {
  const described = found.kernels.described.programs[found.asked.program];
  const tilts = samples.pairs("tilt");
  const rates = samples.pairs("tilt_rate");
  const size = tilts.map(([x, y]) => Math.hypot(x, y));
  const rolling = tilts.map(([x, y], k) => {
    const [vx, vy] = rates[k] ?? [NaN, NaN];
    return finite((x * vy - y * vx) / ((size[k] ?? NaN) * (size[k] ?? NaN)));
  });
  return {
    time: samples.column("time"),
    base_acceleration: samples.triples("acceleration"),
    amplitude: size,
    azimuth: samples.known("azimuth"),
    rolling_rate: rolling,
    ...(described?.spins ? { spin: samples.known("spin") } : {}),
    ...(described?.contact
      ? {
          friction_demand: samples.known("friction"),
          pivoting_demand: samples.known("pivoting"),
          normal_force: samples.known("normal"),
        }
      : {}),
    ...(described?.carries ? { displacement: displaced(samples.pairs("footprint")) } : {}),
  };
}

function displaced(places: readonly (readonly [number, number])[]): [number, number][] {
  const [x, y] = places[0] ?? [0, 0];
  return places.map(([a, b]) => [a - x, b - y]);
}

// The motion to draw

function drawnOf(
  found: Computed,
  samples: Samples,
  description: Part,
  said: Pick<DrawnMotion, "outcome" | "decided_at" | "title">,
): DrawnMotion {
  const { column } = found.asked;
  const radius = column["radius"] ?? NaN;
  const massHeight = column["mass_height"] ?? NaN;
  const body = description["column"] as Part;
  const described = found.kernels.described.programs[found.asked.program];
  const friction = description["friction_coefficient"];
  const tilt = samples.pairs("tilt");
  const footprint = samples.pairs("footprint");
  const twist = samples.column("twist");
  const directions = leaned(tilt);
  return {
    column: {
      radius,
      top_radius: numberOf(body["top_radius"], radius, "top_radius"),
      height: numberOf(body["height"], 2 * massHeight, "height"),
      mass_height: massHeight,
      slenderness: column["slenderness"] ?? NaN,
    },
    plane: { incline: 0, incline_direction: 0 },
    time: samples.column("time"),
    tilt,
    tilt_rate: samples.pairs("tilt_rate"),
    twist,
    spin: described?.spins ? samples.column("spin") : null,
    footprint,
    contact_point: footprint.map(([x, y], k) => {
      const [ux, uy] = directions[k] ?? [1, 0];
      return [x + radius * ux, y + radius * uy];
    }),
    resting: tilt.map(([x, y], k) => (samples.at(k, "resting") > 0 || (x === 0 && y === 0) ? 1 : 0)),
    clearance: null,
    base: samples.triples("base"),
    rotation: tilt.map((lean, k) => turned(lean, twist[k] ?? 0)),
    centre: tilt.map((lean, k) => centreOf(lean, footprint[k] ?? [0, 0], radius)),
    friction_demand: described?.contact ? samples.known("friction") : null,
    friction_coefficient: typeof friction === "number" ? friction : null,
    ...said,
  };
}

/** Returns unit vectors along the tilt; without tilt, that of the nearest instant before, or else after. */
function leaned(tilt: readonly (readonly [number, number])[]): [number, number][] {
  const first = tilt.find(([x, y]) => x !== 0 || y !== 0) ?? [1, 0];
  let last: [number, number] = [first[0] / Math.hypot(...first), first[1] / Math.hypot(...first)];
  return tilt.map(([x, y]) => {
    const size = Math.hypot(x, y);
    if (size > 0) last = [x / size, y / size];
    return last;
  });
}

/** Returns the rotation Rz(β) Ry(θ) Rz(χ − β) of a leaning column as a unit quaternion w, x, y, z. */
function turned([x, y]: readonly [number, number], twist: number): [number, number, number, number] {
  const angle = Math.hypot(x, y);
  const share = angle > 0 ? Math.sin(angle / 2) / angle : 0.5;
  const [sine, cosine] = [Math.sin(twist / 2), Math.cos(twist / 2)];
  const half = Math.cos(angle / 2);
  return [half * cosine, share * (x * sine - y * cosine), share * (x * cosine + y * sine), half * sine];
}

/** Returns the centre of the bottom circle of a column that stands on its rim, or upright. */
function centreOf(
  [x, y]: readonly [number, number],
  footprint: readonly [number, number],
  radius: number,
): [number, number, number] {
  const angle = Math.hypot(x, y);
  const [ux, uy] = angle > 0 ? [x / angle, y / angle] : [1, 0];
  const along = radius * (1 - Math.cos(angle));
  return [footprint[0] + along * ux, footprint[1] + along * uy, radius * Math.sin(angle)];
}
