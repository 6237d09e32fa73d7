/**
 * The service worker of the page as static files: once it is installed, the whole page works without a connection.
 *
 * `stylobate.lab.static_site` writes the list of files before this script, with a digest of their contents: a changed site
 * has another script, which browsers install beside the old one. It takes over when the last page of the old site is
 * closed, so that no page mixes files of two sites.
 */

/** Written by `stylobate.lab.static_site`. */
declare const offline: { readonly version: string; readonly files: readonly string[] };

interface Extendable extends Event {
  waitUntil(done: Promise<unknown>): void;
}

interface Fetching extends Extendable {
  readonly request: Request;
  respondWith(answer: Promise<Response>): void;
}

interface Worker {
  readonly registration: { readonly scope: string };
  readonly clients: { claim(): Promise<void> };
  addEventListener(name: "install" | "activate", heard: (event: Extendable) => void): void;
  addEventListener(name: "fetch", heard: (event: Fetching) => void): void;
}

const worker = self as unknown as Worker;
const { scope } = worker.registration;
/** Other sites of the same origin have caches of their own. */
const OWN = `stylobate ${scope} `;
const NAME = OWN + offline.version;
const KNOWN = new Set(offline.files.map((name) => new URL(name, scope).href));

worker.addEventListener("install", (event) => {
  // Not from the browser's own cache, which may hold files of the site before.
  const fresh = offline.files.map((name) => new Request(new URL(name, scope), { cache: "no-cache" }));
  event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(fresh)));
});

worker.addEventListener("activate", (event) => {
  event.waitUntil(forgetOthers().then(() => worker.clients.claim()));
});

worker.addEventListener("fetch", (event) => {
  const address = new URL(event.request.url);
  address.search = address.hash = "";
  const wanted = address.href === scope ? new URL("index.html", scope).href : address.href;
  if (event.request.method === "GET" && KNOWN.has(wanted)) event.respondWith(held(wanted, event.request));
});

async function forgetOthers(): Promise<void> {
  const names = await caches.keys();
  await Promise.all(names.filter((name) => name.startsWith(OWN) && name !== NAME).map((name) => caches.delete(name)));
}

async function held(wanted: string, request: Request): Promise<Response> {
  const cache = await caches.open(NAME);
  return (await cache.match(wanted)) ?? fetch(request);
}
