// A packed module, two thirds of what gzip makes of it: the same numbers after each other that a module has, in the order
// in which they are alike. pack.js writes it, and says why.
//
//     magic "ffwasm1\0"; the module's size and its sum (FNV-1a), 32 bits each, the low byte first; then of each of
//     kStreams its size, its packed size (the same) and its bits of the byte before (8 bits); then the packed streams
//
// A stream is packed by LZMA, without positions (lp = pb = 0) and without a header. A stream of the size 0 has no bytes.

export const kMagic = [...'ffwasm1\0'].map((c) => c.charCodeAt(0));
const kMost = 1 << 26;  // bytes of a module

// What follows an instruction of one byte, a letter for each: numbers (LEB128) but for 'f', 'd', 'v' and 'y', which have
// 4, 8, 16 and 1 bytes, and for lists: 's' has as many numbers as its first says, 't' one more.
const kFollows = [
  [0x02, 0x04, 'b'], [0x0c, 0x0d, 'j'], [0x0e, 0x0e, 't'], [0x10, 0x10, 'c'], [0x11, 0x11, 'ii'], [0x12, 0x12, 'c'],
  [0x13, 0x13, 'ii'], [0x1c, 0x1c, 's'], [0x20, 0x22, 'l'], [0x23, 0x26, 'g'], [0x28, 0x3e, 'ao'], [0x3f, 0x40, 'i'],
  [0x41, 0x41, 'n'], [0x42, 0x42, 'w'], [0x43, 0x43, 'f'], [0x44, 0x44, 'd'], [0xd0, 0xd0, 'i'], [0xd2, 0xd2, 'c'],
];
const kOne = Array.from({ length: 256 }, (_, op) => kFollows.find(([from, to]) => op >= from && op <= to)?.[2] ??
  (op < 2 || op === 0x05 || op === 0x0b || op === 0x0f || op === 0x1a || op === 0x1b || op === 0xd1 ||
    op >= 0x45 && op <= 0xc4 ? '' : undefined));

/** What follows an instruction; of those that begin with 0xfc and 0xfd `more` says which it is. Undefined: there is none. */
export function follows(op, more) {
  if (op === 0xfc) return more > 17 ? undefined : more < 8 ? '' : more < 16 && more % 2 === 0 ? 'ii' : 'i';
  if (op !== 0xfd) return kOne[op];
  if (more < 12 || more === 92 || more === 93) return 'ao';
  if (more < 14) return 'v';
  if (more > 20 && more < 35) return 'y';
  return more > 83 && more < 92 ? 'aoy' : '';
}

/** What is alike: all before the code, all after it, the locals of functions, instructions, what follows them. */
export const kStreams = ['before', 'after', 'locals', 'ops', ...'bjtcislgaowfdvyn'];
/** Constants, of which addresses and small numbers differ: by the instruction that takes them. */
const kTakers = [0x10, 0x20, 0x21, 0x22, 0x36, 0x41, 0x46, 0x6a, 0x6b, 0x6c, 0x71, 0x74];
kTakers.forEach((op) => kStreams.push(`n${op}`));
export const kBytes = { f: 4, d: 8, v: 16, y: 1 };
const kConstants = Array.from({ length: 256 }, (_, op) => kTakers.includes(op) ? `n${op}` : 'n');
export const streamOf = (letter, next) => letter === 'n' ? kConstants[next] ?? 'n' : letter;

export class Damaged extends Error {}
const damaged = (why) => { throw new Damaged(`a packed module is damaged: ${why}`); };

export const isPacked = (bytes) => kMagic.every((b, i) => bytes[i] === b);

export function sumOf(bytes) {
  let sum = 0x811c9dc5;
  for (let i = 0; i < bytes.length; ++i) sum = Math.imul(sum ^ bytes[i], 0x01000193);
  return sum >>> 0;
}

// Igor Pavlov's LZMA, as its specification has it, for lp = pb = 0. ------------------------------------------------------

// Where the chances of each kind of bit begin.
const kMatch = 0, kRep = 12, kRep0 = 24, kRep1 = 36, kRep2 = 48, kRep0Long = 60, kSlot = 72, kSpecial = kSlot + 256,
  kAlign = kSpecial + 128, kLength = kAlign + 16, kRepLength = kLength + 274, kLiteral = kRepLength + 274;

// What is asked next.
const [kIsMatch, kLike, kLiterally, kIsRep, kIsOther0, kIsLong, kIsOther1, kIsOther2, kLength0, kLength1, kLengthIs, kSlotIs,
  kDistanceIs, kAlignIs] = Array.from({ length: 14 }, (_, i) => i);

