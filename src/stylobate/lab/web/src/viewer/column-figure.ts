/** One column with what belongs to it alone: shaft, rim, mark and path of its contact, path of its top, shadows. */

import { type BufferGeometry, Group, type Mesh, type ShaderMaterial, Vector3 } from "three";
import { axisOf } from "./attitude";
import { ContactMark } from "./contact-mark";
import type { DrawnMotion, Triple } from "./drawn-motion";
import type { Extent } from "./extent";
import { computedUntil } from "./fall";
import { TO_LIGHT } from "./lit-material";
import { momentAt, type Moment } from "./moment";
import type { Palette } from "./palette";
import { Rim } from "./rim";
import { RimVisits } from "./rim-visits";
import { Shadow } from "./shadow";
import { shaftMesh } from "./shaft";
import { ON_GROUND, ON_SLAB } from "./slab";
import { onRim } from "./touching";
import { floorPath, spacePath } from "./trail";

const SECTORS = 144; // of the rim
const CAST = 48; // points of a circle that cast a shadow
const JUMP = 0.8; // radii that the contact point goes at most between samples where it rolls
const FADED = 0.55; // of a column after the end of its run
const MEMORY = 0.08; // of the duration, in which a path pales

type Path = ReturnType<typeof floorPath> | ReturnType<typeof spacePath>;

export class ColumnFigure {
  /** Stands on the base, where the column does. */
  readonly group = new Group();
  readonly column = new Group();
  readonly contact: ContactMark;
  /** On the slab, in the frame of the base, and on the ground. */
  readonly shadows: { readonly slab: Shadow; readonly ground: Shadow };
  readonly #shaft: Mesh<BufferGeometry, ShaderMaterial>;
  readonly #rim: Rim;
  readonly #paths: readonly Path[];

  /** @param place - of its origin on the base, along x [m] */
  constructor(
    readonly motion: DrawnMotion,
    extent: Extent,
    place: number,
    palette: Palette,
  ) {
    const { column, time } = motion;
    const memory = Math.max(MEMORY * (time.at(-1)! - time[0]!), 1e-9);
    this.#rim = new Rim(column, palette, new RimVisits(motion, SECTORS), memory);
    this.#shaft = shaftMesh(column, palette);
    this.column.add(this.#shaft, this.#rim.mesh);
    this.contact = new ContactMark(column, extent, palette);
    this.#paths = pathsOf(motion, extent.size, memory, palette);
    this.group.add(...this.#paths, this.contact.group, this.column);
    this.group.position.x = place;

    const [sharp, soft] = [0.004 * extent.size, 0.4 * Math.min(column.radius, column.top_radius)];
    const ground = { stencil: ON_GROUND, bare: palette.background };
    this.shadows = {
      slab: new Shadow(2 * CAST, { stencil: ON_SLAB }, sharp, soft, palette),
      ground: new Shadow(2 * CAST, ground, sharp, soft, palette),
    };
    this.shadows.slab.mesh.renderOrder = 4;
  }

  /** Put the column where it is at `time`, after the end of its run where that left it. */
  setTime(time: number): Moment {
    const moment = momentAt(this.motion, time);
    this.show(moment);
    this.#rim.setTime(time);
    this.#shaft.material.uniforms.faded!.value = time > computedUntil(this.motion) ? FADED : 0;
    for (const path of this.#paths) path.material.uniforms.now!.value = time;
    return moment;
  }

  show(moment: Moment): void {
    const [w, x, y, z] = moment.rotation;
    this.column.quaternion.set(x, y, z, w);
    this.column.position.set(...moment.centre);
    this.contact.show(moment);
  }

  /** Cast the shadows on the base, whose frame is `base`, and on the ground at this level. */
  castShadows(base: Group, lightOnBase: Vector3, level: number): void {
    const { radius, top_radius, height } = this.motion.column;
    const circles = [...this.circle(radius, 0), ...this.circle(top_radius, height)];
    this.shadows.slab.cast(
      circles.map(({ x, y, z }): Triple => [x, y, z]),
      lightOnBase,
      0,
    );
    const inWorld = circles.map((point) => point.applyMatrix4(base.matrixWorld).toArray());
    this.shadows.ground.cast(inWorld, TO_LIGHT, level);
  }

  /** Return points of a circle of the column, in the frame of the base. */
  circle(radius: number, z: number): Vector3[] {
    this.column.updateMatrix();
    return Array.from({ length: CAST }, (_, i) => {
      const angle = (2 * Math.PI * i) / CAST;
      const point = new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), z);
      return point.applyMatrix4(this.column.matrix).add(this.group.position);
    });
  }
}

/** Return the paths of the contact point on the floor and of the tip of the axis. */
function pathsOf(motion: DrawnMotion, size: number, memory: number, palette: Palette): Path[] {
  const rolls = (i: number): boolean =>
    onRim(motion, i) && onRim(motion, i + 1) && gap(motion, i) < JUMP * motion.column.radius;
  const floor = floorPath(motion.time, motion.contact_point, rolls, {
    width: 0.014 * size,
    recent: palette.contact,
    past: palette.contactOld,
    memory,
  });
  floor.renderOrder = 5;
  const tip = spacePath(
    motion.time,
    motion.time.map((_, i) => tipAt(motion, i)),
    { recent: palette.tip, past: palette.tipOld, memory },
  );
  tip.renderOrder = 6;
  return [floor, tip];
}

function gap({ contact_point }: DrawnMotion, i: number): number {
  const [a, b] = [contact_point[i]!, contact_point[i + 1]!];
  return Math.hypot(b[0] - a[0], b[1] - a[1]);
}

function tipAt({ rotation, centre, column }: DrawnMotion, i: number): Triple {
  const [x, y, z] = centre[i]!;
  const [ax, ay, az] = axisOf(rotation[i]!);
  return [x + column.height * ax, y + column.height * ay, z + column.height * az];
}
