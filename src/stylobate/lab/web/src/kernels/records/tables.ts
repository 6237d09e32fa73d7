/** Tables of numbers in text files, as spreadsheets and other programs write them: layout, names and units. */

import { floatOf, isNumber, repr, words } from "./python";
import { REMARKS, type RecordText, type Row, notReadHere } from "./text";
import { unitOf } from "./units";

/** Names of a column of times, in small letters. */
export const TIMES = ["time", "t", "zeit", "temps", "tempo", "tiempo"];

const LEADING_ZERO = /^[-+]?0\d/;
const WITHOUT_POINT = /^(?:[-+]?\d*,\d+(?:[EeDd][-+]?\d+)?|[-+]?\d+(?:[EeDd][-+]?\d+)?)$/;
// The innermost brackets: a search for closing ones beyond other opening ones takes long in a line of opening ones.
const BRACKETED = /[[(]([^[\]()]*)[\])]/;
const ALL_BRACKETED = /^[[(][^[\]()]*[\])]$/;
const WORD = /[^\s[(]+(?:\s*[[(][^[\]()]*[\])])?|[[(][^[\]()]*[\])]/g;
const STARTS_WITH_DIGIT = /^[-+]?\.?\d/;
const RULE = /^[-=_+|\s]+$/;
const WRITE_POINTS = "Write decimal points, or put semicolons between the columns";

/** Rows of fields with decimal points, and the names above them with their units in brackets; null without names. */
export interface TextTable {
  readonly text: RecordText;
  readonly rows: readonly Row[];
  readonly names: readonly string[] | null;
  /** Index of the line of names. */
  readonly namesAt: number;
}

type Line = readonly [at: number, line: string];

export function tableOf(text: RecordText): TextTable {
  const lines = [...text.lines.entries()].filter(([, line]) => line.trim() !== "" && !isRemark(line));
  if (lines.some(([, line]) => line.includes('"'))) throw notReadHere(text.name, "tables with quotation marks");
  const found = lines.findIndex(([, line]) => isRow(line));
  const begin = found < 0 ? lines.length : found;
  const header = lines.slice(0, begin).filter(([, line]) => !RULE.test(line));
  let body = lines.slice(begin);
  if (hasDecimalCommas(text, body)) body = body.map(([at, line]) => [at, line.replaceAll(",", ".")]);
  const first = body[0]?.[1];
  if (first === undefined) return withNamesInFirstLine(text, lines);
  const separator = [";", ","].find((sign) => first.includes(sign)) ?? null;
  const width = fieldsOf(first, separator).length;
  const names = namesIn(header, width, separator);
  const unnamedCsv = names === null && separator !== null && header.some(([, line]) => line.includes(separator));
  if (unnamedCsv || !header.every(([, line]) => isHeader(line, width, separator)))
    return withNamesInFirstLine(text, lines);
  const split = (line: string): string[] => (names === null ? pieces(line) : fieldsOf(line, separator));
  return { text, rows: body.map(([at, line]) => [at, split(line)]), names, namesAt: header.at(-1)?.[0] ?? 0 };
}

function isRemark(line: string): boolean {
  return REMARKS.some((sign) => line.trimStart().startsWith(sign));
}

/** Returns a table of spoilt rows, whose first line may hold names of columns. */
function withNamesInFirstLine(text: RecordText, lines: readonly Line[]): TextTable {
  const [namesAt, first] = lines[0] ?? [0, ""];
  if (!/[,;]/.test(first) || first.split(/[,;]/).some(isNumber)) {
    return { text, rows: lines.map(([at, line]) => [at, pieces(line)]), names: null, namesAt };
  }
  const between = first.split(";").length > first.split(",").length ? ";" : ",";
  const cells = (line: string): string[] => line.split(between).map((cell) => cell.trim());
  return { text, rows: lines.slice(1).map(([at, line]) => [at, cells(line)]), names: cells(first), namesAt };
}

/** Returns whether the commas in rows of numbers are decimal; refuses commas that may also separate columns. */
function hasDecimalCommas(text: RecordText, body: readonly Line[]): boolean {
  const withCommas = body.filter(([, line]) => line.includes(","));
  const [begin, above] = withCommas[0] ?? [0, ""];
  if (body.some(([, line]) => line.includes(".") && isRow(line))) {
    if (!above.includes(";")) return false;
    throw text.fault(begin, `a decimal comma beside decimal points, or commas beside semicolons. ${WRITE_POINTS}`);
  }
  const rows = withCommas.filter(([, line]) => isRow(line)).map(([, line]) => line.trim());
  const at = withCommas.find(([, line]) => isRow(line))?.[0] ?? 0;
  const [first] = rows;
  if (first === undefined) return false;
  const tokens = rows.flatMap((line) => line.split(/[;\s]+/).filter((token) => token !== ""));
  const plain = tokens.every((token) => WITHOUT_POINT.test(token));
  if (/[;\s]/.test(first) && plain) return true;
  const split = rows.map(pieces);
  const times = split.map((row) => floatOf(row[0] ?? "") ?? NaN);
  const running = times.every((time, k) => k === 0 || (times[k - 1] ?? NaN) < time);
  const zeros = split.some((row) => row.slice(1).some((piece) => LEADING_ZERO.test(piece)));
  const single = tokens.length === rows.length && plain;
  if (single && zeros && !running) return true; // two columns of whole numbers never look like this
  if (!zeros && (!single || running)) return false;
  throw text.fault(at, `a decimal comma, or a comma between columns: ${repr(first.slice(0, 40))}. ${WRITE_POINTS}`);
}

function pieces(line: string): string[] {
  return line.split(/[;,\s]+/).filter((piece) => piece !== "");
}

function isRow(line: string): boolean {
  const found = pieces(line);
  return found.length > 0 && found.every(isNumber);
}

/** Returns whether a line above the numbers is a header and not a faulty row of numbers. */
function isHeader(line: string, width: number, separator: string | null): boolean {
  const found = separator === null ? pieces(line) : fieldsOf(line, separator);
  const spoilt = found.length === width && found.some((piece) => STARTS_WITH_DIGIT.test(piece));
  return /\p{L}/u.test(line) && !spoilt;
}

/** Splits a line into fields, at white space if `separator` is null. Separators at its end do not count. */
function fieldsOf(line: string, separator: string | null): string[] {
  const fields = (separator === null ? words(line) : line.split(separator)).map((field) => field.trim());
  while (fields.at(-1) === "") fields.pop();
  return fields;
}

/** Returns the names of the columns with their units in brackets; null if the header has no names. */
function namesIn(header: readonly Line[], width: number, separator: string | null): readonly string[] | null {
  const [above, last] = [header.at(-2)?.[1], header.at(-1)?.[1]];
  if (last === undefined) return null;
  let names = headerFields(last, width, separator);
  if (names && above !== undefined && names.every((name) => ALL_BRACKETED.test(name))) {
    const units = names;
    names = headerFields(above, width, separator)?.map((name, k) => `${name} ${units[k]}`) ?? names;
  }
  if (!names) return null;
  const units = names.flatMap((name) => BRACKETED.exec(name)?.[1] ?? []);
  if (width === 1) return units.some((unit) => unitOf(unit) !== null) ? names : null;
  const certain = separator !== null || last.includes("\t") || width > 2;
  return certain || units.length > 0 || TIMES.includes(names[0]?.toLowerCase() ?? "") ? names : null;
}

function headerFields(line: string, width: number, separator: string | null): readonly string[] | null {
  const plain = line.trim();
  const splits = [
    separator === null ? [] : fieldsOf(line, separator),
    fieldsOf(plain, "\t"),
    plain.split(/\s{2,}/),
    plain.match(WORD) ?? [],
  ];
  return splits.find((fields) => fields.length === width) ?? null;
}
