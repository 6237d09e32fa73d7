/** The way to the graphics card, or the reason why there is none. */

import { WebGLRenderer } from "three";

const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
/** A renderer, and how fine a picture of so many pixels of the page is, while things move and while they stand. */
export interface Drawing {
  readonly renderer: WebGLRenderer;
  readonly fineness: (pixels: number) => Fineness;
}

/** Pixels of the picture for one of the page, each way. */
export interface Fineness {
  readonly moving: number;
  readonly still: number;
}

/** As fine as the screens of phones are: finer ones are not told apart by eye. */
const FINEST = 3;
/** Pixels of a picture at most: those of a large screen of double density, which graphics cards fill with ease. */
const MOST = 8e6;
/** Pixels that a processor fills while things move: those of a phone's picture at double density. */
const MOST_BY_PROCESSOR = 4e5;
/** A processor draws no smooth edges: a standing picture has them by this fineness. */
const SMOOTH = 2;

export function finenessOf(pixels: number, screen: number, software: boolean): Fineness {
  const within = (most: number): number => Math.max(1, Math.min(screen, FINEST, Math.sqrt(most / pixels)));
  const still = within(MOST);
  return software ? { moving: within(MOST_BY_PROCESSOR), still: Math.max(SMOOTH, still) } : { moving: still, still };
}

/** Where the processor draws, each pixel costs: edges are smooth in pictures that stand only. */
export function newDrawing(): Drawing {
  const software = isSoftware();
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("webgl2", { antialias: !software, stencil: true, alpha: false });
  if (context === null) {
    throw new Error(
      "This browser cannot draw 3D (WebGL 2 is missing or switched off). Allow hardware acceleration, or use another browser",
    );
  }
  const renderer = new WebGLRenderer({ canvas, context });
  return { renderer, fineness: (pixels) => finenessOf(pixels, devicePixelRatio, software) };
}

function isSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  const software = names != null && SOFTWARE.test(String(context!.getParameter(names.UNMASKED_RENDERER_WEBGL)));
  context?.getExtension("WEBGL_lose_context")?.loseContext(); // a page has few of them
  return software;
}
