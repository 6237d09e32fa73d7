/** The lowest point of the rim, seen through the column too, and the circle on which it lies. */

import { Group, Mesh, MeshBasicMaterial, RingGeometry, SphereGeometry } from "three";
import type { DrawnColumn } from "./drawn-motion";
import type { Extent } from "./extent";
import type { Moment } from "./moment";
import type { Palette } from "./palette";
import { flies } from "./touching";

const HIDDEN = 0.3; // opacity where the column stands before it

export class ContactMark {
  readonly group = new Group();
  readonly point = new Group();
  readonly #circle: Mesh<RingGeometry, MeshBasicMaterial>;
  readonly #radius: number;
  readonly #palette: Palette;

  constructor(column: DrawnColumn, extent: Extent, palette: Palette) {
    this.#radius = column.radius;
    this.#palette = palette;
    const ball = new SphereGeometry(0.024 * extent.size, 20, 14);
    const seen = new Mesh(ball, new MeshBasicMaterial({ color: palette.contactPoint }));
    const hidden = new Mesh(
      ball,
      new MeshBasicMaterial({
        color: palette.contactPoint,
        transparent: true,
        opacity: HIDDEN,
        depthTest: false,
        depthWrite: false,
      }),
    );
    hidden.renderOrder = 10; // over the column
    this.point.add(seen, hidden);

    const half = 0.0035 * extent.size;
    this.#circle = new Mesh(
      new RingGeometry(column.radius - half, column.radius + half, 96, 1),
      new MeshBasicMaterial({ color: palette.footprint, transparent: true, depthWrite: false }),
    );
    this.#circle.renderOrder = 3;
    this.group.add(this.point, this.#circle);
  }

  show({ contact, clearance, footprint, resting }: Moment): void {
    this.point.position.set(contact[0], contact[1], clearance);
    this.#circle.position.set(footprint[0], footprint[1], 0);
    // Standing, it touches all round; flying, nowhere.
    this.point.visible = !resting && !flies(clearance, this.#radius);
    this.#circle.material.color.set(resting ? this.#palette.contact : this.#palette.footprint);
  }
}
