/** Numbers and texts as Python reads and writes them. */

const DIGITS = String.raw`\d(?:_?\d)*`;
const NUMBER = new RegExp(
  String.raw`^\s*[-+]?(?:(?:${DIGITS}\.?(?:${DIGITS})?|\.${DIGITS})(?:e[-+]?${DIGITS})?|(?:inf|infinity|nan))\s*$`,
  "i",
);

/** Returns the number that a token spells, NaN for one of the words inf and nan; null if it spells none. */
export function floatOf(token: string): number | null {
  return NUMBER.test(token) ? Number(token.replaceAll("_", "")) : null;
}

export function isNumber(token: string): boolean {
  return NUMBER.test(token);
}

const ESCAPED: Readonly<Record<string, string>> = { " ": " ", "\\": "\\\\", "\t": "\\t", "\n": "\\n", "\r": "\\r" };

/** Returns a text or a number as `repr` writes it. */
export function repr(value: string | number | null): string {
  if (value === null) return "None";
  if (typeof value === "number") return written(value);
  const quote = value.includes("'") && !value.includes('"') ? '"' : "'";
  const inside = value.replace(/[\\\p{C}\p{Z}]/gu, (sign) => ESCAPED[sign] ?? hexadecimal(sign));
  return quote + (quote === "'" ? inside.replaceAll("'", "\\'") : inside) + quote;
}

function hexadecimal(sign: string): string {
  const code = (sign.codePointAt(0) ?? 0).toString(16);
  const [letter, length] = code.length > 4 ? (["U", 8] as const) : code.length > 2 ? (["u", 4] as const) : ["x", 2];
  return `\\${letter}${code.padStart(length, "0")}`;
}

function written(value: number): string {
  const [mantissa = "0", power = "0"] = value.toExponential().split("e");
  const exponent = Number(power);
  if (exponent < -4 || exponent >= 16) {
    return `${mantissa}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  }
  const text = value.toFixed(Math.max(1, mantissa.replace(/^-?\d\.?/, "").length - exponent));
  return Object.is(value, -0) ? "-0.0" : text;
}

/** Returns a text without the signs of `trimmed` at its end. */
export function trimmedEnd(text: string, trimmed: string): string {
  let end = text.length;
  while (end > 0 && trimmed.includes(text[end - 1] ?? "")) end -= 1;
  return text.slice(0, end);
}

/** Splits at white space, without empty pieces. */
export function words(line: string): string[] {
  return line.split(/\s+/).filter((word) => word !== "");
}
