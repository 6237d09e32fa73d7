/** Tables of base motions: the polynomials of records, pulses and sweeps, computed by a program of the package. */

import { Refused } from "../page/server/source";
import type { Samples } from "./own-records";
import { CONTRADICTION } from "./refusals";

/** A tabulated base motion: its polynomials, and the numbers of `Table` by name. */
export interface Tabulated {
  readonly pieces: Float64Array;
  readonly numbers: Readonly<Record<string, number>>;
}

const PAGE = 1 << 16;
/** Constant tables and the stack lie before the arrays [bytes]. */
export const STACK = 1 << 17;
const WIDTH = 8;
const AXES = 3;
/** Polynomials for which there is room at first, and at most. */
const [FIRST, MOST] = [256, 400_000];

export class Tables {
  readonly #functions: WebAssembly.Exports;
  readonly #memory: WebAssembly.Memory;
  readonly #names: readonly string[];

  constructor(functions: WebAssembly.Exports, memory: WebAssembly.Memory, names: readonly string[]) {
    this.#functions = functions;
    this.#memory = memory;
    this.#names = names;
  }

  /** Returns the table of a motion that is smooth between its breaks, up to a time [s]. */
  smooth(name: string, values: readonly number[], end: number, piece: number): Tabulated {
    const out = STACK;
    const numbers = out + WIDTH * this.#names.length;
    const rows = numbers + WIDTH * values.length;
    for (let room = FIRST; ; ) {
      this.#room(rows + WIDTH * piece * room);
      this.#array(numbers, values.length).set(values);
      const count = Number(this.#call(name, numbers, end, rows, BigInt(room), out));
      if (count < 0 || count > MOST) {
        throw new Refused(422, ["motion is too long or not smooth enough to tabulate; shorten the duration"]);
      }
      if (count <= room) return this.#taken(rows, piece * count, out);
      room = count;
    }
  }

  /** Returns the table of a record that begins at t = 0, scaled, and rotated about the vertical [rad]. */
  record({ values, step }: Samples, scale: number, rotation: number, piece: number): Tabulated {
    const out = STACK;
    const samples = out + WIDTH * this.#names.length;
    const rows = samples + WIDTH * values.length;
    const many = values.length / AXES;
    this.#room(rows + WIDTH * piece * (many + 1));
    this.#array(samples, values.length).set(values);
    const [given, room] = [BigInt(many), BigInt(many + 1)];
    const count = Number(this.#call("record", samples, given, step, scale, rotation, rows, room, out));
    return this.#taken(rows, piece * count, out);
  }

  #taken(rows: number, length: number, out: number): Tabulated {
    const found = this.#array(out, this.#names.length);
    return {
      pieces: this.#array(rows, length).slice(),
      numbers: Object.fromEntries(this.#names.map((name, k) => [name, found[k] ?? NaN])),
    };
  }

  #call(name: string, ...values: (number | bigint)[]): bigint {
    try {
      return (this.#functions[name] as (...values: (number | bigint)[]) => bigint)(...values);
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError) throw new Refused(422, [CONTRADICTION]); // its check failed
      throw error;
    }
  }

  #array(place: number, length: number): Float64Array {
    return new Float64Array(this.#memory.buffer, place, length);
  }

  #room(bytes: number): void {
    const missing = bytes - this.#memory.buffer.byteLength;
    if (missing > 0) this.#memory.grow(Math.ceil(missing / PAGE));
  }
}
