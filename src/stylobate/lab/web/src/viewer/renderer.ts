/** The way to the graphics card, or the reason why there is none. */

import { WebGLRenderer } from "three";

const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
const FINEST = 2; // pixels of the picture for one of the page, each way, at most

/** A renderer, and how fine its pictures are while things move and while they stand. */
export interface Drawing {
  readonly renderer: WebGLRenderer;
  readonly moving: number;
  readonly still: number;
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
  const fine = Math.min(devicePixelRatio, FINEST);
  return software ? { renderer, moving: 1, still: FINEST } : { renderer, moving: fine, still: fine };
}

function isSoftware(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  const names = context?.getExtension("WEBGL_debug_renderer_info");
  const software = names != null && SOFTWARE.test(String(context!.getParameter(names.UNMASKED_RENDERER_WEBGL)));
  context?.getExtension("WEBGL_lose_context")?.loseContext(); // a page has few of them
  return software;
}
