// What `load` does with freiform.packed: for those who want the module itself, as a file with the ending .wasm.
export function isPacked(bytes: Uint8Array): boolean;

// Throws Damaged.
export function unpack(bytes: Uint8Array): Uint8Array;
export class Damaged extends Error {}
