/** Who answers this page: a page that was made to do without a server holds its answers, or says where they lie. */

import { server } from "./api";
import { unpacked } from "./packed";
import { type Contents, type Read, recorded } from "./recorded";
import { Refused, type Source, layered } from "./source";

/** The element with the contents, as JSON; `stylobate.lab.static_site` writes it. */
const CONTENTS = "answers";
/** The folder of the answers, beside the page. */
const FOLDER = "answers";

export function sourceOf(page: Document): Source {
  const contents = page.getElementById(CONTENTS);
  if (contents === null) return server;
  const read: Read = (name) => {
    const own = page.getElementById(`${CONTENTS}-${name}`);
    return own === null ? fetched(name) : unzipped(own.textContent);
  };
  return layered([recorded(JSON.parse(contents.textContent) as Contents, async (name) => unpacked(await read(name)))]);
}

async function fetched(name: string): Promise<unknown> {
  try {
    const answer = await fetch(`${FOLDER}/${name}.json`, { credentials: "same-origin" });
    if (answer.ok) return await answer.json();
  } catch {
    // as where the file is missing
  }
  throw new Refused(404, [`The file ${FOLDER}/${name}.json of this page cannot be loaded. Check the connection.`]);
}

/** Returns JSON that was compressed by gzip and written in base64. */
async function unzipped(text: string): Promise<unknown> {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).json();
}
