/** A program of the package as WebAssembly: runs of one model under one kind of base motion. */

/** What the package says of a program. */
export interface Described {
  /** Names of the numbers of a run, in their order. */
  readonly names: readonly string[];
  /** Words from which a number chooses, by its name; the number is the index of the word. */
  readonly choices: Readonly<Record<string, readonly string[]>>;
  readonly layout: {
    readonly parameters_at: number;
    readonly motion_at: number;
    readonly notes_at: number;
  };
  /** Entries of a trace for which the row of a single run has room. */
  readonly traces: number;
  readonly trace_width: number;
  /** Numbers in the row of a run, and in the buffer of a kernel. */
  readonly row: number;
  readonly buffer: number;
  readonly planes: boolean;
  readonly switches: boolean;
  /** Numbers in a polynomial of a tabulated base motion; 0 for the others. */
  readonly piece: number;
}

/** What the package says of all programs. */
export interface Common {
  /** Columns of rows, entries of traces, samples and verdicts by name. */
  readonly columns: Readonly<
    Record<"setup" | "log" | "trace" | "sample" | "verdict" | "demand", Readonly<Record<string, number>>>
  >;
  /** Names of the initial conditions of a run. */
  readonly given: readonly string[];
  /** Numbers in the head of an entry, in a sample, and in a verdict. */
  readonly sizes: { readonly trace: number; readonly sample: number; readonly verdict: number };
  readonly codes: {
    /** Status of a run whose column rests for good, of one at its step limit, and of one that stood for too long. */
    readonly rested: number;
    readonly step_limit: number;
    readonly unseen: number;
    /** Status of a run that goes on in a plane. */
    readonly to_plane: number;
    /** The first kind of trace entry that is an event. */
    readonly first_event: number;
    /** Kinds of the entries of motion. */
    readonly step: number;
    readonly plane_step: number;
  };
}

export interface Finished {
  /** Row of the run after its end, without its trace. */
  readonly row: Float64Array;
  /** Entries of the trace that are motion, and those that are events, one after the other. */
  readonly stretches: Float64Array;
  readonly events: Float64Array;
  readonly planar: boolean;
  /** Numbers of `verdict`. */
  readonly verdict: Float64Array;
}

const PAGE = 1 << 16;
/** Constant tables lie at the beginning of the memory, the stack between them and the arrays [bytes]. */
const STACK = 1 << 18;
const LINE = 64;
const WIDTH = 8;

type Places = Readonly<Record<"numbers" | "row" | "buffer" | "pieces" | "halt" | "verdict" | "free", number>>;
type Function = (...values: (number | bigint)[]) => bigint;

/** No polynomials. */
const NONE = new Float64Array(0);
/** Columns of the array of polynomials that kernels without any expect. */
const COLUMNS_OF_NONE = 5;

export class Program {
  readonly described: Described;
  readonly #common: Common;
  readonly #functions: Readonly<Record<string, Function>>;
  readonly #memory: WebAssembly.Memory;
  /** Place of each array in the memory [bytes]. */
  readonly #at: Places;
  /** The polynomials of the base motion: place [bytes] and number; and the first free byte behind them. */
  #held: { readonly place: number; readonly rows: number; readonly free: number };

  private constructor(
    instance: WebAssembly.Instance,
    memory: WebAssembly.Memory,
    described: Described,
    common: Common,
  ) {
    this.described = described;
    this.#common = common;
    this.#functions = instance.exports as Record<string, Function>;
    this.#memory = memory;
    const sizes = {
      numbers: described.names.length,
      row: described.row,
      buffer: described.buffer,
      pieces: LINE,
      halt: 1,
      verdict: common.sizes.verdict,
    };
    let place = STACK;
    const at: Record<string, number> = {};
    for (const [name, size] of Object.entries(sizes)) {
      at[name] = place;
      place += LINE * Math.ceil((WIDTH * size) / LINE);
    }
    this.#at = { ...at, free: place } as Places;
    this.#held = { place: this.#at.pieces, rows: 1, free: place };
    this.#room(place);
  }

  /** Makes a program of its compiled module; `mathematics` are the functions that it imports. */
  static async of(
    module: WebAssembly.Module,
    mathematics: WebAssembly.Exports,
    described: Described,
    common: Common,
  ): Promise<Program> {
    const memory = new WebAssembly.Memory({ initial: 1 + STACK / PAGE });
    const pointer = new WebAssembly.Global({ value: "i32", mutable: true }, STACK);
    const env = { ...mathematics, __linear_memory: memory, __stack_pointer: pointer } as WebAssembly.ModuleImports;
    return new Program(await WebAssembly.instantiate(module, { env }), memory, described, common);
  }

