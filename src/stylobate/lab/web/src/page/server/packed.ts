/** Answers whose long lists are packed by `stylobate.lab.packing`: the numbers that are read are those that were written. */

/** Numbers: to be summed up `order` times, and divided by ten to the power `decimals`. */
type Column = readonly [decimals: number, order: number, whole: readonly number[]];

/** The columns of a list of numbers, or of a list of rows. */
interface Packed {
  readonly packed: readonly Column[];
  readonly rows: boolean;
}

/** Returns a value of JSON with its lists unpacked. */
export function unpacked(value: unknown): unknown {
  if (Array.isArray(value)) return typeof value[0] === "object" ? value.map(unpacked) : value;
  if (typeof value !== "object" || value === null) return value;
  if (isPacked(value)) return listOf(value);
  return Object.fromEntries(Object.entries(value).map(([name, one]) => [name, unpacked(one)]));
}

function isPacked(value: object): value is Packed {
  return "packed" in value;
}

function listOf({ packed, rows }: Packed): readonly unknown[] {
  const columns = packed.map(numbersOf);
  const [first = []] = columns;
  return rows ? first.map((_, row) => columns.map((column) => column[row])) : first;
}

function numbersOf([decimals, order, whole]: Column): readonly number[] {
  const values = [...whole];
  for (let times = 0; times < order; times += 1) {
    let sum = 0;
    for (let i = 0; i < values.length; i += 1) values[i] = sum += values[i] ?? 0;
  }
  const scale = Number(`1e${decimals}`);
  return values.map((value) => value / scale);
}
