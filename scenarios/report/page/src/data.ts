// Reads what the C++ put into the page: facts (JSON), arrays, film and still (base64).

import type { ArrayFact } from "./facts";

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

/// The decoded block, or null where there is none. Its text leaves the page: it would cost memory twice.
export function take_bytes(id: string): Uint8Array<ArrayBuffer> | null {
  const text = block_text(id);
  document.getElementById(id)?.remove();
  if (!text) return null;
  const decoder = Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> };
  if (decoder.fromBase64) return decoder.fromBase64(text);
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

/// Views into one buffer: nothing is copied. Throws RangeError where an array leaves the buffer.
export function read_arrays(facts: ArrayFact[]): Arrays {
  const bytes = take_bytes("arrays") ?? new Uint8Array(0);
  const arrays: Arrays = new Map();
  for (const fact of facts) {
    if (fact.count > 0) {
      arrays.set(fact.name, new types[fact.type](bytes.buffer, fact.offset, fact.count * fact.components));
    }
  }
  return arrays;
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