  /** Computes a run from its numbers, and the polynomials of its base motion, to its end. */
  run(numbers: Float64Array, pieces: Float64Array = NONE): Finished {
    const { row: width, traces, trace_width: wide } = this.described;
    const at = this.#at;
    this.#hold(pieces);
    this.#array(at.numbers, numbers.length).set(numbers);
    const flags = Number(this.#of("begin", at.row, BigInt(width)));
    // The row of a run without looks has its trace where they would be.
    const used = flags & 2 ? width : width - this.#looks();
    let planar = (flags & 1) !== 0;
    const entries: Float64Array[] = [];
    const advance = (name: string): void => {
      this.#array(at.buffer, this.described.buffer).fill(NaN);
      for (let ended = false; !ended; ) {
        ended = this.#advance(name, at.row, 1, used);
        entries.push(this.#taken(used, traces * wide, wide));
      }
    };
    if (!planar) advance("advance");
    if (this.#log("status") === this.#common.codes.to_plane) {
      this.#of("to_plane", at.row, BigInt(used));
      planar = true;
    }
    if (planar) advance("advance_in_plane");
    this.#of("judge", at.row, BigInt(used), planar ? 1 : 0, at.verdict);
    const [stretches, events] = this.#parted(joined(entries), wide);
    return {
      row: this.#array(at.row, used - traces * wide).slice(),
      stretches: stretches.length > 0 ? stretches : this.#stillness(planar),
      events,
      planar,
      verdict: this.#array(at.verdict, this.#common.sizes.verdict).slice(),
    };
  }

  /**
   * Computes many runs together, without traces; returns the numbers of `verdict` of each.
   *
   * `pieces` are the polynomials of all their base motions, one after the other.
   */
  batch(runs: readonly Float64Array[], pieces: Float64Array = NONE): Float64Array[] {
    const { row, traces, trace_width: wide } = this.described;
    const at = this.#at;
    const width = row - traces * wide;
    const { free } = this.#hold(pieces);
    const tables = [free, free + LINE * Math.ceil((WIDTH * width * runs.length) / LINE)] as const;
    this.#room(tables[1] + WIDTH * width * runs.length);
    // first the runs in space, then those in a plane, each in its own table
    const members: [number[], number[]] = [[], []];
    const place = (table: 0 | 1, index: number): number => tables[table] + WIDTH * width * index;
    runs.forEach((numbers, k) => {
      this.#array(at.numbers, numbers.length).set(numbers);
      const flags = Number(this.#of("begin", at.row, BigInt(width)));
      const table = flags & 1 ? 1 : 0;
      this.#array(place(table, members[table].length), width).set(this.#array(at.row, width));
      members[table].push(k);
    });
    const advance = (name: string, table: 0 | 1): void => {
      if (members[table].length === 0) return;
      this.#array(at.buffer, this.described.buffer).fill(NaN);
      this.#advance(name, tables[table], members[table].length, width);
    };
    advance("advance", 0);
    const status = this.#column("log", "status");
    const left: number[] = [];
    members[0].forEach((k, index) => {
      if (this.#array(place(0, index), width)[status] !== this.#common.codes.to_plane) return;
      this.#array(at.numbers, runs[k]?.length ?? 0).set(runs[k] ?? []);
      this.#of("to_plane", place(0, index), BigInt(width));
      this.#array(place(1, members[1].length), width).set(this.#array(place(0, index), width));
      members[1].push(k);
      left.push(k);
    });
    advance("advance_in_plane", 1);
    const verdicts: Float64Array[] = [];
    for (const table of [0, 1] as const) {
      members[table].forEach((k, index) => {
        if (table === 0 && left.includes(k)) return;
        this.#array(at.numbers, runs[k]?.length ?? 0).set(runs[k] ?? []);
        this.#of("judge", place(table, index), BigInt(width), table, at.verdict);
        verdicts[k] = this.#array(at.verdict, this.#common.sizes.verdict).slice();
      });
    }
    return verdicts;
  }

  /** Returns samples of the last run at times that do not fall: rows with the columns `sample`. */
  samples(stretches: Float64Array, times: readonly number[]): Float64Array {
    const { row: width, trace_width: wide } = this.described;
    const at = this.#at;
    const [columns, many] = [this.#common.sizes.sample, times.length];
    const column = this.#column("sample", "time");
    const { free } = this.#held;
    const out = free + LINE * Math.ceil((WIDTH * stretches.length) / LINE);
    this.#room(out + WIDTH * columns * many);
    this.#array(free, stretches.length).set(stretches);
    const rows = this.#array(out, columns * many);
    times.forEach((time, k) => (rows[k * columns + column] = time));
    const entries = BigInt(stretches.length / wide);
    this.#of("sampled", free, entries, at.row, BigInt(width), out, BigInt(many));
    return this.#array(out, columns * many).slice();
  }

  /** Returns the numbers of `demand` of the last run; `friction` is the friction coefficient of the base. */
  demands(stretches: Float64Array, friction: number): Float64Array {
    const { row: width, trace_width: wide } = this.described;
    const { free } = this.#held;
    const many = Object.keys(this.#common.columns.demand).length;
    const out = free + LINE * Math.ceil((WIDTH * stretches.length) / LINE);
    this.#room(out + WIDTH * many);
    this.#array(free, stretches.length).set(stretches);
    const entries = BigInt(stretches.length / wide);
    this.#of("demands", free, entries, this.#at.row, BigInt(width), friction, out);
    return this.#array(out, many).slice();
  }

  #looks(): number {
    const { row, layout, traces, trace_width: wide } = this.described;
    return row - layout.notes_at - traces * wide;
  }

  /** Takes the entries of the trace from the row, and clears it. */
  #taken(used: number, size: number, wide: number): Float64Array {
    const row = this.#array(this.#at.row, used);
    const next = this.#column("log", "next_trace");
    const trace = row.subarray(used - size);
    const taken = trace.slice(0, (row[next] ?? 0) * wide);
    trace.fill(0);
    row[next] = 0;
    return taken;
  }

  /** Returns the entries that are motion, and those that are events. */
  #parted(entries: Float64Array, wide: number): readonly [Float64Array, Float64Array] {
    const kind = this.#column("trace", "kind");
    const parts: [number[], number[]] = [[], []];
    for (let first = 0; first < entries.length; first += wide) {
      const event = (entries[first + kind] ?? 0) >= this.#common.codes.first_event;
      parts[event ? 1 : 0].push(...entries.subarray(first, first + wide));
    }
    return [Float64Array.from(parts[0]), Float64Array.from(parts[1])];
  }

  /** Returns the only entry of a run that ended at its start. */
  #stillness(planar: boolean): Float64Array {
    const entry = new Float64Array(this.described.trace_width);
    const row = this.#array(this.#at.row, this.described.row);
    const state = this.#column("log", "state");
    entry[this.#column("trace", "kind")] = planar ? this.#common.codes.plane_step : this.#common.codes.step;
    entry[this.#column("trace", "length")] = 1;
    const first = this.#common.sizes.trace;
    const states = (entry.length - first) / 8;
    entry.set(row.subarray(state, state + states), first);
    return entry;
  }

  #log(name: string): number {
    return this.#array(this.#at.row, this.described.row)[this.#column("log", name)] ?? NaN;
  }

  #column(group: keyof Common["columns"], name: string): number {
    const found = this.#common.columns[group][name];
    if (found === undefined) throw new Error(`there is no column ${name} in ${group}`);
    return found;
  }

  /** Puts the polynomials of base motions into the memory. */
  #hold(pieces: Float64Array): { readonly free: number } {
    const { piece } = this.described;
    if (piece === 0) return this.#held;
    const [place, size] = [this.#at.free, LINE * Math.ceil((WIDTH * pieces.length) / LINE)];
    this.#held = { place, rows: pieces.length / piece, free: place + size };
    this.#room(this.#held.free);
    this.#array(place, pieces.length).set(pieces);
    return this.#held;
  }

  /** Calls a function with the numbers of the run and its polynomials. */
  #of(name: string, ...values: (number | bigint)[]): bigint {
    return this.#call(name, this.#at.numbers, this.#held.place, BigInt(this.#held.rows), ...values);
  }

  /** Computes runs with their rows of this width; returns whether all have ended. */
  #advance(name: string, table: number, runs: number, width: number): boolean {
    const { place, rows } = this.#held;
    const columns = BigInt(this.described.piece || COLUMNS_OF_NONE);
    const { halt, buffer } = this.#at;
    const sizes = [BigInt(runs), BigInt(width)] as const;
    return this.#call(name, table, ...sizes, place, BigInt(rows), columns, halt, buffer) !== 0n;
  }

  #call(name: string, ...values: (number | bigint)[]): bigint {
    const found = this.#functions[name];
    if (!found) throw new Error(`the program has no function ${name}`);
    return found(...values);
  }

  #array(place: number, length: number): Float64Array {
    return new Float64Array(this.#memory.buffer, place, length);
  }

  /** Makes the memory hold so many bytes. */
  #room(bytes: number): void {
    const missing = bytes - this.#memory.buffer.byteLength;
    if (missing > 0) this.#memory.grow(Math.ceil(missing / PAGE));
  }
}

/** Returns arrays one after the other. */
export function joined(parts: readonly Float64Array[]): Float64Array {
  const whole = new Float64Array(parts.reduce((sum, part) => sum + part.length, 0));
  let place = 0;
  for (const part of parts) {
    whole.set(part, place);
    place += part.length;
  }
  return whole;
}

/** Returns so many times at equal steps from 0 to `end`. */
export function evenly(end: number, many: number): readonly number[] {
  return Array.from({ length: many }, (_, k) => (k === many - 1 ? end : (k * end) / (many - 1)));
}
