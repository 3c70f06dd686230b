// Reads what the C++ put into the page: facts (JSON), arrays, film and still (base64).

import type { ArrayFact, FlightFacts } from "./facts";

export type Numbers = Float32Array | Uint32Array | Uint16Array | Uint8Array;
export type Arrays = Map<string, Numbers>;

const types = { f32: Float32Array, u32: Uint32Array, u16: Uint16Array, u8: Uint8Array };

function block_text(id: string): string {
  return document.getElementById(id)?.textContent?.trim() ?? "";
}

/// null where the page holds no facts.
export function read_facts(): { kind?: string } | null {
  const text = block_text("facts");
  return text ? JSON.parse(text) : null;
}

/// The decoded block; its text leaves the page: it would cost memory twice.
export function take_bytes(id: string): Uint8Array<ArrayBuffer> | null {
  const bytes = block_bytes(id);
  document.getElementById(id)?.remove();
  return bytes;
}

/// The decoded block, or null where there is none.
function block_bytes(id: string): Uint8Array<ArrayBuffer> | null {
  const text = block_text(id);
  if (!text) return null;
  const decoder = Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> };
  if (decoder.fromBase64) return decoder.fromBase64(text);
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

/// Views into one buffer that begins at `start`: only i16 is copied, because its numbers are scaled. Throws RangeError
/// where an array leaves the buffer.
export function read_arrays(facts: ArrayFact[] | undefined, bytes: Uint8Array<ArrayBuffer> | null, start = 0): Arrays {
  const arrays: Arrays = new Map();
  for (const { name, type, offset, count, components, scale = 1 } of facts ?? []) {
    if (count === 0) continue;
    const place = [bytes?.buffer ?? new ArrayBuffer(0), start + offset, count * components] as const;
    arrays.set(name, type !== "i16" ? new types[type](...place)
      : Float32Array.from(new Int16Array(...place), (stored) => (stored === -32768 ? NaN : stored * scale)));
  }
  return arrays;
}

/// A flight packed into one block: the length of its facts, the facts, and from the next multiple of 4 its arrays.
export function read_track(id: string): { facts: FlightFacts; arrays: Arrays } {
  const bytes = block_bytes(id);
  if (!bytes) throw new Error(`the page holds no ${id}`);
  const length = new DataView(bytes.buffer).getUint32(0, true);
  const facts = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length))) as FlightFacts;
  return { facts, arrays: read_arrays(facts.arrays, bytes, Math.ceil((4 + length) / 4) * 4) };
}

const no_numbers = new Float32Array(0);

/// Absent arrays are empty arrays.
export function array_of(arrays: Arrays, name: string): Numbers {
  return arrays.get(name) ?? no_numbers;
}

export function floats_of(arrays: Arrays, name: string): Float32Array {
  const numbers = array_of(arrays, name);
  return numbers instanceof Float32Array ? numbers : Float32Array.from(numbers);
}

/// How many of the sorted times are at or before a moment.
export function count_until(times: Numbers, time_s: number): number {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time_s) low = middle + 1;
    else high = middle;
  }
  return low;
}
