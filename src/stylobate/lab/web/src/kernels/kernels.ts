/** The programs of a page: loaded when a case first needs them. */

import type { Part, Value } from "../page/case/description";
import { Refused } from "../page/server/source";
import { checked, numberOf, refuseOthers } from "./case";
import { imported } from "./instances";
import { OwnRecords, type Samples } from "./own-records";
import { type Common, type Described as OfProgram, Program } from "./program";
import { STACK, Tables } from "./tables";
import type { Setup, StartWorker } from "./worker-pool";
import { CONTRADICTION, Unknown } from "./refusals";

export type Numbers = Readonly<Record<string, number>>;

/** A function of the program of cases: a constructor with some of its optional numbers. */
interface Variant {
  readonly name: string;
  readonly of: string;
  readonly given: readonly string[];
  readonly arguments: readonly Declared[];
}

/** The declaration of a number. */
export interface Declared {
  readonly name: string;
  readonly components: number;
  readonly default: Value;
  readonly choices: readonly Value[];
  readonly ge: number | null;
  readonly gt: number | null;
  readonly le: number | null;
  readonly lt: number | null;
  readonly unit: string;
  /** The range in words, behind “must”. */
  readonly demand: string;
}

interface Texts {
  readonly grounds: readonly string[];
  readonly statuses: readonly string[];
  readonly final_events: readonly string[];
  readonly trace_events: readonly string[];
  readonly upright: Readonly<Record<string, string>>;
  readonly stands: readonly [string, string];
  readonly stands_at_end: string;
  readonly unproved: string;
  readonly stopped: string;
  readonly step_limit: string;
  readonly unseen: string;
  readonly racing: string;
  readonly before_end: string;
  readonly standing_before_end: string;
  readonly after_end: string;
  readonly moving: string;
  readonly open: string;
  readonly safe: string;
  readonly no_duration: string;
  readonly lifts_off: string;
  readonly slips: string;
  readonly at_most: string;
  readonly without_bound: string;
  readonly before_rocking: string;
  readonly from_time: string;
  readonly for_a_moment: string;
}

interface DescribedProgram extends OfProgram {
  readonly numbers: readonly Declared[];
  readonly planar_only: boolean;
  /** Whether the model proves from which tilt a column cannot come back. */
  readonly proves: boolean;
  readonly carries: boolean;
  readonly spins: boolean;
  readonly loses: boolean;
  readonly contact: boolean;
}

/** What the package says of its programs. */
export interface Described {
  readonly common: Common;
  readonly case: readonly Variant[];
  /** Constructors of base motions that can be tabulated. */
  readonly tables: {
    readonly variants: readonly Variant[];
    /** Names of the numbers of a table. */
    readonly numbers: readonly string[];
    /** Numbers in a polynomial, by kind of shaking. */
    readonly pieces: Numbers;
  };
  /** The records of the package, and the step between their samples [s]. */
  readonly records: readonly { readonly sample: string; readonly name: string; readonly step: number }[];
  /** Columns of the response curves for one sense of rolling. */
  readonly curve: Numbers;
  /** Names of what the program of cases knows of a column. */
  readonly derived: readonly string[];
  readonly programs: Readonly<Record<string, DescribedProgram>>;
  /** Meanings and units of the numbers that can be axes of a map. */
  readonly axes: Readonly<Record<string, { readonly long_name: string; readonly units: string }>>;
  readonly outcomes: readonly { readonly name: string; readonly label: string }[];
  readonly fallen: readonly number[];
  /** Kinds of events that occur in every swing, and are not listed. */
  readonly repeating: readonly string[];
  /** Rows of the contact demand: label, measure and unit. */
  readonly demand_rows: readonly (readonly [label: string, measure: string, unit: string])[];
  readonly no_bound: string;
  /** Refusals of initial conditions, with gaps. */
  readonly refusals: Readonly<Record<"no_spin" | "spin_upright" | "out_of_plane", string>>;
  readonly texts: Texts;
  readonly rules: { readonly n: number; readonly short: number; readonly steady: number; readonly most: number };
  /** Length of the free vibration after a base motion that ends, over 1/p. */
  readonly free_tail: number;
  readonly most_periods: number;
  readonly most_steps: number;
  /** Numbers of samples of a run. */
  readonly samples: { readonly per_period: number; readonly fewest: number; readonly most: number };
  readonly rtol: number;
  readonly finer: { readonly rest_share: number; readonly passage_share: number; readonly rtol: number };
}

/** Returns the bytes of a module, or of the samples of a record, by the name of its file. */
export type Load = (name: string) => Promise<ArrayBuffer>;

const PAGE = 1 << 16;
const OF_A_MOTION = 9;
/** Results of a function at most. */
const MOST_RESULTS = 64;

export class Kernels {
  readonly described: Described;
  /** Records that the user has read into the page. */
  readonly own: OwnRecords;
  readonly #load: Load;
  readonly #programs = new Map<string, Promise<Program>>();
  readonly #modules = new Map<string, Promise<WebAssembly.Module>>();
  #mathematics: Promise<WebAssembly.Exports> | null = null;
  #case: Promise<WebAssembly.Instance> | null = null;
  #tables: Promise<Tables> | null = null;
  readonly #samples = new Map<string, Promise<Float64Array>>();
  readonly #memory = new WebAssembly.Memory({ initial: 2 });

  /** Takes how programs and records are loaded, and how workers are started. */
  constructor(described: Described, load: Load, startWorker: StartWorker) {
    this.described = described;
    this.own = new OwnRecords(startWorker);
    this.#load = load;
  }

