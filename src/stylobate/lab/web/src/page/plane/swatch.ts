/** A small piece of a look, for legends. */

import { element } from "../frame/dom";
import type { Look } from "./looks";
import { rgbOf } from "./looks";

const [WIDTH, HEIGHT] = [18, 12];

export function swatch(look: Look): HTMLCanvasElement {
  const canvas = element("canvas", { class: "swatch", width: WIDTH, height: HEIGHT, "aria-hidden": "true" });
  const pen = canvas.getContext("2d");
  if (pen === null) return canvas;
  const image = pen.createImageData(WIDTH, HEIGHT);
  const [colour, ink] = [rgbOf(look.colour), rgbOf(look.ink)];
  for (let y = 0; y < HEIGHT; y += 1) {
    for (let x = 0; x < WIDTH; x += 1) {
      image.data.set([...(look.texture?.(x, y) ? ink : colour), 255], 4 * (y * WIDTH + x));
    }
  }
  pen.putImageData(image, 0, 0);
  return canvas;
}
