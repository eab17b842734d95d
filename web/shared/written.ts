// SPDX-License-Identifier: GPL-3.0-or-later

type Numbers = new (buffer: ArrayBuffer) => ArrayLike<number>;

function bytes(text: string): ArrayBuffer {
  const binary = atob(text);
  const array = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) array[i] = binary.charCodeAt(i);
  return array.buffer;
}

/**
 * Data that the program has written into a page as JSON, with little-endian numbers in base64.
 * @param kinds the keys of these numbers, each of which may also have a list of several
 */
export function parseWritten<Data>(json: string, kinds: Record<string, Numbers>): Data {
  return JSON.parse(json, (key, value: unknown) => {
    const Kind = kinds[key];
    if (!Kind || (typeof value !== 'string' && !Array.isArray(value))) return value;
    return Array.isArray(value) ? value.map((text: string) => new Kind(bytes(text))) : new Kind(bytes(value));
  }) as Data;
}
