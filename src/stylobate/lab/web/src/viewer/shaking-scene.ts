/**
 * What is drawn: ground > plane (inclined) > base (displaced) > column.
 *
 * All of it is in metres with z up, x to the right and y away from the viewer, and at its true place: no tilt is enlarged.
 */

import { type BufferGeometry, Color, Group, type Material, type Mesh, Scene, Vector3 } from "three";
import { tiltOf } from "./attitude";
import { ColumnFigure } from "./column-figure";
import type { DrawnMotion, Pair, Triple } from "./drawn-motion";
import { type Extent, extentBeside, extentOf } from "./extent";
import { computedUntil } from "./fall";
import { fadingGrid, gridOn } from "./grid";
import { TO_LIGHT } from "./lit-material";
import { leaningMoment, momentAt, type Moment } from "./moment";
import type { Palette } from "./palette";
import type { Grip } from "./pull";
import { Shadow } from "./shadow";
import { ON_GROUND, slabMeshes, slabOutline, wall, wallMesh } from "./slab";

const PULLED = 0.95; // of the tilt of no return, to which a hand leans a column at most

export class ShakingScene {
  readonly scene = new Scene();
  /** The column, and a second one beside it. */
  readonly figures: readonly ColumnFigure[];
  readonly extent: Extent;
  /** Points that a camera must show. */
  readonly room: readonly Vector3[];
  /** Where a camera that goes with the motion has gone to. */
  readonly followed = new Vector3();

  readonly #plane = new Group();
  readonly #base = new Group();
  readonly #ground = new Group();
  readonly #slabShadow: Shadow;
  readonly #outline: readonly (readonly [number, number])[];
  readonly #lightOnPlane: Vector3;
  readonly #level: number;

  constructor(
    readonly motion: DrawnMotion,
    palette: Palette,
    beside: DrawnMotion | null = null,
  ) {
    const { extent, place } =
      beside === null ? { extent: extentOf(motion), place: 0 } : extentBeside(extentOf(motion), extentOf(beside));
    this.extent = extent;
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

    const motions = beside === null ? [motion] : [motion, beside];
    this.figures = motions.map((one, i) => new ColumnFigure(one, extentOf(one), i * place, palette));
    for (const { group, shadows } of this.figures) this.#base.add(group, shadows.slab.mesh);

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

    const sharp = 0.016 * size;
    const ground = { stencil: ON_GROUND, bare: palette.background };
    this.#slabShadow = new Shadow(2 * this.#outline.length, ground, sharp, 2 * sharp, palette);
    this.#plane.add(this.#base);
    if (incline > 0) this.#addPedestal(palette);
    this.scene.add(
      this.#plane,
      this.#ground,
      this.#slabShadow.mesh,
      ...this.figures.map((one) => one.shadows.ground.mesh),
    );
    this.room = this.#roomToShow();
  }

  /** Put everything where it is at `time`. */
  setTime(time: number): void {
    const [moment] = this.figures.map((one) => one.setTime(time));
    const base = this.#baseAt(time);
    this.#base.position.set(...base);
    this.#follow(moment!, base);
    this.#settle();
  }

  /** Lean all columns by this tilt, on the rim of the circles on which they stand at `time`. */
  lean(time: number, tilt: Pair): void {
    for (const one of this.figures) one.show(leaningMoment(one.motion, time, tilt));
    this.#settle();
  }

  /** Return where the base is: as long as a run lasts that computed it. */
  #baseAt(time: number): Triple {
    const motions = this.figures.map((one) => one.motion);
    const longest = motions.reduce((a, b) => (computedUntil(b) > computedUntil(a) ? b : a));
    return momentAt(motions.find((one) => time <= computedUntil(one)) ?? longest, time).base;
  }

  #settle(): void {
    this.scene.updateMatrixWorld();
    this.#castShadows();
  }

  /** Return the columns as a hand takes them. */
  grips(): readonly Grip[] {
    return this.figures.map((one) => {
      const { radius, top_radius, height } = one.motion.column;
      const inWorld = (point: Vector3): Vector3 => point.applyMatrix4(this.#base.matrixWorld);
      const { w, x, y, z } = one.column.quaternion;
      return {
        outline: [...one.circle(radius, 0), ...one.circle(top_radius, height)].map(inWorld),
        foot: new Vector3().setFromMatrixPosition(one.column.matrixWorld),
        top: new Vector3(0, 0, height).applyMatrix4(one.column.matrixWorld),
        tilt: tiltOf([w, x, y, z]),
      };
    });
  }

  /** Return the largest tilt to which a hand leans the columns: short of that at which one would fall [rad]. */
  get pullLimit(): number {
    const { incline } = this.motion.plane;
    const least = Math.min(...this.figures.map(({ motion }) => Math.atan(motion.column.slenderness)));
    return PULLED * Math.max(least - incline, 0);
  }

  /** Return the points of the ground's frame below which words about the columns stand, at the front edge of the base. */
  labelPlaces(): Vector3[] {
    const { slab, thickness, followsColumn, size } = this.extent;
    const front = followsColumn ? -size : slab[1];
    return this.figures.map(({ group }) =>
      new Vector3(group.position.x, front, -thickness).applyQuaternion(this.#plane.quaternion),
    );
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

  #follow({ footprint }: Moment, base: Triple): void {
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
    for (const one of this.figures) one.castShadows(this.#base, this.#lightOnPlane, this.#level);
    const { thickness } = this.extent;
    const corners = this.#outline.flatMap(([x, y]) =>
      [0, -thickness].map((z) => new Vector3(x, y, z).applyMatrix4(this.#base.matrixWorld).toArray()),
    );
    this.#slabShadow.cast(corners, TO_LIGHT, this.#level);
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
