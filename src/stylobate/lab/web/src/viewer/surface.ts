/** Surfaces put together from strips and fans, before they go to the graphics card. */

import { BufferAttribute, BufferGeometry, type Color } from "three";
import type { Triple } from "./drawn-motion";

export interface Corner {
  readonly at: Triple;
  readonly normal: Triple;
  readonly colour: Color;
}

export class Surface {
  readonly #positions: number[] = [];
  readonly #normals: number[] = [];
  readonly #colours: number[] = [];
  readonly #indices: number[] = [];

  /** Add a quadrilateral, its corners anticlockwise seen from outside. */
  quad(a: Corner, b: Corner, c: Corner, d: Corner): void {
    const [i, j, k, l] = [this.#corner(a), this.#corner(b), this.#corner(c), this.#corner(d)];
    this.#indices.push(i, j, k, i, k, l);
  }

  /** Add a convex face, its corners anticlockwise seen from where `normal` points to. */
  face(corners: readonly Triple[], normal: Triple, colour: Color): void {
    const first = corners.map((at) => this.#corner({ at, normal, colour }))[0]!;
    for (let i = 1; i + 1 < corners.length; i += 1) this.#indices.push(first, first + i, first + i + 1);
  }

  geometry(): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(this.#positions), 3));
    geometry.setAttribute("normal", new BufferAttribute(new Float32Array(this.#normals), 3));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(this.#colours), 3));
    geometry.setIndex(this.#indices);
    return geometry;
  }

  #corner({ at, normal, colour }: Corner): number {
    this.#positions.push(...at);
    this.#normals.push(...normal);
    this.#colours.push(colour.r, colour.g, colour.b);
    return this.#positions.length / 3 - 1;
  }
}
