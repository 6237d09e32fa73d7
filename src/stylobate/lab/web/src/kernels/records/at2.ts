/** AT2 files of PEER: four lines of header, then the accelerations, several per line. */

import { parsedDirection } from "./directions";
import { repr, words } from "./python";
import type { Component, RecordText } from "./text";
import { SECOND, inSeconds, timeUnitOf, unitOf, unknownUnit } from "./units";

// The fourth line is `NPTS=   4000, DT=   .0050 SEC` in newer files and `4000    0.0050    NPTS, DT` in older ones.
const NUMBER = String.raw`[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?`;
const NEW = new RegExp(
  String.raw`NPTS\s*=\s*(?<count>[^\s=]+?)\s*,\s*DT\s*=\s*(?<step>${NUMBER})?\s*(?<clock>\p{L}*)`,
  "iu",
);
const OLD = new RegExp(String.raw`^\s*(?<count>\d+)\s+(?:(?<step>${NUMBER})\s*)?(?<clock>)NPTS\s*,\s*DT`, "i");
const UNITS = /UNITS?\s+OF\s+([^\s,.;]+)/i;
const OTHERS = /^\s*(VELOCITY|DISPLACEMENT)\b/i;
/** Number of lines among which the line with the count is looked for. */
const HEADER = 8;
const TIME_AND_ACCELERATION = 2;

type Counting = Readonly<Record<string, string | undefined>>;

function countingLine(text: RecordText): readonly [at: number, found: Counting] | null {
  for (const [at, line] of text.lines.slice(0, HEADER).entries()) {
    const found = (NEW.exec(line) ?? OLD.exec(line))?.groups;
    if (found) return [at, found];
  }
  return null;
}

export function isAt2(text: RecordText): boolean {
  return countingLine(text) !== null;
}

/** Returns whether the numbers are laid out as in an AT2 file: several per line, fewer on the last line. */
export function isWrapped(text: RecordText): boolean {
  const widths = text.lines.slice(text.firstRow()).map((line) => words(line).length);
  const [first = 0, last = 0] = [widths.find((width) => width > 0), widths.findLast((width) => width > 0)];
  return TIME_AND_ACCELERATION < first && first >= last;
}

/** Reads an AT2 file; `step` [s] is for a file whose header lacks the line with NPTS and DT. */
export function readAt2(text: RecordText, step: number | null): Component {
  const counting = countingLine(text);
  const last = counting ? counting[0] : text.firstRow() - 1;
  if (!counting && (step === null || !isWrapped(text))) {
    const state = last >= 0 ? "incomplete header" : "no header";
    const remedy = "Restore it, or state step, in s, and units";
    throw text.fault(0, `${state} of an AT2 file: the line with NPTS and DT is missing. ${remedy}`);
  }
  const stated = counting && statedIn(text, ...counting);
  const header = text.lines.slice(0, last + 1);
  const title = header[1] ?? ""; // "Loma Prieta, 10/18/1989, Corralitos, 90"
  const columns = [text.series(last, stated?.count ?? null)];
  return {
    columns,
    ...{ step: stated?.step ?? step ?? NaN, start: 0, unit: unitIn(text, header), title: title.trim() },
    direction: title.includes(",") ? parsedDirection(title.slice(title.lastIndexOf(",") + 1)) : null,
    statesTimeUnit: stated?.clock !== null && stated !== null,
  };
}

function statedIn(text: RecordText, at: number, found: Counting) {
  if (found["step"] === undefined) throw text.fault(at, "the time step DT is missing. State it in the header, in s");
  const count = text.count(at, "NPTS", found["count"] ?? "");
  const clock = timeUnitOf(found["clock"] ?? "");
  const written = text.number(at, found["step"].toUpperCase().replaceAll("D", "E"));
  const step = inSeconds(written, clock ?? SECOND);
  if (step <= 0) throw text.fault(at, `the time step DT must be positive, got ${repr(step)}. Correct the header`);
  return { count, step, clock };
}

function unitIn(text: RecordText, header: readonly string[]): string | null {
  for (const [at, line] of header.entries()) {
    if (OTHERS.test(line)) {
      const what = words(line)[0]?.toLowerCase();
      throw text.fault(at, `the file holds ${what}, not acceleration. Read the .AT2 file of this component`);
    }
    const found = UNITS.exec(line)?.[1];
    if (found === undefined) continue;
    const unit = unitOf(found);
    if (unit === null) throw text.fault(at, unknownUnit(found));
    return unit;
  }
  return null;
}
