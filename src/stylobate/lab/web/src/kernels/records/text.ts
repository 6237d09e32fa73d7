/** Text files of records: lines, and the numbers in them. Messages contain the name of the file and the line. */

import { Refused } from "../../page/server/source";
import { type Direction } from "./directions";
import { floatOf, isNumber, repr, trimmedEnd, words } from "./python";

/** Accelerations of a file, in its unit. */
export interface Component {
  /** One component, or x, y and z. */
  readonly columns: readonly Float64Array[];
  /** [s]. */
  readonly step: number;
  /** Time of the first sample [s]. */
  readonly start: number;
  /** Null if the file does not state it. */
  readonly unit: string | null;
  readonly direction: Direction | null;
  readonly title: string;
  /** Whether the file or its format states the unit of time; otherwise it is assumed to be s. */
  readonly statesTimeUnit: boolean;
}

/** Fields of a line, with the index of the line. */
export type Row = readonly [at: number, fields: readonly string[]];

/** Prefixes of comment lines. */
export const REMARKS = ["#", "%", "!", "//"] as const;

/** Characters of a message beside the place: more than any of ours has without words of the file. */
const LONGEST_FAULT = 400;
const WHOLE = /^[0-9]{1,12}$/;
const DECIMAL_COMMA = /^[-+]?\d*[.,]?\d*,\d+([EeDd][-+]?\d+)?$/;

/** Refuses a file that the package reads and this page does not. */
export function notReadHere(name: string, what: string): Refused {
  const remedy = "Install stylobate and run “stylobate lab”, which reads it.";
  return new Refused(422, [`${name}: this page does not read ${what}. ${remedy}`]);
}

export class RecordText {
  readonly name: string;
  readonly lines: readonly string[];

  constructor(name: string, content: string) {
    this.name = name;
    this.lines = trimmedEnd(content, "\x1a\0").replace(/\r\n?/g, "\n").split("\n");
  }

  /**
   * Returns a refusal with the name of the file and the line at `index`. Words of the file in the middle of `what` may be
   * long: the message keeps its problem and its remedy.
   */
  fault(index: number, what: string): Refused {
    const half = LONGEST_FAULT / 2;
    const short = what.length > LONGEST_FAULT ? `${what.slice(0, half)} … ${what.slice(-half)}` : what;
    return new Refused(422, [`${this.name}, line ${Math.min(index + 1, this.lines.length)}: ${short}`]);
  }

  /** Parses a token of the line at `index` as a finite number. */
  number(index: number, token: string): number {
    const value = floatOf(token);
    if (value === null) {
      const remedy = DECIMAL_COMMA.test(token) ? "Write decimal points" : "Correct or remove it";
      throw this.fault(index, `not a number: ${repr(token)}. ${remedy}`);
    }
    if (Number.isFinite(value)) return value;
    const remedy = "Replace it by a number, or trim the file to the samples without gaps";
    throw this.fault(index, `not a finite number: ${repr(token)}. ${remedy}`);
  }

  /** Parses a token of the header as a number of samples, at least two. */
  count(index: number, name: string, token: string): number {
    if (!WHOLE.test(token)) {
      throw this.fault(index, `${name} must be a whole number, got ${repr(token)}. Correct the header`);
    }
    if (Number(token) < 2)
      throw this.fault(index, `${name} must be at least 2 samples, got ${token}. Correct the header`);
    return Number(token);
  }

  /** Parses fields of each row to numbers, by columns. */
  columns(rows: readonly Row[], places: readonly number[]): Float64Array[] {
    const found = places.map(() => new Float64Array(rows.length));
    rows.forEach(([at, fields], k) => {
      places.forEach((place, column) => ((found[column] as Float64Array)[k] = this.number(at, fields[place] ?? "")));
    });
    return found;
  }

  /** Parses all numbers below the line at `after`, `count` of them if it is given. */
  series(after: number, count: number | null): Float64Array {
    const values: number[] = [];
    let last = after;
    for (let at = after + 1; at < this.lines.length; at += 1) {
      for (const token of words(this.lines[at] ?? "")) {
        values.push(this.number(at, token));
        last = at;
      }
    }
    if (count !== null && values.length !== count) {
      const remedy = "Download the file again, or correct the count in the header";
      throw this.fault(last, `the header states ${count} samples, the file has ${values.length}. ${remedy}`);
    }
    return Float64Array.from(values);
  }

  /** Returns the index of the first line that holds only numbers; the number of lines if there is none. */
  firstRow(): number {
    const found = this.lines.findIndex((line) => line.trim() !== "" && words(line).every(isNumber));
    return found < 0 ? this.lines.length : found;
  }
}
