/** Who answers this page: a page that was made to do without a server holds its answers, or says where they lie. */

import { Kernels, type Load } from "../../kernels/kernels";
import { computing } from "../../kernels/layer";
import type { StartWorker } from "../../kernels/worker-pool";
import { server } from "./api";
import { unpacked } from "./packed";
import { type Contents, type Read, recorded } from "./recorded";
import { Refused, type Source, layered } from "./source";

/** The element with the contents, as JSON; `stylobate.lab.static_site` writes it. */
const CONTENTS = "answers";
/** The folder of the answers, beside the page. */
const FOLDER = "answers";
/** The folder of the programs and records, and the beginning of the names of their elements. */
const PROGRAMS = "programs";
/** The name of the script of the workers, and its element. */
const WORKER = "worker";

export function sourceOf(page: Document): Source {
  const contents = page.getElementById(CONTENTS);
  if (contents === null) return server;
  const read: Read = (name) => {
    const own = page.getElementById(`${CONTENTS}-${name}`);
    return own === null ? fetched(name) : unzipped(own.textContent);
  };
  const found = JSON.parse(contents.textContent) as Contents & { readonly kernels?: Kernels["described"] };
  const layers = [recorded(found, async (name) => unpacked(await read(name)))];
  if (found.kernels) {
    const startWorker = workersOf(page);
    layers.push(computing(new Kernels(found.kernels, loadOf(page), startWorker), startWorker));
  }
  return layered(layers);
}

/** Returns how the programs and records of the page are loaded. */
function loadOf(page: Document): Load {
  return async (name) => {
    const own = page.getElementById(`${PROGRAMS}-${name}`);
    if (own !== null) return new Response(decompressed(own.textContent)).arrayBuffer();
    const found = await fetch(`${PROGRAMS}/${name}`, { credentials: "same-origin" }).catch(() => null);
    if (found?.ok) return found.arrayBuffer();
    throw new Refused(404, [`The file ${PROGRAMS}/${name} of this page cannot be loaded. Check the connection.`]);
  };
}

/** Returns how the page starts a worker: its script is a file beside the page, or an element in it. */
function workersOf(page: Document): StartWorker {
  const own = page.getElementById(WORKER);
  let address = own === null ? `${WORKER}.js` : null;
  return () => {
    address ??= URL.createObjectURL(new Blob([own?.textContent ?? ""], { type: "text/javascript" }));
    return new Worker(address);
  };
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
  return new Response(decompressed(text)).json();
}

function decompressed(text: string): ReadableStream {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
}
