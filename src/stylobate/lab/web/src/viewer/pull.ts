/** A column pulled by hand: a pointer that goes down on it leans it, and lets it go from rest. */

import { type PerspectiveCamera, Vector3 } from "three";
import type { Pair } from "./drawn-motion";
import { convexHull } from "./shadow";

/** What hears of a pull. */
export interface PullHearing {
  /** Whether the column rocks along x only. */
  readonly alongX: () => boolean;
  readonly begun: () => void;
  /** It was let go where it was taken, or the pull was broken off. */
  readonly dropped: () => void;
  /** It was let go at this tilt [rad]. */
  readonly released: (tilt: Pair) => void;
}

/** A column as a hand takes it. */
export interface Grip {
  /** Points round it, in the world. */
  readonly outline: readonly Vector3[];
  readonly foot: Vector3;
  readonly top: Vector3;
  readonly tilt: Pair;
}

/** What is pulled, and how it is seen. */
export interface Pulled {
  readonly canvas: HTMLCanvasElement;
  readonly camera: PerspectiveCamera;
  readonly grips: () => readonly Grip[];
  /** Largest tilt to which a hand leans the columns [rad]. */
  readonly limit: () => number;
  readonly lean: (tilt: Pair) => void;
}

const [NEAR_MOUSE, NEAR_FINGER] = [4, 14]; // px beside a column that count as on it
const TREMOR = 3; // px that a hand moves which does not pull
const LOWEST_HOLD = 0.3; // of the height of a column: below, a hand would lean it too fast
const FLATTEST = 0.3; // sine of the elevation of the camera: below, a way up the screen would go too far

/** Return the way on the base of a way on the screen, x to the right and y down, with the screen's right on the base. */
export function wayOnBase([x, y]: Pair, [rightX, rightY]: Pair, sineOfElevation: number): Pair {
  const away = -y / Math.max(sineOfElevation, FLATTEST);
  return [x * rightX - away * rightY, x * rightY + away * rightX];
}

/** Return the tilt of a column that leant by `from` and whose point at a `height` was pulled by `way`, up to a limit. */
export function pulledTilt(from: Pair, way: Pair, height: number, limit: number, alongX: boolean): Pair {
  const x = from[0] + way[0] / height;
  const y = alongX ? 0 : from[1] + way[1] / height;
  const size = Math.hypot(x, y);
  const factor = size > limit ? limit / size : 1;
  return [factor * x, factor * y];
}

/** Return whether a point lies in the convex hull of others, or at most so far beside it. */
export function isNear(points: readonly Pair[], [x, y]: Pair, margin: number): boolean {
  const hull = convexHull(points.map(([px, py]) => ({ x: px, y: py, height: 0 })));
  if (hull.length < 3) return false;
  return hull.every((a, i) => {
    const b = hull[(i + 1) % hull.length]!;
    const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
    return ((x - a.x) * (b.y - a.y) - (y - a.y) * (b.x - a.x)) / length <= margin;
  });
}

interface Hold {
  readonly pointer: number;
  readonly at: Pair;
  readonly from: Pair;
  /** Height of the point that is held [m], and metres of a pixel there. */
  readonly height: number;
  readonly pixel: number;
  tilt: Pair | null;
}

export class Pull {
  readonly #pulled: Pulled;
  readonly #hearing: PullHearing;
  #hold: Hold | null = null;

