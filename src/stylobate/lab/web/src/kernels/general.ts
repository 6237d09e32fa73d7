/** Numbers in words, as the package writes them. */

/** Returns a number with so many significant digits, without zeros at the end: Python's format "g". */
export function general(value: number, digits: number): string {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
  const [mantissa = "0", power = "0"] = value.toExponential(digits - 1).split("e");
  const exponent = Number(power);
  if (exponent < -4 || exponent >= digits) {
    const size = String(Math.abs(exponent)).padStart(2, "0");
    return `${shorn(mantissa)}e${exponent < 0 ? "-" : "+"}${size}`;
  }
  return shorn(value.toFixed(digits - 1 - exponent));
}

function shorn(text: string): string {
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

/** Returns a text with numbers in its gaps: `{name}`, or `{name:.10g}`. */
export function filled(text: string, numbers: Readonly<Record<string, number | string>>): string {
  return text.replace(/\{(\w+)(?::\.(\d+)g)?\}/g, (gap, name: string, digits?: string) => {
    const value = numbers[name];
    if (value === undefined) return gap;
    return digits !== undefined && typeof value === "number" ? general(value, Number(digits)) : String(value);
  });
}
