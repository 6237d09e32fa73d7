/** The content of a file as text: gzip, and encodings; archives in archives and documents are refused. */

import { Refused } from "../../page/server/source";
import { RecordText, notReadHere } from "./text";

/** Size of an unpacked file [bytes] that a record may have at most. */
export const MOST = 32 << 20;
/** Size of a line of text [bytes] that a record may have at most, far more than the lines of any table have. */
const LONGEST_LINE = 1 << 16;
/** First signs of archives and documents that may hold records, but not as text. */
const PACKED: readonly (readonly [begin: string, what: string])[] = [
  ["PK\x03\x04", "an archive beside other files. Upload it alone."],
  ["Rar!", "a rar archive. Unpack it and read the files in it"],
  ["7z\xbc\xaf", "a 7z archive. Unpack it and read the files in it"],
  ["BZh", "packed with bzip2. Unpack it and read the files in it"],
  ["\xfd7zXZ\0", "packed with xz. Unpack it and read the files in it"],
  ["\x28\xb5\x2f\xfd", "packed with zstd. Unpack it and read the files in it"],
  ["\x1f\x9d", "packed with compress. Unpack it and read the files in it"],
  ["\xd0\xcf\x11\xe0", "an Excel workbook of the old form. Save it as xlsx, or its sheet as CSV, and read that"],
  ["%PDF", "a PDF document. Save its numbers as text and read that"],
];

/** Returns the text of a file whose bytes are the letters that are `sent`. */
export async function textOf(name: string, sent: string): Promise<RecordText> {
  const damaged = new Refused(422, [`${name}: cannot be read: damaged gzip file. Download the file again`]);
  const unzipped = sent.startsWith("\x1f\x8b") ? await inflated(name, bytesOf(sent), "gzip", damaged) : null;
  const latin = unzipped === null ? sent : inLatin(unzipped);
  if (!/[^ \t\n\r\v\f]/.test(latin)) {
    throw new Refused(422, [`${name}: the file is empty. Download or export it again`]);
  }
  const packed = PACKED.find(([begin]) => latin.startsWith(begin))?.[1];
  if (packed !== undefined) throw new Refused(422, [`${name}: ${packed}`]);
  const text = decoded(latin, unzipped ?? bytesOf(sent));
  if (/[\x00-\x08\x0b\x0e-\x19\x1b-\x1f]/.test(text.slice(0, 4096))) throw binary(name);
  requireLines(name, latin, text);
  return new RecordText(name, text);
}

/** Refuses a text with a line that is longer than those of any table, before anything looks at its words. */
function requireLines(name: string, latin: string, text: string): void {
  const bytes = isUtf16(latin) ? inLatin(new TextEncoder().encode(text)) : latin;
  let begin = 0;
  while (bytes.length - begin > LONGEST_LINE) {
    const piece = bytes.slice(begin, begin + LONGEST_LINE); // a search in all bytes would go on before its beginning
    const end = Math.max(piece.lastIndexOf("\n"), piece.lastIndexOf("\r"));
    if (end < 0) {
      const remedy = "Write one sample, or a few, on each line";
      throw new Refused(422, [`${name}: a line of more than ${LONGEST_LINE >> 10} KiB. ${remedy}`]);
    }
    begin += end + 1;
  }
}

export function isCalledAt2(name: string): boolean {
  return /\.at2(\.gz)?$/i.test(name);
}

function binary(name: string): Refused {
  if (!isCalledAt2(name)) return notReadHere(name, "binary files such as miniSEED");
  const problem = "no AT2 file: it is no text, and has no header with NPTS and DT";
  return new Refused(422, [`${name}: ${problem}. Download it again`]);
}

/** Unpacks a file, to the maximum size. */
export async function inflated(
  name: string,
  bytes: Uint8Array<ArrayBuffer>,
  format: CompressionFormat,
  damaged: Refused,
): Promise<Uint8Array<ArrayBuffer>> {
  const pieces: Uint8Array[] = [];
  let size = 0;
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format)).getReader();
  for (;;) {
    const { done, value } = await reader.read().catch(() => {
      throw damaged;
    });
    if (done) break;
    pieces.push(value);
    size += value.length;
    if (size <= MOST) continue;
    void reader.cancel();
    const remedy = "Cut the record, or read it in Python.";
    throw new Refused(422, [`${name}: more than ${MOST} bytes when unpacked. ${remedy}`]);
  }
  return new Uint8Array(await new Blob(pieces as BlobPart[]).arrayBuffer());
}

function isUtf16(latin: string): boolean {
  return latin.startsWith("\xff\xfe") || latin.startsWith("\xfe\xff");
}

/** Decodes UTF-16 with its mark or UTF-8, otherwise Latin-1. */
function decoded(latin: string, bytes: Uint8Array): string {
  if (latin.startsWith("\xff\xfe")) return new TextDecoder("utf-16le").decode(bytes);
  if (latin.startsWith("\xfe\xff")) return new TextDecoder("utf-16be").decode(bytes);
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    return latin; // TextDecoder reads Windows-1252 in place of Latin-1
  }
}

export function bytesOf(latin: string): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(latin.length);
  for (let at = 0; at < latin.length; at += 1) bytes[at] = latin.charCodeAt(at);
  return bytes;
}

export function inLatin(bytes: Uint8Array): string {
  const pieces: string[] = [];
  // In pieces: a call takes only so many arguments.
  for (let at = 0; at < bytes.length; at += 0x8000) {
    pieces.push(String.fromCharCode(...bytes.subarray(at, at + 0x8000)));
  }
  return pieces.join("");
}