  constructor(pulled: Pulled, hearing: PullHearing) {
    this.#pulled = pulled;
    this.#hearing = hearing;
    const { canvas } = pulled;
    // Before those who turn the view: a pointer on the column does not.
    canvas.addEventListener("pointerdown", this.#down, { capture: true });
    canvas.addEventListener("pointermove", this.#move, { capture: true });
    canvas.addEventListener("pointerup", this.#up, { capture: true });
    canvas.addEventListener("pointercancel", this.#broken, { capture: true });
  }

  dispose(): void {
    const { canvas } = this.#pulled;
    canvas.removeEventListener("pointerdown", this.#down, { capture: true });
    canvas.removeEventListener("pointermove", this.#move, { capture: true });
    canvas.removeEventListener("pointerup", this.#up, { capture: true });
    canvas.removeEventListener("pointercancel", this.#broken, { capture: true });
  }

  readonly #down = (event: PointerEvent): void => {
    if (event.button !== 0 || this.#hold !== null) return;
    const at = this.#placeOf(event);
    const grip = this.#gripAt(at, event.pointerType === "touch" ? NEAR_FINGER : NEAR_MOUSE);
    if (grip === undefined) return;
    event.stopImmediatePropagation();
    const { canvas } = this.#pulled;
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    canvas.style.cursor = "grabbing";
    this.#hold = { pointer: event.pointerId, at, from: grip.tilt, ...this.#heldAt(grip, at), tilt: null };
    this.#hearing.begun();
  };

  readonly #move = (event: PointerEvent): void => {
    const hold = this.#hold;
    if (hold === null) {
      if (event.buttons === 0) this.#pulled.canvas.style.cursor = this.#over(event) ? "grab" : "";
      return;
    }
    event.stopImmediatePropagation();
    if (event.pointerId !== hold.pointer) return;
    const [x, y] = this.#placeOf(event);
    const moved: Pair = [x - hold.at[0], y - hold.at[1]];
    if (hold.tilt === null && Math.hypot(...moved) < TREMOR) return;
    const { camera, limit, lean } = this.#pulled;
    const right = new Vector3(1, 0, 0).applyQuaternion(camera.quaternion);
    const back = new Vector3(0, 0, 1).applyQuaternion(camera.quaternion);
    const way = wayOnBase([moved[0] * hold.pixel, moved[1] * hold.pixel], [right.x, right.y], back.z);
    hold.tilt = pulledTilt(hold.from, way, hold.height, limit(), this.#hearing.alongX());
    lean(hold.tilt);
  };

  readonly #up = (event: PointerEvent): void => {
    if (this.#hold?.pointer !== event.pointerId) return;
    const { tilt } = this.#hold;
    event.stopImmediatePropagation();
    this.#letGo();
    if (tilt === null) this.#hearing.dropped();
    else this.#hearing.released(tilt);
  };

  readonly #broken = (event: PointerEvent): void => {
    if (this.#hold?.pointer !== event.pointerId) return;
    this.#letGo();
    this.#hearing.dropped();
  };

  #letGo(): void {
    this.#hold = null;
    this.#pulled.canvas.style.cursor = "";
  }

  #over(event: PointerEvent): boolean {
    return this.#gripAt(this.#placeOf(event), NEAR_MOUSE) !== undefined;
  }

  #gripAt(at: Pair, margin: number): Grip | undefined {
    return this.#pulled.grips().find(({ outline }) => {
      const seen = outline.map((point) => this.#onScreen(point));
      return isNear(seen, at, margin);
    });
  }

  #heldAt({ foot, top }: Grip, [x, y]: Pair): Pick<Hold, "height" | "pixel"> {
    const { camera, canvas } = this.#pulled;
    const [[fx, fy], [tx, ty]] = [this.#onScreen(foot), this.#onScreen(top)];
    const along = ((x - fx) * (tx - fx) + (y - fy) * (ty - fy)) / ((tx - fx) ** 2 + (ty - fy) ** 2 || 1);
    const share = Math.min(Math.max(along, LOWEST_HOLD), 1);
    const depth = -foot.clone().lerp(top, share).applyMatrix4(camera.matrixWorldInverse).z;
    const pixel = (2 * depth * Math.tan((camera.fov * Math.PI) / 360)) / canvas.clientHeight;
    return { height: share * foot.distanceTo(top), pixel };
  }

  #placeOf({ clientX, clientY }: { readonly clientX: number; readonly clientY: number }): Pair {
    const { left, top } = this.#pulled.canvas.getBoundingClientRect();
    return [clientX - left, clientY - top];
  }

  #onScreen(point: Vector3): Pair {
    const { camera, canvas } = this.#pulled;
    const { x, y } = point.clone().project(camera);
    return [(0.5 + 0.5 * x) * canvas.clientWidth, (0.5 - 0.5 * y) * canvas.clientHeight];
  }
}
