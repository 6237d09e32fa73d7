/**
 * Looks of the classes in maps and basins, those of the package's figures: a colour from Okabe and Ito's palette for
 * colour-blind readers, ordered in lightness from standing to falling, and a texture where colours are shared.
 */

/** Returns which pixels of a plane have the ink of the texture. */
type Texture = (x: number, y: number) => boolean;

export interface Look {
  readonly colour: string;
  readonly ink: string;
  readonly texture: Texture | null;
}

const PERIOD = 6; // px
const DARK = "#333333";
const WHITE = "#ffffff";

const rising: Texture = (x, y) => (x + y) % PERIOD === 0;
const falling: Texture = (x, y) => (((x - y) % PERIOD) + PERIOD) % PERIOD === 0;
const crossed: Texture = (x, y) => rising(x, y) || falling(x, y);
const dotted: Texture = (x, y) => x % PERIOD < 2 && y % PERIOD < 2;
const sparse: Texture = (x, y) => x % (2 * PERIOD) < 2 && y % PERIOD < 2;
const level: Texture = (_, y) => y % PERIOD === 0;
const upright: Texture = (x) => x % PERIOD === 0;
const squared: Texture = (x, y) => level(x, y) || upright(x, y);

function look(colour: string, texture: Texture | null = null, ink = WHITE): Look {
  return { colour, ink, texture };
}

const CREAM = "#F6F1DA";
const SKY = "#74C0EA";
const AMBER = "#D58900";
const BLUE = "#0063A0";
const SEA = "#008B65";
const MAUVE = "#A4558C";
const NIGHT = "#1B0B16";
const GREY = "#767676";
const UNSETTLED = look("#DAD2E8", crossed, "#8E7DA3");

const LOOKS: Readonly<Record<string, Look>> = {
  "at rest": look(CREAM),
  rocking: look(SKY),
  rolling: look(AMBER),
  periodic: look(SKY, rising, DARK),
  modulated: look(SEA, dotted),
  survived: look(CREAM, dotted, "#8E7DA3"),
  "still moving": UNSETTLED,
  "not settled": UNSETTLED,
  overturned: look(NIGHT),
  "limit reached": look(NIGHT, rising),
  "tilt limit reached": look(NIGHT, rising),
  "lifted off": look(GREY, sparse),
  slid: look("#E5BE8F", level, DARK),
  stopped: look(WHITE, squared, GREY),
  failed: look(WHITE, crossed, "#D55E00"),
  "rolling anticlockwise": look(AMBER),
  "rolling clockwise": look(BLUE, falling),
  "modulated anticlockwise": look(SEA, dotted),
  "modulated clockwise": look(SEA, squared),
  "aperiodic anticlockwise": look(MAUVE, level),
  "aperiodic clockwise": look(MAUVE, upright),
  aperiodic: look(MAUVE, squared),
  // What a column that can slide does.
  stays: look(CREAM),
  slides: look("#E5BE8F", level, DARK),
  "rocks or rolls": look(SKY),
  "slides and rocks": look(BLUE, falling),
  "hops upright": look(GREY, sparse),
  "hops and rocks": look(MAUVE, squared),
  overturns: look(NIGHT),
};

/** For classes of no known name, and the second, third … of a kind. */
const MORE: readonly Texture[] = [rising, dotted, upright, level, squared, crossed];

/** Returns the look of each class by its name; names that begin alike share a colour and differ in texture. */
export function looksOf(names: readonly string[]): readonly Look[] {
  const used = new Map<string, number>();
  return names.map((name) => {
    const kind = kindOf(name);
    const before = used.get(kind) ?? 0;
    used.set(kind, before + 1);
    const found = LOOKS[kind] ?? look(GREY, rising);
    return before === 0
      ? found
      : { ...found, texture: MORE[(before - 1) % MORE.length] ?? rising, ink: inkOn(found.colour) };
  });
}

function kindOf(name: string): string {
  if (name in LOOKS) return name;
  const known = Object.keys(LOOKS).filter((kind) => name.startsWith(kind));
  return known.sort((a, b) => b.length - a.length)[0] ?? name;
}

function inkOn(colour: string): string {
  return [CREAM, SKY, AMBER].includes(colour) ? DARK : WHITE;
}

export type Rgb = readonly [number, number, number];

export function rgbOf(colour: string): Rgb {
  const value = Number.parseInt(colour.slice(1), 16);
  return [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}
