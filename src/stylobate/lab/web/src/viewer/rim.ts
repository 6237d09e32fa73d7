/** The plain end at the bottom: it takes the colour of contact where it has touched, and pales with time. */

import { type BufferAttribute, Color, Mesh } from "three";
import type { DrawnColumn } from "./drawn-motion";
import { litMaterial } from "./lit-material";
import type { Palette } from "./palette";
import type { RimVisits } from "./rim-visits";
import { around, endHeight, leaning, sideAngles } from "./shaft";
import { type Corner, Surface } from "./surface";

const CORNERS = 8; // of a sector: its side and the ring above

export class Rim {
  readonly mesh: Mesh;
  readonly #colours: BufferAttribute;
  readonly #untouched: Color;
  readonly #old: Color;
  readonly #new: Color;

  constructor(
    column: DrawnColumn,
    palette: Palette,
    readonly visits: RimVisits,
    readonly memory: number,
  ) {
    this.#untouched = new Color(palette.rim);
    this.#old = new Color(palette.contactOld);
    this.#new = new Color(palette.contact);
    const geometry = rimSurface(column, visits.sectors, this.#untouched).geometry();
    this.#colours = geometry.getAttribute("color") as BufferAttribute;
    this.mesh = new Mesh(geometry, litMaterial(palette));
  }

  setTime(time: number): void {
    const shade = new Color();
    for (let sector = 0; sector < this.visits.sectors; sector += 1) {
      const touched = this.visits.last(sector, time);
      if (touched === null) shade.copy(this.#untouched);
      else shade.copy(this.#old).lerp(this.#new, Math.exp((touched - time) / this.memory));
      for (let k = 0; k < CORNERS; k += 1) this.#colours.setXYZ(CORNERS * sector + k, shade.r, shade.g, shade.b);
    }
    this.#colours.needsUpdate = true;
  }
}

function rimSurface(column: DrawnColumn, sectors: number, colour: Color): Surface {
  const surface = new Surface();
  const top = endHeight(column);
  const taper = Math.atan((column.radius - column.top_radius) / column.height);
  const topRadius = column.radius - Math.tan(taper) * top;
  for (let sector = 0; sector < sectors; sector += 1) {
    const [a, b] = sideAngles(sector, sectors);
    const side = (angle: number, radius: number, z: number): Corner => ({
      at: around(angle, radius, z),
      normal: leaning(angle, taper),
      colour,
    });
    surface.quad(
      side(a, column.radius, 0),
      side(b, column.radius, 0),
      side(b, topRadius, top),
      side(a, topRadius, top),
    );
    const above = (angle: number, radius: number): Corner => ({
      at: around(angle, radius, top),
      normal: [0, 0, 1],
      colour,
    });
    surface.quad(above(a, topRadius), above(b, topRadius), above(b, 0.85 * topRadius), above(a, 0.85 * topRadius));
  }
  return surface;
}
