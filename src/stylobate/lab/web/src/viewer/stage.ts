/** A motion drawn in 3D in an element of a page; what is drawn is what was computed, and can be read back. */

import { type Quaternion, Vector3 } from "three";
import { spinBetween, tiltOf, twistOf } from "./attitude";
import { type Beside, drawable, type DrawnMotion, type Pair, type Rotation, type Triple } from "./drawn-motion";
import { azimuthAtEnd, isFalling } from "./fall";
import { FigureLabels } from "./figure-labels";
import { FrameTimes } from "./frame-times";
import { Look } from "./look";
import { momentAt, placeOf } from "./moment";
import { noteElement, noteOn, paintNote } from "./note";
import { paletteOf, preferredTheme, type Theme } from "./palette";
import { Pull, type PullHearing } from "./pull";
import { type Fineness, newDrawing } from "./renderer";
import { ShakingScene } from "./shaking-scene";

export interface StageOptions {
  readonly theme?: Theme;
}

/** The column as it is drawn, in the frame of the base. */
export interface Pose {
  readonly tilt: Pair;
  readonly contact: Pair;
  readonly twist: number;
  /** Rate about its own axis [rad/s] between drawn poses; null where the model knows none. */
  readonly spin: number | null;
  readonly centre: Triple;
}

const STILL = 300; // ms without a change, after which a picture is drawn finely
const SLIM = 2; // height over width from which one looks from lower down

export class Stage {
  readonly #frame = document.createElement("div");
  readonly #note = noteElement();
  readonly #labels = new FigureLabels(this.#frame);
  readonly #drawing = newDrawing();
  readonly #look: Look;
  readonly #frames = new FrameTimes();
  readonly #watch: ResizeObserver;
  #theme: Theme;
  #drawn: ShakingScene | null = null;
  #beside: Beside | null = null;
  readonly #past: ShakingScene[] = [];
  #time = 0;
  #unit = "m";
  #pull: Pull | null = null;
  #waiting: number | null = null;
  #settling: number | null = null;

