/** The base: a slab with rounded corners whose top is the plane the column stands on. */

import { AlwaysStencilFunc, Color, Mesh, ReplaceStencilOp, type ShaderMaterialParameters } from "three";
import type { Triple } from "./drawn-motion";
import { litMaterial, plainMaterial } from "./lit-material";
import type { Palette } from "./palette";
import { type Corner, Surface } from "./surface";

/** Marks of the pixels that shadows fall on. */
export const ON_GROUND = 0;
export const ON_SLAB = 1;
const ON_SIDES = 2; // no shadow is drawn there

const ARC = 6; // steps round a corner

type Edges = readonly [number, number, number, number];

/** Return the outline of a slab seen from above, anticlockwise. */
export function slabOutline([fromX, fromY, toX, toY]: Edges, rounding: number): (readonly [number, number])[] {
  const middles = [
    [toX - rounding, fromY + rounding],
    [toX - rounding, toY - rounding],
    [fromX + rounding, toY - rounding],
    [fromX + rounding, fromY + rounding],
  ] as const;
  return middles.flatMap(([x, y], corner) =>
    Array.from({ length: ARC + 1 }, (_, step) => {
      const angle = 0.5 * Math.PI * (corner - 1 + step / ARC);
      return [x + rounding * Math.cos(angle), y + rounding * Math.sin(angle)] as const;
    }),
  );
}

export function slabMeshes(
  outline: readonly (readonly [number, number])[],
  thickness: number,
  palette: Palette,
): Mesh[] {
  const top = new Surface();
  top.face(
    outline.map(([x, y]): Triple => [x, y, 0]),
    [0, 0, 1],
    new Color(palette.slab),
  );
  const sides = wall(
    outline,
    () => 0,
    () => -thickness,
    new Color(palette.slabSide),
  );
  return [new Mesh(top.geometry(), plainMaterial(palette.slab, floor(ON_SLAB))), wallMesh(sides, palette)];
}

export function wallMesh(surface: Surface, palette: Palette): Mesh {
  return new Mesh(surface.geometry(), litMaterial(palette, floor(ON_SIDES)));
}

/** Return the wall under an outline, between two heights that may differ from place to place. */
export function wall(
  outline: readonly (readonly [number, number])[],
  high: (x: number, y: number) => number,
  low: (x: number, y: number) => number,
  colour: Color,
): Surface {
  const surface = new Surface();
  outline.forEach(([ax, ay], i) => {
    const [bx, by] = outline[(i + 1) % outline.length]!;
    const length = Math.hypot(bx - ax, by - ay) || 1;
    const normal: Triple = [(by - ay) / length, (ax - bx) / length, 0];
    const corner = (x: number, y: number, z: number): Corner => ({ at: [x, y, z], normal, colour });
    surface.quad(
      corner(ax, ay, low(ax, ay)),
      corner(bx, by, low(bx, by)),
      corner(bx, by, high(bx, by)),
      corner(ax, ay, high(ax, ay)),
    );
  });
  return surface;
}

/** Return what marks the pixels of a floor, and puts it behind what is drawn in its plane. */
function floor(stencil: number): ShaderMaterialParameters {
  return {
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 2,
    stencilWrite: true,
    stencilFunc: AlwaysStencilFunc,
    stencilRef: stencil,
    stencilZPass: ReplaceStencilOp,
  };
}
