/** Round lengths, and how they are written. */

/** Return the least of 1, 2, 5 times a power of ten that is not below `length`. */
export function roundLength(length: number): number {
  const decade = 10 ** Math.floor(Math.log10(length));
  const step = [1, 2, 5, 10].find((factor) => factor * decade >= length * (1 - 1e-9)) ?? 10;
  return step * decade;
}

const UNITS: readonly (readonly [from: number, size: number, name: string])[] = [
  [1000, 1000, "km"],
  [0.1, 1, "m"],
  [0.01, 0.01, "cm"],
  [1e-3, 1e-3, "mm"],
  [0, 1e-6, "µm"],
];

/** Return a length [m] in words: 0.5 m, 2 cm, 5 mm. */
export function lengthInWords(length: number): string {
  const [, size, name] = UNITS.find(([from]) => length >= from * (1 - 1e-9)) ?? UNITS.at(-1)!;
  return `${Number((length / size).toPrecision(3))} ${name}`;
}
