/** A picture with lines below it that say what it shows. */

import { themeColour } from "./dom";

const LETTERS = 14; // px of a picture 800 px wide
const WIDTH = 800;

/** Returns `picture` as PNG with `lines` below it, broken where they are too long. */
export async function captioned(picture: Blob, lines: readonly string[]): Promise<Blob> {
  const drawn = await createImageBitmap(picture);
  const unit = Math.max(drawn.width / WIDTH, 1);
  const [size, margin] = [LETTERS * unit, 12 * unit];
  const canvas = document.createElement("canvas");
  const pen = canvas.getContext("2d");
  if (pen === null) throw new Error("This browser cannot save the canvas as a picture. Take a screenshot instead");
  const font = `${size}px system-ui, sans-serif`;
  pen.font = font;
  const room = drawn.width - 2 * margin;
  const broken = lines.flatMap((line) => brokenAt(line, (text) => pen.measureText(text).width <= room));
  const height = 1.4 * size;
  canvas.width = drawn.width;
  canvas.height = Math.ceil(drawn.height + 2 * margin + broken.length * height);
  pen.fillStyle = themeColour("panel");
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(drawn, 0, 0);
  pen.font = font; // a canvas that changes its size forgets it
  pen.fillStyle = themeColour("ink");
  pen.textBaseline = "top";
  broken.forEach((line, i) => pen.fillText(line, margin, drawn.height + margin + i * height));
  return new Promise((done, failed) => {
    canvas.toBlob(
      (blob) => (blob === null ? failed(new Error("The browser could not write the picture as PNG")) : done(blob)),
      "image/png",
    );
  });
}

/** Returns `text` in lines of whole words that fit; a word that is too long has a line of its own. */
export function brokenAt(text: string, fits: (line: string) => boolean): readonly string[] {
  const lines: string[] = [];
  let line = "";
  for (const word of text.split(" ")) {
    const longer = line === "" ? word : `${line} ${word}`;
    if (line !== "" && !fits(longer)) {
      lines.push(line);
      line = word;
    } else line = longer;
  }
  return line === "" ? lines : [...lines, line];
}
