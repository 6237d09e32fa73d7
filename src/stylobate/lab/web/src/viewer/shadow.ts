/** The shadow of a convex body on a plane z = const: no map of depths, so that it costs next to nothing. */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  CustomBlending,
  EqualStencilFunc,
  Mesh,
  MinEquation,
  ShaderMaterial,
  type ShaderMaterialParameters,
  type Vector3,
} from "three";
import type { Triple } from "./drawn-motion";
import type { Palette } from "./palette";

/** A shadow of a point, and how high above the floor the point is. */
export interface Cast {
  readonly x: number;
  readonly y: number;
  readonly height: number;
}

/** Return the convex hull of points, anticlockwise: Andrew's monotone chain. */
export function convexHull(points: readonly Cast[]): Cast[] {
  const ordered = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
  const chain = (given: readonly Cast[]): Cast[] => {
    const kept: Cast[] = [];
    for (const point of given) {
      while (kept.length > 1 && turn(kept.at(-2)!, kept.at(-1)!, point) <= 0) kept.pop();
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return [...chain(ordered), ...chain(ordered.toReversed())];
}

function turn(a: Cast, b: Cast, c: Cast): number {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/** Return the unit normals that point out of a convex outline, at its corners. */
export function outwardNormals(hull: readonly Cast[]): (readonly [number, number])[] {
  const edge = (i: number): readonly [number, number] => {
    const [a, b] = [hull[i]!, hull[(i + 1) % hull.length]!];
    const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
    return [(b.y - a.y) / length, (a.x - b.x) / length];
  };
  return hull.map((_, i) => {
    const [before, after] = [edge((i + hull.length - 1) % hull.length), edge(i)];
    const sum = [before[0] + after[0], before[1] + after[1]] as const;
    const length = Math.hypot(...sum) || 1;
    return [sum[0] / length, sum[1] / length];
  });
}

const VERTEX = /* glsl */ `
  attribute float strength;
  varying float dark;
  void main() {
    dark = strength;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;
const FRAGMENT = /* glsl */ `
  uniform vec3 colour;
  uniform vec3 bare;
  uniform float strength;
  varying float dark;
  void main() {
    float share = strength * dark * dark * (3.0 - 2.0 * dark);
    gl_FragColor = MERGES == 1 ? vec4(mix(bare, colour, share), 1.0) : vec4(colour, share);
  }
`;

const SOFTNESS = 0.05; // half width of the edge over the height of what casts it

/** What a shadow falls on. */
export interface Floor {
  /** Mark of its pixels. */
  readonly stencil: number;
  /** Its colour where nothing lies on it, if shadows of several bodies merge on it; else all that lies there darkens. */
  readonly bare?: string;
}

export class Shadow {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  readonly #corners: number;
  readonly #positions: BufferAttribute;

  /**
   * @param corners - most corners that the outline can have
   * @param sharpest, softest - bounds of the half width of the edge [m]
   */
  constructor(
    corners: number,
    floor: Floor,
    readonly sharpest: number,
    readonly softest: number,
    palette: Palette,
  ) {
    this.#corners = corners;
    // A fan inside (middle, inner outline) and a strip outwards (inner outline, outer outline), first corner again at the end.
    const ring = corners + 1;
    const strengths = new Float32Array(1 + 2 * ring).fill(1, 0, 1 + ring);
    const indices: number[] = [];
    for (let i = 0; i < corners; i += 1) {
      const [a, b, c, d] = [1 + i, 2 + i, 1 + ring + i, 2 + ring + i];
      indices.push(0, a, b, a, c, d, a, d, b);
    }
    const geometry = new BufferGeometry();
    this.#positions = new BufferAttribute(new Float32Array(3 * (1 + 2 * ring)), 3);
    geometry.setAttribute("position", this.#positions);
    geometry.setAttribute("strength", new BufferAttribute(strengths, 1));
    geometry.setIndex(indices);
    this.mesh = new Mesh(geometry, shadowMaterial(floor, palette));
    this.mesh.frustumCulled = false; // its corners move
  }

  /** Cast the shadow of the hull of `points` on the plane z = `level`, by parallel light from `light`. */
  cast(points: Iterable<Triple>, light: Vector3, level: number): void {
    const casts: Cast[] = [];
    for (const [x, y, z] of points) {
      const height = Math.max(0, z - level);
      casts.push({ x: x - (height * light.x) / light.z, y: y - (height * light.y) / light.z, height });
    }
    const hull = convexHull(casts).slice(0, this.#corners);
    const normals = outwardNormals(hull);
    const middle = hull.reduce((sum, { x, y }) => [sum[0]! + x / hull.length, sum[1]! + y / hull.length], [0, 0]);
    this.#positions.setXYZ(0, middle[0]!, middle[1]!, level);
    for (let i = 0; i <= hull.length; i += 1) {
      const corner = hull[i % hull.length]!;
      const normal = normals[i % hull.length]!;
      const soft = Math.min(this.softest, Math.max(this.sharpest, SOFTNESS * corner.height));
      this.#positions.setXYZ(1 + i, corner.x - soft * normal[0], corner.y - soft * normal[1], level);
      this.#positions.setXYZ(2 + this.#corners + i, corner.x + soft * normal[0], corner.y + soft * normal[1], level);
    }
    this.#positions.needsUpdate = true;
    this.mesh.geometry.setDrawRange(0, 9 * hull.length);
  }
}

function shadowMaterial({ stencil, bare }: Floor, { shadow, shadowStrength }: Palette): ShaderMaterial {
  // The darkest of the shadows counts where they overlap, as in the light of one sun.
  const merging: ShaderMaterialParameters = { blending: CustomBlending, blendEquation: MinEquation };
  return new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    defines: { MERGES: bare === undefined ? 0 : 1 },
    uniforms: {
      colour: { value: asShown(shadow) },
      bare: { value: asShown(bare ?? shadow) },
      strength: { value: shadowStrength },
    },
    transparent: true,
    depthWrite: false,
    stencilWrite: true,
    stencilFunc: EqualStencilFunc,
    stencilRef: stencil,
    ...(bare === undefined ? {} : merging),
  });
}

/** Return the numbers of a colour on the screen: shadows are blended there. */
function asShown(colour: string): Color {
  return new Color(colour).convertLinearToSRGB();
}
