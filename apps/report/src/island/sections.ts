// The binary sections of the page: zlib's deflate in base64, one script element each, unpacked when they are wanted.

export type LoadSection = (index: number) => Promise<ArrayBuffer>;

export function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const letters = atob(text.trim());
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < letters.length; ++k) bytes[k] = letters.charCodeAt(k);
  return bytes;
}

export async function unpack(text: string): Promise<ArrayBuffer> {
  if (typeof DecompressionStream === 'undefined') throw new Error('this browser cannot unpack deflate (it has no DecompressionStream)');
  // Written by hand: Chromium fails to fetch a blob's stream on a page from disk.
  const unpacking = new DecompressionStream('deflate');
  const writer = unpacking.writable.getWriter();
  const written = Promise.all([writer.write(fromBase64(text)), writer.close()]);
  const bytes = await new Response(unpacking.readable).arrayBuffer();
  await written;
  return bytes;
}

export function sectionsOfRun(run: number): LoadSection {
  return async (index) => {
    const element = document.getElementById(`s${run}-${index}`);
    if (!element) throw new Error(`section ${index} of run ${run} is missing in this page`);
    return unpack(element.textContent ?? '');
  };
}

// Arrays that stand one after the other. Copies, because typed arrays want to be aligned.
export class Arrays {
  private at = 0;
  constructor(private readonly bytes: ArrayBuffer) {}
  private next(size: number): ArrayBuffer {
    if (this.at + size > this.bytes.byteLength) throw new Error('a section of this page is shorter than it says');
    const part = this.bytes.slice(this.at, this.at + size);
    this.at += size;
    return part;
  }
  bytes8(n: number): Uint8Array { return new Uint8Array(this.next(n)); }
  uint16(n: number): Uint16Array { return new Uint16Array(this.next(2 * n)); }
  uint32(n: number): Uint32Array { return new Uint32Array(this.next(4 * n)); }
  float32(n: number): Float32Array { return new Float32Array(this.next(4 * n)); }
  float64(n: number): Float64Array { return new Float64Array(this.next(8 * n)); }
  finish(): void {
    if (this.at !== this.bytes.byteLength) throw new Error('a section of this page is longer than it says');
  }
}

// Codes of apps/jamscope/scene_data.hpp; NaN where not known.
export function fromLogCode(code: number): number {
  return code === 65535 ? NaN : code === 0 ? 0 : 10 ** (((code - 1) * 18) / 65533 - 12);
}