// All in one loop over bits, whose variables an engine keeps in registers. Bits are appended to `m`, told by the chances from
// `base` on, until it is `end` or more; then it answers what was asked.
function unpacked(packed, size, high) {
  const out = new Uint8Array(size);
  if (size === 0) return out;
  const chance = new Uint16Array(kLiteral + (0x300 << high)).fill(1024);
  let range = 0xffffffff, code = 0, from = 5;
  for (let i = 1; i < 5; ++i) code = (code << 8 | packed[i]) >>> 0;
  let at = 0, state = 0, rep0 = 0, rep1 = 0, rep2 = 0, rep3 = 0;
  let asked = kIsMatch, base = kMatch - 1, m = 1, end = 2;
  let literal = 0, match = 0, lengths = kLength, length = 0, distance = 0, bits = 0;
  for (;;) {
    const p = chance[base + m], bound = Math.imul(range >>> 11, p) >>> 0;
    if (code < bound) range = bound, chance[base + m] = p + (2048 - p >> 5), m = m << 1;
    else range = range - bound >>> 0, code = code - bound >>> 0, chance[base + m] = p - (p >> 5), m = m << 1 | 1;
    if (range < 0x1000000) range = range << 8 >>> 0, code = (code << 8 | packed[from++]) >>> 0;
    if (m < end) continue;

    const bit = m & 1;
    length = 0;
    switch (asked) {
      case kIsMatch:
        if (bit === 1) { asked = kIsRep, base = kRep + state - 1, m = 1; continue; }
        literal = kLiteral + 0x300 * (at > 0 ? out[at - 1] >> 8 - high : 0), m = 1;
        if (state < 7) { asked = kLiterally, base = literal, end = 0x100; continue; }
        match = out[at - rep0 - 1], asked = kLike, base = literal + (match & 0x80 ? 0x200 : 0x100);
        continue;
      case kLike:  // as the byte that the last copy would go on with; from the first bit on that differs, by itself
        if (m >= 0x100) break;
        match <<= 1;
        if (bit === (match >> 8 & 1)) { base = literal + (match & 0x80 ? 0x200 : 0x100), end = m << 1; continue; }
        asked = kLiterally, base = literal, end = 0x100;
        continue;
      case kLiterally:
        break;
      case kIsRep:
        m = 1;
        if (bit === 1) { asked = kIsOther0, base = kRep0 + state - 1; continue; }
        rep3 = rep2, rep2 = rep1, rep1 = rep0, lengths = kLength, asked = kLength0, base = lengths - 1;
        continue;
      case kIsOther0:
        asked = bit === 0 ? kIsLong : kIsOther1, base = (bit === 0 ? kRep0Long : kRep1) + state - 1, m = 1;
        continue;
      case kIsLong:
        if (bit === 0) { length = 1, state = state < 7 ? 9 : 11; break; }
        lengths = kRepLength, asked = kLength0, base = lengths - 1, m = 1;
        continue;
      case kIsOther1:
      case kIsOther2: {
        m = 1;
        if (bit === 1 && asked === kIsOther1) { asked = kIsOther2, base = kRep2 + state - 1; continue; }
        const again = asked === kIsOther1 ? rep1 : bit === 0 ? rep2 : rep3;
        if (asked === kIsOther2) rep3 = bit === 0 ? rep3 : rep2, rep2 = rep1;
        rep1 = rep0, rep0 = again;
        lengths = kRepLength, asked = kLength0, base = lengths - 1;
        continue;
      }
      case kLength0:
        m = 1;
        if (bit === 1) { asked = kLength1, base = lengths; continue; }
        asked = kLengthIs, base = lengths + 2, end = 8, bits = 2 - 8;
        continue;
      case kLength1:
        m = 1, asked = kLengthIs, base = lengths + (bit === 0 ? 10 : 18), end = bit === 0 ? 8 : 256, bits = bit === 0 ? 10 - 8 : 18 - 256;
        continue;
      case kLengthIs:
        length = m + bits;
        if (lengths === kRepLength) { state = state < 7 ? 8 : 11; break; }
        state = state < 7 ? 7 : 10, distance = length;  // until the distance is known
        asked = kSlotIs, base = kSlot + (Math.min(length - 2, 3) << 6), m = 1, end = 64;
        continue;
      case kSlotIs: {
        const slot = m - 64;
        length = distance, m = 1;
        if (slot < 4) { rep0 = slot; break; }
        bits = (slot >> 1) - 1, rep0 = (2 | slot & 1) << bits, end = 1 << bits;
        if (slot < 14) { asked = kDistanceIs, base = kSpecial + rep0 - slot; continue; }
        for (let i = bits - 1; i >= 4; --i) {
          range = range >>> 1;
          if (code >= range) code = code - range >>> 0, rep0 += 1 << i;
          if (range < 0x1000000) range = range << 8 >>> 0, code = (code << 8 | packed[from++]) >>> 0;
        }
        asked = kAlignIs, base = kAlign, end = 16, bits = 4;
        continue;
      }
      default:  // the low bit came first
        length = distance;
        for (let i = bits - 1; i >= 0; --i, m >>= 1) rep0 += (m & 1) << i;
    }

    if (length === 0) out[at++] = m, state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
    else {
      if (rep0 < 0 || rep0 >= at || length > size - at) damaged('a copy of what is not there');
      for (const past = at + length; at < past; ++at) out[at] = out[at - rep0 - 1];
    }
    if (at === size) break;
    asked = kIsMatch, base = kMatch + state - 1, m = 1, end = 2;
  }
  if (from > packed.length) damaged('it ends too early');
  return out;
}

