/** Zip archives of records: the list of files at the end of an archive, and the files in it. */

import { Refused } from "../../page/server/source";
import { MOST, bytesOf, inflated } from "./content";
import { notReadHere } from "./text";

/** First bytes of an archive, and of its parts: little-endian, as all numbers in it. */
const ZIP = "PK\x03\x04";
const [END, ENTRY] = [0x06054b50, 0x02014b50];
/** Sizes of the end, of an entry of the list and of the header before a file, without their texts [bytes]. */
const [END_SIZE, ENTRY_SIZE, HEADER_SIZE] = [22, 46, 30];
const LONGEST_REMARK = 0xffff;
const [ENCRYPTED, UTF_8] = [1, 1 << 11];
const [STORED, DEFLATED] = [0, 8];
/** Size of all unpacked files [bytes]. */
const MOST_OF_ALL = 8 * MOST;
/** Other files of a download: velocities, displacements and search results. */
const OTHER = /^(?:.*\.[VD]T2|.*\.(?:VEL|DIS)\.(?:.*\.)?(?:ASC|V2c?)|_SearchResults\.csv)(?:\.gz)?$/i;

/** A file in an archive: its path, below that of the archive, and its content. */
export interface Member {
  readonly name: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

interface Entry {
  readonly name: string;
  readonly flags: number;
  readonly method: number;
  readonly packed: number;
  readonly size: number;
  readonly at: number;
}

export function isZip(sent: string): boolean {
  return sent.startsWith(ZIP);
}

export function baseOf(name: string): string {
  return name.slice(name.lastIndexOf("/") + 1);
}

/** Unpacks the accelerations in an archive, in the order of their names. */
export async function membersOf(archive: string, sent: string): Promise<readonly Member[]> {
  const bytes = bytesOf(sent);
  const view = new DataView(bytes.buffer);
  const entries = entriesIn(archive, view).filter(({ name }) => !name.endsWith("/"));
  if (entries.some(({ name }) => name === "xl/workbook.xml")) throw notReadHere(archive, "workbooks");
  const shown = entries.filter(({ name }) => !baseOf(name).startsWith(".") && !name.includes("__MACOSX/"));
  const accelerations = shown.filter(({ name }) => !OTHER.test(baseOf(name)));
  const wanted = accelerations.length > 0 ? accelerations : shown;
  if (wanted.length === 0) throw new Refused(422, [`${archive}: the archive has no files. Choose another one`]);
  if (wanted.reduce((sum, one) => sum + one.size, 0) > MOST_OF_ALL) {
    const remedy = "Unpack it, and choose the files of one event.";
    throw new Refused(422, [`${archive}: more than ${MOST_OF_ALL} bytes when unpacked. ${remedy}`]);
  }
  const found: Member[] = [];
  for (const one of wanted.sort((a, b) => (a.name < b.name ? -1 : 1))) {
    const name = [archive, ...one.name.split(/[\\/]/).filter((part) => !["", ".", ".."].includes(part))].join("/");
    found.push({ name, bytes: await contentOf(archive, name, view, one) });
  }
  return found;
}

function entriesIn(archive: string, view: DataView): readonly Entry[] {
  let end = view.byteLength - END_SIZE;
  const first = Math.max(0, end - LONGEST_REMARK);
  while (end >= first && view.getUint32(end, true) !== END) end -= 1;
  if (end < first) throw damaged(archive);
  const entries: Entry[] = [];
  let at = view.getUint32(end + 16, true);
  for (let left = view.getUint16(end + 10, true); left > 0; left -= 1) {
    if (at + ENTRY_SIZE > end || view.getUint32(at, true) !== ENTRY) throw damaged(archive);
    const [name, extra, remark] = [28, 30, 32].map((place) => view.getUint16(at + place, true));
    const flags = view.getUint16(at + 8, true);
    const method = view.getUint16(at + 10, true);
    const [packed, size, begin] = [20, 24, 42].map((place) => view.getUint32(at + place, true));
    entries.push({
      name: text(archive, view, at + ENTRY_SIZE, name, flags),
      ...{ flags, method, packed, size, at: begin },
    } as Entry);
    at += ENTRY_SIZE + (name ?? 0) + (extra ?? 0) + (remark ?? 0);
  }
  return entries;
}

function text(archive: string, view: DataView, at: number, length = 0, flags = 0): string {
  return new TextDecoder(flags & UTF_8 ? "utf-8" : "latin1").decode(part(archive, view, at, length));
}

function part(archive: string, view: DataView, at: number, length: number): Uint8Array<ArrayBuffer> {
  if (at + length > view.byteLength) throw damaged(archive);
  return new Uint8Array(view.buffer as ArrayBuffer, at, length);
}

async function contentOf(archive: string, name: string, view: DataView, entry: Entry): Promise<Member["bytes"]> {
  const { flags, method, packed, size, at } = entry;
  if (flags & ENCRYPTED) throw damaged(archive, "it needs a password");
  part(archive, view, at, HEADER_SIZE);
  const begin = at + HEADER_SIZE + view.getUint16(at + 26, true) + view.getUint16(at + 28, true);
  const content = part(archive, view, begin, packed);
  if (method !== STORED && method !== DEFLATED) throw damaged(archive);
  const found = method === STORED ? content : await inflated(name, content, "deflate-raw", damaged(archive));
  if (found.length !== size) throw damaged(archive);
  return found;
}

function damaged(archive: string, why = "it is damaged, or packed in an unknown way"): Refused {
  const remedy = "Unpack it by its own program, and read the folder";
  return new Refused(422, [`${archive}: cannot be unpacked: ${why}. ${remedy}`]);
}
