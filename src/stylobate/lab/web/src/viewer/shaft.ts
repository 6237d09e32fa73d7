/** The fluted column: drum, shaft, top; one flute and a radius of the top are marked, so that turning is seen. */

import { type BufferGeometry, Color, Mesh, type ShaderMaterial } from "three";
import type { DrawnColumn, Triple } from "./drawn-motion";
import { litMaterial } from "./lit-material";
import type { Palette } from "./palette";
import { type Corner, Surface } from "./surface";

const FLUTES = 20;
const HOLLOW_STEPS = 6; // of one flute, across
const ARRIS = 0.14; // part of a flute's width that is edge
const DEPTH = 0.055; // of a flute, of the radius
const INSET = 0.95; // radius of the shaft over that of its ends
const SHADE = 0.72; // light that reaches the bottom of a flute

const MARKED = 0; // the flute in the direction of the body's own x

/** Height of the plain ends above and below the flutes [m]. */
export function endHeight({ radius, top_radius, height }: DrawnColumn): number {
  return Math.min(0.22 * Math.min(radius, top_radius), 0.14 * height);
}

/** A point of the outline of a fluted shaft of radius 1: angle, radius, direction of its normal, light it gets. */
interface OutlinePoint {
  readonly angle: number;
  readonly radius: number;
  readonly normal: number;
  readonly light: number;
  readonly marked: boolean;
}

/** Return the outline of a fluted shaft, anticlockwise, points of an edge twice. */
export function flutedOutline(): OutlinePoint[][] {
  const width = (2 * Math.PI) / FLUTES;
  const hollow = 0.5 * width * (1 - ARRIS); // half the angle of a hollow
  const strips: OutlinePoint[][] = [];
  for (let flute = 0; flute < FLUTES; flute += 1) {
    const middle = flute * width;
    const marked = flute === MARKED;
    const strip: OutlinePoint[] = [];
    for (let step = 0; step <= HOLLOW_STEPS; step += 1) {
      const across = (2 * step) / HOLLOW_STEPS - 1;
      const deep = 1 - across * across;
      const slope = (2 * DEPTH * across) / hollow; // dr/dφ of r = 1 − DEPTH (1 − across²)
      const angle = middle + across * hollow;
      strip.push({
        angle,
        radius: 1 - DEPTH * deep,
        normal: angle - Math.atan(slope),
        light: 1 - (1 - SHADE) * deep,
        marked,
      });
    }
    const edges = [middle + hollow, middle + width - hollow];
    strips.push(
      strip,
      edges.map((angle) => ({ angle, radius: 1, normal: angle, light: 1, marked: false })),
    );
  }
  return strips;
}

export function shaftMesh(column: DrawnColumn, palette: Palette): Mesh<BufferGeometry, ShaderMaterial> {
  const surface = new Surface();
  const ends = endHeight(column);
  const radiusAt = (z: number): number => column.radius + ((column.top_radius - column.radius) * z) / column.height;
  const taper = Math.atan((column.radius - column.top_radius) / column.height);
  const [stone, mark] = [new Color(palette.stone), new Color(palette.mark)];

  const low = ends;
  const high = column.height - ends;
  for (const strip of flutedOutline()) {
    for (let i = 0; i + 1 < strip.length; i += 1) {
      const corner = (point: OutlinePoint, z: number): Corner => ({
        at: around(point.angle, INSET * point.radius * radiusAt(z), z),
        normal: leaning(point.normal, taper),
        colour: (point.marked ? mark : stone).clone().multiplyScalar(point.light),
      });
      const [a, b] = [strip[i]!, strip[i + 1]!];
      surface.quad(corner(a, low), corner(b, low), corner(b, high), corner(a, high));
    }
  }
  addTop(surface, column, high, radiusAt(high), taper, palette);
  const bottom = circle(column.radius, 0).reverse();
  surface.face(bottom, [0, 0, -1], new Color(palette.rim).multiplyScalar(0.8));
  return new Mesh(surface.geometry(), litMaterial(palette));
}

const SIDES = 80;
const MARK_SIDES = 3; // of the SIDES, those of the mark on the top

/** Add the plain end at the top, its side, the ring below and the face above, with the marked radius. */
function addTop(
  surface: Surface,
  column: DrawnColumn,
  low: number,
  lowRadius: number,
  taper: number,
  palette: Palette,
): void {
  const { height, top_radius } = column;
  const [stone, mark] = [new Color(palette.stone), new Color(palette.mark)];
  const below = stone.clone().multiplyScalar(0.6);
  for (let side = 0; side < SIDES; side += 1) {
    const [a, b] = sideAngles(side, SIDES, -0.5 * MARK_SIDES);
    const colour = side < MARK_SIDES ? mark : stone;
    const corner = (angle: number, radius: number, z: number): Corner => ({
      at: around(angle, radius, z),
      normal: leaning(angle, taper),
      colour,
    });
    surface.quad(
      corner(a, lowRadius, low),
      corner(b, lowRadius, low),
      corner(b, top_radius, height),
      corner(a, top_radius, height),
    );
    const under = (angle: number, radius: number): Corner => ({
      at: around(angle, radius, low),
      normal: [0, 0, -1],
      colour: below,
    });
    surface.quad(under(b, lowRadius), under(a, lowRadius), under(a, 0.85 * lowRadius), under(b, 0.85 * lowRadius));
  }
  surface.face(circle(top_radius, height), [0, 0, 1], stone);
  const half = (0.5 * MARK_SIDES * 2 * Math.PI * top_radius) / SIDES;
  const lift = height + 2e-4 * top_radius;
  const reach = top_radius * Math.cos(Math.asin(half / top_radius));
  surface.face(
    [
      [0, -half, lift],
      [reach, -half, lift],
      [reach, half, lift],
      [0, half, lift],
    ],
    [0, 0, 1],
    mark,
  );
}

/** Return the angles where a side begins and ends, of so many, the first from `start` sides on. */
export function sideAngles(side: number, sides: number, start = 0): readonly [number, number] {
  const width = (2 * Math.PI) / sides;
  return [(side + start) * width, (side + start + 1) * width];
}

export function around(angle: number, radius: number, z: number): Triple {
  return [radius * Math.cos(angle), radius * Math.sin(angle), z];
}

export function leaning(angle: number, taper: number): Triple {
  return [Math.cos(taper) * Math.cos(angle), Math.cos(taper) * Math.sin(angle), Math.sin(taper)];
}

function circle(radius: number, z: number): Triple[] {
  return Array.from({ length: SIDES }, (_, side) => around(sideAngles(side, SIDES)[0], radius, z));
}
