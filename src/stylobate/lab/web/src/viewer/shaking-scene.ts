/**
 * What is drawn: ground > plane (inclined) > base (displaced) > column.
 *
 * All of it is in metres with z up, x to the right and y away from the viewer, and at its true place: no tilt is enlarged.
 */

import { type BufferGeometry, Color, Group, type Material, type Mesh, Scene, Vector3 } from "three";
import { axisOf } from "./attitude";
import { ContactMark } from "./contact-mark";
import type { DrawnMotion, Triple } from "./drawn-motion";
import { type Extent, extentOf } from "./extent";
import { isFalling } from "./fall";
import { fadingGrid, gridOn } from "./grid";
import { TO_LIGHT } from "./lit-material";
import { momentAt, type Moment } from "./moment";
import type { Palette } from "./palette";
import { Rim } from "./rim";
import { RimVisits } from "./rim-visits";
import { Shadow } from "./shadow";
import { shaftMesh } from "./shaft";
import { ON_GROUND, ON_SLAB, slabMeshes, slabOutline, wall, wallMesh } from "./slab";
import { onRim } from "./touching";
import { floorPath, spacePath } from "./trail";

const SECTORS = 144; // of the rim
const CAST = 48; // points of a circle that cast a shadow
const JUMP = 0.8; // radii that the contact point goes at most between samples where it rolls
const FADED = 0.55; // of a column in a fall that was not computed
const MEMORY = 0.08; // of the duration, in which a path pales

type Path = ReturnType<typeof floorPath> | ReturnType<typeof spacePath>;

export class ShakingScene {
  readonly scene = new Scene();
  readonly column = new Group();
  readonly contact: ContactMark;
  readonly extent: Extent;
  /** Points that a camera must show. */
  readonly room: readonly Vector3[];
  /** Where a camera that goes with the motion has gone to. */
  readonly followed = new Vector3();

  readonly #plane = new Group();
  readonly #base = new Group();
  readonly #ground = new Group();
  readonly #shaft: ReturnType<typeof shaftMesh>;
  readonly #rim: Rim;
  readonly #paths: readonly Path[];
  readonly #shadows: { readonly slab: Shadow; readonly ground: Shadow; readonly slabOnGround: Shadow };
  readonly #outline: readonly (readonly [number, number])[];
  readonly #lightOnPlane: Vector3;
  readonly #level: number;

  constructor(
    readonly motion: DrawnMotion,
    palette: Palette,
  ) {
    this.extent = extentOf(motion);
    const { size, slab, spacing, thickness } = this.extent;
    const { incline, incline_direction } = motion.plane;
    // About the level line of the plane: the way down goes down.
    this.#plane.quaternion.setFromAxisAngle(
      new Vector3(-Math.sin(incline_direction), Math.cos(incline_direction), 0),
      incline,
    );
    this.#lightOnPlane = TO_LIGHT.clone().applyQuaternion(this.#plane.quaternion.clone().invert());
    this.scene.background = new Color(palette.background);

    this.#outline = slabOutline(slab, 0.6 * spacing);
    const grid = gridOn(slab, spacing, palette.slabLine);
    grid.renderOrder = 1;
    this.#base.add(...slabMeshes(this.#outline, thickness, palette), grid);

