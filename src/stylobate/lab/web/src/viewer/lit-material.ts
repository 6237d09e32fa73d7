/** Matt stone in sun and sky, lit at the corners of its faces: on a processor that draws, every pixel costs. */

import { Color, ShaderMaterial, type ShaderMaterialParameters, Vector3 } from "three";
import type { Palette } from "./palette";

/** Where the sun stands, in the world: above, to the left, on the viewer's side. */
export const TO_LIGHT = new Vector3(-0.5, -0.55, 0.95).normalize();

const VERTEX = /* glsl */ `
  attribute vec3 color;
  uniform vec3 toLight;
  uniform float sun;
  uniform float sky;
  uniform float earth;
  varying vec3 shade;
  void main() {
    vec3 facing = normalize(mat3(modelMatrix) * normal);
    float lit = sun * max(0.0, dot(facing, toLight)) + mix(earth, sky, 0.5 + 0.5 * facing.z);
    shade = color * lit;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;
const FRAGMENT = /* glsl */ `
  uniform vec3 ground;
  uniform float faded;
  varying vec3 shade;
  void main() {
    gl_FragColor = vec4(mix(shade, ground, faded), 1.0);
    #include <colorspace_fragment>
  }
`;

export function litMaterial(palette: Palette, more: ShaderMaterialParameters = {}): ShaderMaterial {
  const { sun, sky, earth } = palette;
  return new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: {
      ...{ toLight: { value: TO_LIGHT }, sun: { value: sun }, sky: { value: sky }, earth: { value: earth } },
      // How much of the background shows through, 0 to 1.
      ...{ ground: { value: new Color(palette.background) }, faded: { value: 0 } },
    },
    ...more,
  });
}

/** A colour in one light whichever way it faces. */
export function plainMaterial(colour: string, more: ShaderMaterialParameters = {}): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
    fragmentShader:
      "uniform vec3 colour;\nvoid main() {\n  gl_FragColor = vec4(colour, 1.0);\n  #include <colorspace_fragment>\n}",
    uniforms: { colour: { value: new Color(colour) } },
    ...more,
  });
}