  /**
   * @param host - element that the picture fills
   * @throws Error if the browser draws no 3D
   */
  constructor(
    readonly host: HTMLElement,
    options: StageOptions = {},
  ) {
    this.#theme = options.theme ?? preferredTheme();
    this.#look = new Look(this.canvas, () => this.#request());
    Object.assign(this.#frame.style, { position: "relative", width: "100%", height: "100%", overflow: "hidden" });
    Object.assign(this.canvas.style, { position: "absolute", inset: "0" });
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.#name("No motion yet.");
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault()); // it is given back
    this.canvas.addEventListener("webglcontextrestored", () => this.#request());
    this.#frame.append(this.canvas, this.#note);
    host.append(this.#frame);
    this.#watch = new ResizeObserver(() => this.resize());
    this.#watch.observe(this.#frame);
    this.resize();
  }

  get canvas(): HTMLCanvasElement {
    return this.#drawing.renderer.domElement;
  }

  get time(): number {
    return this.#time;
  }

  /** Draw another motion, its lengths in this unit, alone or beside another; the view stays if the columns do. */
  show(motion: DrawnMotion, unit = "m", beside: Beside | null = null): void {
    this.#unit = unit;
    const [before, besideBefore] = [this.#drawn?.motion, this.#beside];
    this.#beside = beside;
    this.#build(drawable(motion));
    if (before === undefined || bodies(before, besideBefore) !== bodies(motion, beside)) this.resetCamera();
    else if (viewOn(before, besideBefore) !== viewOn(motion, beside)) this.#lookAt(this.#drawn!);
    const both = beside === null ? "" : `Two columns side by side: ${beside.labels.join("; ")}. `;
    this.#name(
      `${both}${motion.title.replace(/([^.!?])$/, "$1.")} Arrow keys turn the view, plus and minus zoom, Home resets the view.`,
    );
  }

  setTime(time: number): void {
    this.#time = time;
    if (this.#drawn === null) return;
    this.#drawn.setTime(time);
    this.#look.follow(this.#drawn.followed);
    this.#request();
  }

  /** Let the columns be pulled by hand; a pull lasts in the picture until the time is set. */
  allowPull(hearing: PullHearing): void {
    this.#pull = new Pull(
      {
        canvas: this.canvas,
        camera: this.#look.camera,
        grips: () => this.#drawn?.grips() ?? [],
        limit: () => this.#showing().pullLimit,
        lean: (tilt) => {
          this.#showing().lean(this.#time, tilt);
          this.#request();
        },
      },
      hearing,
    );
  }

  /** Read the pose back from what is drawn: of the column, or with 1 of that beside it. */
  pose(which = 0): Pose {
    const figure = this.#showing().figures[which];
    if (figure === undefined) throw new Error(`there is no column number ${which}: draw one beside the first`);
    const rotation = rotationOf(figure.column.quaternion);
    const { contact, motion } = figure;
    return {
      tilt: tiltOf(rotation),
      contact: [contact.point.position.x, contact.point.position.y],
      twist: twistOf(rotation, momentAt(motion, this.#time).twist),
      spin: motion.spin === null ? null : spinAt(motion, this.#time),
      centre: figure.column.position.toArray(),
    };
  }

  setTheme(theme: Theme): void {
    if (theme === this.#theme) return;
    this.#theme = theme;
    if (this.#drawn !== null) this.#build(this.#drawn.motion);
  }

  /** Look again from the front, at all of it. */
  resetCamera(): void {
    if (this.#drawn !== null) this.#lookAt(this.#drawn);
    this.#look.reset();
  }

  /** Show all of a scene from the side that suits it, unless the reader looks from another. */
  #lookAt({ motion, room }: ShakingScene): void {
    const { column } = motion;
    const slim = column.height > SLIM * 2 * Math.max(column.radius, column.top_radius);
    const [x, y] = directionOf(viewOn(motion, this.#beside));
    this.#look.show(room, new Vector3(x, y, slim ? 0.36 : 0.52));
    this.#request();
  }

  resize(): void {
    const { clientWidth, clientHeight } = this.#frame;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.#drawing.renderer.setSize(clientWidth, clientHeight);
    this.#look.resize(clientWidth, clientHeight);
    this.#draw(this.#fineness.moving); // at once: a canvas that changes its size is empty
    this.#settle();
  }

  /** Return the picture as it stands, with what is written on it. */
  async png(): Promise<Blob> {
    const drawn = this.#showing();
    const { still } = this.#fineness;
    this.#draw(still);
    const copy = document.createElement("canvas");
    copy.width = this.canvas.width;
    copy.height = this.canvas.height;
    const context = copy.getContext("2d");
    if (context === null)
      throw new Error("This browser cannot save the canvas as a picture. Take a screenshot instead");
    context.drawImage(this.canvas, 0, 0);
    paintNote(context, noteOn(drawn.motion, drawn.extent.spacing, this.#unit), paletteOf(this.#theme).ink, still);
    this.#labels.paint(context);
    return new Promise((done, failed) => {
      copy.toBlob(
        (blob) => (blob === null ? failed(new Error("The browser could not write the picture as PNG")) : done(blob)),
        "image/png",
      );
    });
  }

  /** Median rate of the last pictures drawn while something moved [1/s]. */
  frameRate(): number {
    return this.#frames.rate();
  }

  dispose(): void {
    if (this.#waiting !== null) cancelAnimationFrame(this.#waiting);
    if (this.#settling !== null) clearTimeout(this.#settling);
    this.#watch.disconnect();
    this.#pull?.dispose();
    this.#look.dispose();
    for (const scene of this.#past.splice(0)) scene.dispose();
    this.#drawn?.dispose();
    this.#drawn = null;
    this.#drawing.renderer.dispose();
    this.#drawing.renderer.forceContextLoss();
    this.#frame.remove();
  }

  #build(motion: DrawnMotion): void {
    if (this.#drawn !== null) this.#past.push(this.#drawn);
    const palette = paletteOf(this.#theme);
    const beside = this.#beside;
    this.#drawn = new ShakingScene(motion, palette, beside && drawable(beside.motion));
    this.#labels.show(beside?.labels ?? [], this.#drawn.labelPlaces(), palette);
    this.#note.textContent = noteOn(motion, this.#drawn.extent.spacing, this.#unit);
    this.#note.style.color = palette.ink;
    const end = Math.max(motion.time.at(-1)!, beside?.motion.time.at(-1) ?? 0);
    this.#time = Math.min(end, Math.max(motion.time[0]!, this.#time));
    this.setTime(this.#time);
  }

  get #fineness(): Fineness {
    return this.#drawing.fineness(this.#frame.clientWidth * this.#frame.clientHeight);
  }

  #showing(): ShakingScene {
    if (this.#drawn === null) throw new Error("nothing is shown yet: call show(motion) first");
    return this.#drawn;
  }

  #name(text: string): void {
    this.canvas.setAttribute("aria-label", text);
  }

  /** Draw with the next frame of the screen, however much changes until then. */
  #request(): void {
    this.#waiting ??= requestAnimationFrame((now) => {
      this.#waiting = null;
      this.#frames.add(now);
      this.#draw(this.#fineness.moving);
      this.#settle();
    });
  }

  /** Draw finely once nothing changes any more. */
  #settle(): void {
    const { moving, still } = this.#fineness;
    if (this.#settling !== null) clearTimeout(this.#settling);
    this.#settling = moving === still ? null : window.setTimeout(() => this.#draw(still), STILL);
  }

  #draw(fineness: number): void {
    const { renderer } = this.#drawing;
    if (renderer.getPixelRatio() !== fineness) renderer.setPixelRatio(fineness);
    if (this.#drawn !== null) {
      renderer.render(this.#drawn.scene, this.#look.camera);
      this.#labels.follow(this.#look.camera, this.#drawn.followed, {
        width: this.#frame.clientWidth,
        height: this.#frame.clientHeight,
      });
      // Only now: until the new scene is drawn the old one keeps the compiled shaders they share.
      for (const scene of this.#past.splice(0)) scene.dispose();
    } else {
      renderer.setClearColor(paletteOf(this.#theme).background);
      renderer.clear();
    }
  }
}

const FRONT = -1; // the view from the front
const VIEWS = 8; // round the column, from which a fall is seen

/** Return the view that a motion is seen from: across its fall, on the viewer's side, or from the front. */
function viewOn(motion: DrawnMotion, beside: Beside | null): number {
  if (beside !== null || !isFalling(motion)) return FRONT;
  const across = azimuthAtEnd(motion) + Math.PI / 2;
  const view = Math.round((across * VIEWS) / (2 * Math.PI));
  const behind = Math.sin((2 * Math.PI * view) / VIEWS) > 1e-9;
  return (((view + (behind ? VIEWS / 2 : 0)) % VIEWS) + VIEWS) % VIEWS;
}

function directionOf(view: number): readonly [number, number] {
  const angle = (2 * Math.PI * view) / VIEWS;
  return view === FRONT ? [0.28, -1] : [Math.cos(angle), Math.sin(angle)];
}

function rotationOf({ w, x, y, z }: Quaternion): Rotation {
  return [w, x, y, z];
}

/** Return the spin of the column as it is drawn: about `time`, over one step of the samples. */
function spinAt(motion: DrawnMotion, time: number): number {
  const last = motion.time.length - 1;
  if (last === 0) return 0;
  const index = Math.min(placeOf(motion.time, time).index, last - 1);
  const half = 0.5 * (motion.time[index + 1]! - motion.time[index]!);
  const from = Math.max(motion.time[0]!, time - half);
  const to = Math.min(motion.time[last]!, time + half);
  return spinBetween(momentAt(motion, from).rotation, momentAt(motion, to).rotation, to - from);
}

/** Return the bodies that are drawn, and the plane they stand on, as they are written. */
function bodies({ column, plane }: DrawnMotion, beside: Beside | null): string {
  const drawn = beside === null ? [column] : [column, beside.motion.column];
  const sizes = drawn.map(({ radius, top_radius, height }) => [radius, top_radius, height]);
  return JSON.stringify([sizes, plane.incline, plane.incline_direction]);
}