    const memory = Math.max(MEMORY * (motion.time.at(-1)! - motion.time[0]!), 1e-9);
    this.#rim = new Rim(motion.column, palette, new RimVisits(motion, SECTORS), memory);
    this.#shaft = shaftMesh(motion.column, palette);
    this.column.add(this.#shaft, this.#rim.mesh);
    this.contact = new ContactMark(motion.column, this.extent, palette);
    const paths = pathsOf(motion, size, memory, palette);
    this.#paths = paths;
    this.#base.add(...paths, this.contact.group, this.column);

    this.#level = this.#groundLevel();
    const reach = 2.2 * Math.hypot(slab[2] - slab[0], slab[3] - slab[1]);
    const lines = fadingGrid(
      [0.5 * (slab[0] + slab[2]), 0.5 * (slab[1] + slab[3])],
      reach,
      spacing,
      palette.groundLine,
    );
    this.#ground.position.z = this.#level;
    lines.renderOrder = 1; // over the shadows, which know the bare ground only
    this.#ground.add(lines);

    const [sharp, soft] = [0.004 * size, 0.4 * Math.min(motion.column.radius, motion.column.top_radius)];
    const ground = { stencil: ON_GROUND, bare: palette.background };
    this.#shadows = {
      slab: new Shadow(2 * CAST, { stencil: ON_SLAB }, sharp, soft, palette),
      ground: new Shadow(2 * CAST, ground, sharp, soft, palette),
      slabOnGround: new Shadow(2 * this.#outline.length, ground, 4 * sharp, 8 * sharp, palette),
    };
    this.#base.add(this.#shadows.slab.mesh);
    this.#shadows.slab.mesh.renderOrder = 4;
    this.#plane.add(this.#base);
    if (incline > 0) this.#addPedestal(palette);
    this.scene.add(this.#plane, this.#ground, this.#shadows.ground.mesh, this.#shadows.slabOnGround.mesh);
    this.room = this.#roomToShow();
  }

  /** Put everything where it is at `time`. */
  setTime(time: number): Moment {
    const moment = momentAt(this.motion, time);
    const [w, x, y, z] = moment.rotation;
    this.column.quaternion.set(x, y, z, w);
    this.column.position.set(...moment.centre);
    this.#base.position.set(...moment.base);
    this.contact.show(moment);
    this.#rim.setTime(time);
    this.#shaft.material.uniforms.faded!.value =
      isFalling(this.motion) && time > this.motion.computed_until ? FADED : 0;
    for (const path of this.#paths) path.material.uniforms.now!.value = time;
    this.#follow(moment);
    this.scene.updateMatrixWorld();
    this.#castShadows();
    return moment;
  }

  dispose(): void {
    this.scene.traverse((object) => {
      const { geometry, material } = object as Partial<Mesh<BufferGeometry, Material>>;
      geometry?.dispose();
      material?.dispose();
    });
  }

  /** Return the height of the ground: below the slab wherever the base takes it. */
  #groundLevel(): number {
    const { thickness, slab } = this.extent;
    const lowest = Math.min(0, ...this.motion.base.map(([, , z]) => z));
    const corners = [slab[0], slab[2]].flatMap((x) =>
      [slab[1], slab[3]].map((y) => new Vector3(x, y, lowest - 1.5 * thickness)),
    );
    return Math.min(...corners.map((corner) => corner.applyQuaternion(this.#plane.quaternion).z));
  }

  /** An inclined base slides on a block that is cut by its plane. */
  #addPedestal(palette: Palette): void {
    const { slab, thickness } = this.extent;
    const shrink = 0.6;
    const middle = [0.5 * (slab[0] + slab[2]), 0.5 * (slab[1] + slab[3])] as const;
    const feet = this.#outline.map(([x, y]) => {
      const at = new Vector3(
        middle[0] + shrink * (x - middle[0]),
        middle[1] + shrink * (y - middle[1]),
        -1.2 * thickness,
      );
      return at.applyQuaternion(this.#plane.quaternion);
    });
    const top = (x: number, y: number): number => feet.find((foot) => foot.x === x && foot.y === y)!.z;
    const block = wall(
      feet.map(({ x, y }) => [x, y] as const),
      top,
      () => this.#level,
      new Color(palette.slabSide),
    );
    this.scene.add(wallMesh(block, palette));
  }

  #follow({ base, footprint }: Moment): void {
    this.followed.set(0, 0, 0);
    if (this.extent.followsColumn) this.followed.add(new Vector3(footprint[0], footprint[1], 0));
    if (this.extent.followsBase) this.followed.add(new Vector3(...base));
    this.followed.applyQuaternion(this.#plane.quaternion);
    // The ground has no end: its lines go along by whole spacings.
    const { spacing } = this.extent;
    this.#ground.position.x = spacing * Math.round(this.followed.x / spacing);
    this.#ground.position.y = spacing * Math.round(this.followed.y / spacing);
  }

  #castShadows(): void {
    const circles = [
      ...this.#circle(this.motion.column.radius, 0),
      ...this.#circle(this.motion.column.top_radius, this.motion.column.height),
    ];
    this.#shadows.slab.cast(
      circles.map(({ x, y, z }): Triple => [x, y, z]),
      this.#lightOnPlane,
      0,
    );
    const inWorld = circles.map((point) => point.applyMatrix4(this.#base.matrixWorld).toArray());
    this.#shadows.ground.cast(inWorld, TO_LIGHT, this.#level);
    const { thickness } = this.extent;
    const corners = this.#outline.flatMap(([x, y]) =>
      [0, -thickness].map((z) => new Vector3(x, y, z).applyMatrix4(this.#base.matrixWorld).toArray()),
    );
    this.#shadows.slabOnGround.cast(corners, TO_LIGHT, this.#level);
  }

  /** Return points of a circle of the column, in the frame of the base. */
  #circle(radius: number, z: number): Vector3[] {
    return Array.from({ length: CAST }, (_, i) => {
      const angle = (2 * Math.PI * i) / CAST;
      return new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), z).applyMatrix4(this.column.matrix);
    });
  }

  #roomToShow(): Vector3[] {
    const { room, shake, size, thickness, followsColumn } = this.extent;
    const around = [-size, size]; // floor that a camera shows which goes with the column
    const shaken = (x: number, y: number, z: number): Vector3[] =>
      [-1, 1].map((side) => new Vector3(x + side * shake[0], y + side * shake[1], z + side * shake[2]));
    const box = [room.low, room.high].map((corner, i) =>
      corner.map((value, k) => value + (i === 0 ? -shake[k]! : shake[k]!)),
    );
    const corners = box.flatMap(([x]) => box.flatMap(([, y]) => box.map(([, , z]) => new Vector3(x, y, z))));
    const floor = followsColumn
      ? around.flatMap((x) => around.flatMap((y) => shaken(x, y, 0)))
      : this.#outline.flatMap(([x, y]) => shaken(x, y, -thickness));
    return [...corners, ...floor].map((point) => point.applyQuaternion(this.#plane.quaternion));
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
