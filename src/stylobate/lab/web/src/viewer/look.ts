/** Where one looks from: moved by mouse, touch and keys; a page can still be scrolled past the picture. */

import { MOUSE, PerspectiveCamera, Spherical, TOUCH, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const MARGIN = 1.08; // beside the points that are seen
const ROUNDS = 4; // of moving to the middle and stepping back

/** Turn `camera` to look along −`direction` at all `points`; return what it looks at. */
export function frame(camera: PerspectiveCamera, points: readonly Vector3[], direction: Vector3): Vector3 {
  const back = direction.clone().normalize();
  const right = new Vector3(0, 0, 1).cross(back).normalize();
  const up = back.clone().cross(right);
  const high = Math.tan((camera.fov * Math.PI) / 360) / MARGIN;
  const wide = high * camera.aspect;

  const target = new Vector3();
  let distance = 0;
  for (let round = 0; round < ROUNDS; round += 1) {
    const seen = points.map((point) => {
      const from = point.clone().sub(target);
      return { x: from.dot(right), y: from.dot(up), z: from.dot(back) };
    });
    distance = Math.max(...seen.map(({ x, y, z }) => z + Math.max(Math.abs(x) / wide, Math.abs(y) / high)));
    const across = seen.map(({ x, z }) => x / (distance - z));
    const along = seen.map(({ y, z }) => y / (distance - z));
    target.addScaledVector(right, 0.5 * distance * (Math.max(...across) + Math.min(...across)));
    target.addScaledVector(up, 0.5 * distance * (Math.max(...along) + Math.min(...along)));
  }
  camera.position.copy(target).addScaledVector(back, distance);
  camera.near = 0.02 * distance;
  camera.far = 20 * distance;
  camera.updateProjectionMatrix();
  return target;
}

const FIELD = 28; // degrees: little perspective
const STEP = Math.PI / 36; // of a key
const NEARER = 0.88; // distance after a key over that before
const LOWEST = 0.52 * Math.PI; // polar angle: a little from below, to see that the base lifts

export class Look {
  readonly camera = new PerspectiveCamera(FIELD, 1, 0.01, 100);
  readonly #controls: OrbitControls;
  readonly #canvas: HTMLCanvasElement;
  #points: readonly Vector3[] = [];
  #direction = new Vector3(0, -1, 0.3);
  readonly #followed = new Vector3();
  #moved = false;

  constructor(canvas: HTMLCanvasElement, changed: () => void) {
    this.#canvas = canvas;
    this.camera.up.set(0, 0, 1);
    this.#controls = new OrbitControls(this.camera, canvas);
    this.#controls.maxPolarAngle = LOWEST;
    this.#controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    this.#controls.touches = { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_ROTATE };
    canvas.style.touchAction = "pan-y"; // a finger that goes up or down scrolls the page
    this.#controls.addEventListener("change", changed);
    this.#controls.addEventListener("start", () => {
      this.#moved = true;
    });
    canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
    canvas.addEventListener("keydown", this.#key);
    canvas.addEventListener("wheel", this.#wheel, { capture: true });
  }

  /** Show all `points`, from this `direction` unless the user looks from another. */
  show(points: readonly Vector3[], direction: Vector3): void {
    this.#points = points;
    this.#direction = direction;
    if (!this.#moved) this.#frame(direction);
  }

  reset(): void {
    this.#moved = false;
    this.#frame(this.#direction);
  }

  resize(width: number, height: number): void {
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.#moved) this.#frame(this.#direction);
  }

  /** Go along with what has gone `to` there from where the points to show are. */
  follow(to: Vector3): void {
    if (this.#followed.equals(to)) return;
    const way = to.clone().sub(this.#followed);
    this.#followed.copy(to);
    this.camera.position.add(way);
    this.#controls.target.add(way);
    this.#controls.update();
  }

  dispose(): void {
    this.#controls.dispose();
    this.#canvas.removeEventListener("keydown", this.#key);
    this.#canvas.removeEventListener("wheel", this.#wheel, { capture: true });
  }

  #frame(direction: Vector3): void {
    if (this.#points.length === 0) return;
    this.#controls.target.copy(frame(this.camera, this.#points, direction)).add(this.#followed);
    this.camera.position.add(this.#followed);
    const distance = this.camera.position.distanceTo(this.#controls.target);
    this.#controls.minDistance = 0.1 * distance;
    this.#controls.maxDistance = 5 * distance;
    this.#controls.update();
  }

  readonly #key = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const turn: Record<string, () => void> = {
      ArrowLeft: () => this.#turn(-STEP, 0, 1),
      ArrowRight: () => this.#turn(STEP, 0, 1),
      ArrowUp: () => this.#turn(0, -STEP, 1),
      ArrowDown: () => this.#turn(0, STEP, 1),
      "+": () => this.#turn(0, 0, NEARER),
      "=": () => this.#turn(0, 0, NEARER),
      "-": () => this.#turn(0, 0, 1 / NEARER),
      Home: () => this.reset(),
    };
    const action = turn[event.key];
    if (action === undefined) return;
    action();
    event.preventDefault();
    event.stopPropagation();
  };

  /** Turn about the vertical, up or down, and go nearer or back. */
  #turn(about: number, down: number, scale: number): void {
    if (about !== 0 || down !== 0 || scale !== 1) this.#moved = true;
    const { target, minDistance, maxDistance } = this.#controls;
    const from = this.camera.position.clone().sub(target);
    // Spherical counts from y; here up is z.
    const place = new Spherical().setFromCartesianCoords(from.x, from.z, -from.y);
    place.theta += about;
    place.phi = Math.min(LOWEST, Math.max(0.02, place.phi + down));
    place.radius = Math.min(maxDistance, Math.max(minDistance, place.radius * scale));
    const to = new Vector3().setFromSpherical(place);
    this.camera.position.copy(target).add(new Vector3(to.x, -to.z, to.y));
    this.#controls.update();
  }

  /** A wheel over a picture that nobody has turned to scrolls the page. */
  readonly #wheel = (event: WheelEvent): void => {
    if (document.activeElement !== this.#canvas && !event.ctrlKey) event.stopImmediatePropagation();
  };
}