  /** Returns the program of this name. */
  program(name: string): Promise<Program> {
    let found = this.#programs.get(name);
    if (!found) {
      found = this.#made(name);
      this.#programs.set(name, found);
    }
    return found;
  }

  /** Returns the numbers of a described column or motion, by name. */
  async made(group: "column" | "motion", given: Part, choosing: "shape" | "kind"): Promise<Numbers> {
    const [name, values] = this.arguments(this.described.case, `${group}_${String(given[choosing])}`, given, choosing);
    const found = await this.called(name, values);
    const names =
      group === "column" ? this.described.derived : Array.from({ length: OF_A_MOTION }, (_, k) => String(k));
    const made: Numbers = Object.fromEntries(names.map((one, k) => [one, found[k] ?? NaN]));
    if (made["consistent"] === 0) throw new Refused(422, [CONTRADICTION]);
    return made;
  }

  /** Returns the name of the function for a constructor with the numbers that are given, and its arguments. */
  arguments(
    known: readonly Variant[],
    of: string,
    given: Part,
    choosing: "shape" | "kind",
  ): readonly [name: string, values: readonly number[]] {
    const numbers = Object.keys(given).filter((name) => given[name] !== null && given[name] !== undefined);
    const variants = known.filter((one) => one.of === of);
    const variant = variants.find((one) => one.given.every((name) => numbers.includes(name)) && fits(one, numbers));
    const names = variants.flatMap((one) => one.arguments.map(({ name }) => name));
    const listed = variants.length > 0 && numbers.every((name) => name === choosing || names.includes(name));
    if (!variant && listed) throw new Refused(422, [CONTRADICTION]);
    if (!variant) throw new Unknown(`${of} is not computed here`);
    refuseOthers(given, [choosing, ...variant.arguments.map((one) => one.name)]);
    const values = variant.arguments.flatMap((one) => {
      const { name, components, default: usual } = one;
      const value = given[name] ?? usual;
      if (components === 1) return [checked(numberOf(value, NaN, name), one)];
      if (!Array.isArray(value) || value.length !== components) throw new Unknown(`${name} is not a vector here`);
      return (value as readonly Value[]).map((part) => checked(numberOf(part, NaN, name), one));
    });
    return [variant.name, values];
  }

  /** Returns the program for the tables of base motions. */
  tables(): Promise<Tables> {
    this.#tables ??= this.#ofTables();
    return this.#tables;
  }

  /** Returns the samples of a record of the package. */
  async sample(name: string): Promise<Samples> {
    const listed = this.described.records.find((one) => one.sample === name);
    if (!listed) throw new Unknown(`the record ${name} is not here`);
    const found = this.#samples.get(name) ?? this.#load(listed.name).then((bytes) => new Float64Array(bytes));
    this.#samples.set(name, found);
    return { values: await found, step: listed.step };
  }

  /** Returns the results of a function of the program of cases. */
  async called(name: string, values: readonly (number | undefined)[]): Promise<readonly number[]> {
    const instance = await this.#ofCase();
    const at = PAGE; // behind the constant tables and the stack
    const out = at + 8 * Math.max(values.length, 1);
    new Float64Array(this.#memory.buffer, at, values.length).set(values.map((value) => value ?? NaN));
    const call = instance.exports[name] as (numbers: number, out: number) => bigint;
    try {
      call(at, out);
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError) throw new Refused(422, [CONTRADICTION]); // its check failed
      throw error;
    }
    return Array.from(new Float64Array(this.#memory.buffer, out, MOST_RESULTS));
  }

  async #made(name: string): Promise<Program> {
    const described = this.described.programs[name];
    if (!described) throw new Unknown(`there is no program ${name}`);
    const module = await this.#module(name);
    return Program.of(module, await this.#ofMathematics(), described, this.described.common);
  }

  /** Returns what a worker needs to make the program of this name. */
  async setup(name: string): Promise<Setup> {
    const { described } = await this.program(name);
    const [mathematics, program] = await Promise.all([this.#module("mathematics"), this.#module(name)]);
    return { mathematics, program, described, common: this.described.common };
  }

  #module(name: string): Promise<WebAssembly.Module> {
    let found = this.#modules.get(name);
    if (!found) {
      found = this.#load(`${name}.wasm`).then((bytes) => WebAssembly.compile(bytes));
      this.#modules.set(name, found);
    }
    return found;
  }

  async #ofTables(): Promise<Tables> {
    const memory = new WebAssembly.Memory({ initial: (2 * STACK) / PAGE });
    const env = { ...(await this.#ofMathematics()), ...imported(memory, STACK) };
    const { exports } = await WebAssembly.instantiate(await this.#module("tables"), { env });
    return new Tables(exports, memory, this.described.tables.numbers);
  }

  #ofMathematics(): Promise<WebAssembly.Exports> {
    const env = imported(new WebAssembly.Memory({ initial: 2 }));
    this.#mathematics ??= this.#module("mathematics")
      .then((module) => WebAssembly.instantiate(module, { env }))
      .then((instance) => instance.exports);
    return this.#mathematics;
  }

  #ofCase(): Promise<WebAssembly.Instance> {
    this.#case ??= Promise.all([this.#load("case.wasm"), this.#ofMathematics()])
      .then(([bytes, mathematics]) =>
        WebAssembly.instantiate(bytes, { env: { ...mathematics, ...imported(this.#memory) } }),
      )
      .then((found) => found.instance);
    return this.#case;
  }
}

/** Returns whether a variant takes exactly the optional numbers that are given, of those that its constructor has. */
function fits(variant: Variant, numbers: readonly string[]): boolean {
  const own = variant.arguments.map((one) => one.name);
  return numbers.every((name) => own.includes(name) || name === "shape" || name === "kind");
}