// The code again, from its streams. ------------------------------------------------------------------------------------

// For each instruction of one byte the streams of what follows it, as places in kStreams.
const placesOf = (letters) => letters === undefined ? undefined : [...letters].map((c) => kStreams.indexOf(c));
const kAfterOne = kOne.map(placesOf);
const [kLocals, kOps, kLists, kTables, kNumbers] = ['locals', 'ops', 's', 't', 'n'].map((c) => kStreams.indexOf(c));
const kAfterConstant = kConstants.map((name) => kStreams.indexOf(name));
const kWidths = kStreams.map((name) => kBytes[name] ?? 0);

// Writes a module's code into `out` from `at` on; streams are read from their beginnings.
class Code {
  constructor(out, at, streams) {
    this.out = out, this.at = at, this.streams = streams;
    this.read = new Int32Array(streams.length);  // how much of each
  }
  byte(stream) {
    const b = this.streams[stream][this.read[stream]++] ?? damaged('there is too little of something');
    this.out[this.at++] = b;
    return b;
  }
  number(stream) {
    for (let value = 0, factor = 1;; factor *= 128) {
      const b = this.byte(stream);
      value += (b & 127) * factor;
      if (b < 128) return value;
    }
  }
  // Puts the size of what `write` writes before it.
  sized(write) {
    const from = this.at;
    write();
    const to = this.at;
    let size = to - from, digits = 1;
    for (let rest = size; rest > 127; rest >>>= 7) ++digits;
    this.out.copyWithin(from + digits, from, to), this.at = to + digits;
    for (let i = from; digits > 0; ++i, size >>>= 7) this.out[i] = --digits > 0 ? size & 127 | 128 : size;
  }
  body() {
    for (let n = this.number(kLocals); n > 0; --n) this.number(kLocals), this.byte(kLocals);
    const { out, streams, read } = this, ops = streams[kOps];
    for (let depth = 1; depth > 0;) {
      const op = out[this.at++] = ops[read[kOps]++];  // where there are no more, there is no instruction `undefined`
      if (op > 1 && op < 5) ++depth;
      else if (op === 0x0b) --depth;
      const places = op === 0xfc || op === 0xfd ? placesOf(follows(op, this.number(kOps))) : kAfterOne[op];
      if (places === undefined) damaged(`there is no instruction ${op}`);
      for (let i = 0; i < places.length; ++i) {
        const place = places[i] === kNumbers ? kAfterConstant[ops[read[kOps]]] ?? kNumbers : places[i];
        if (kWidths[place] > 0) for (let k = kWidths[place]; k > 0; --k) this.byte(place);
        else if (place === kLists || place === kTables)
          for (let k = this.number(place) + (place === kTables); k > 0; --k) this.number(place);
        else {
          const stream = streams[place];
          let from = read[place], to = this.at, b;
          do out[to++] = b = stream[from++];
          while (b > 127);
          read[place] = from, this.at = to;
        }
      }
    }
    for (let i = 0; i < streams.length; ++i) if (read[i] > streams[i].length) damaged('there is too little of something');
  }
}

/** The module that was packed. Throws Damaged where it was changed since. */
export function unpack(bytes) {
  let at = kMagic.length;
  const number = (size) => {
    let value = 0;
    for (let i = 0; i < size; ++i) value += (bytes[at++] ?? damaged('it ends too early')) * 256 ** i;
    return value;
  };
  if (!isPacked(bytes)) damaged('it does not begin like one');
  const size = number(4), sum = number(4);
  const parts = kStreams.map((name) => ({ name, size: number(4), packed: number(4), high: number(1) }));
  if (size > kMost || parts.some((p) => p.high > 4) || parts.reduce((n, p) => n + p.size, 0) > size ||
    parts.reduce((n, p) => n + p.packed, at) !== bytes.length)
    damaged('its sizes are not those of its parts');
  const streams = parts.map((p) => unpacked(bytes.subarray(at, at += p.packed), p.size, p.high));
  const [before, after] = streams, code = new Code(new Uint8Array(size), before.length, streams);
  code.out.set(before);
  code.out[code.at++] = 10;
  code.sized(() => {
    for (let n = code.number(kLocals); n > 0; --n) code.sized(() => code.body());
  });
  if (code.at + after.length !== size) damaged('it is not as large as it says');
  code.out.set(after, code.at);
  if (sumOf(code.out) !== sum) damaged('its sum is another one');
  return code.out;
}
