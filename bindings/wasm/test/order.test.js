// node --test: a module whose functions have another order does the same.
import assert from 'node:assert';
import { test } from 'node:test';
import { ordered } from '../order_functions.js';

const section = (id, ...bytes) => [id, bytes.length, ...bytes];
const body = (...code) => [code.length + 2, 0, ...code, 0x0b];
const name = (s) => [s.length, ...Buffer.from(s)];
const text = [0x43, 0x10, 0x10, 0x10, 0x10, 0x1a];  // f32.const of what looks like calls; drop

// Imported: 0. Its own: 1 calls the import and 3, and is larger than 3; 2 is the largest, asks the table; 3 is 7,
// after a text that 2 has, too. The table is [1, 3]; `all` is 1, `asked` is 2; the start is 4, which calls the import.
const small = Uint8Array.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0,
  ...section(0, ...name('note'), 1),
  ...section(1, 2, 0x60, 0, 1, 0x7f, 0x60, 0, 0),
  ...section(2, 1, ...name('m'), ...name('five'), 0, 0),
  ...section(3, 4, 0, 0, 0, 1),
  ...section(4, 1, 0x70, 0, 2),
  ...section(7, 2, ...name('all'), 0, 1, ...name('asked'), 0, 2),
  ...section(8, 4),
  ...section(9, 1, 0, 0x41, 0, 0x0b, 2, 1, 3),
  ...section(10, 4,
    ...body(0x10, 0, 0x10, 3, 0x6a, ...Array(20).fill(0x01)),
    ...body(...text, ...text, ...text, 0x41, 1, 0x11, 0, 0, 0x41, 0, 0x11, 0, 0, 0x6a),
    ...body(...text, ...text, 0x41, 7),
    ...body(0x10, 0, 0x1a)),
]);

function answers(bytes) {
  let calls = 0;
  const { exports } = new WebAssembly.Instance(new WebAssembly.Module(bytes), { m: { five: () => (++calls, 5) } });
  return [calls, exports.all(), exports.asked()];
}

test('functions in another order are called by their new numbers, from everywhere', () => {
  const now = ordered(small);
  assert.notDeepStrictEqual([...now].slice(-60), [...small].slice(-60));
  assert.deepStrictEqual(answers(small), [1, 12, 19]);
  assert.deepStrictEqual(answers(now), [1, 12, 19]);
});

test('the largest function comes first, then the one that shares its text', () => {
  const at = (bytes, part) => Buffer.from(bytes).indexOf(Buffer.from(part));
  const now = ordered(small), largest = at(now, [...text, ...text, ...text]), sharing = at(now, [...text, ...text, 0x41, 7]);
  assert(0 < largest && largest < sharing && sharing < at(now, [27, 0, 0x10]), `${largest}, ${sharing}`);
});

test('a small function that is called often has a number of one byte', () => {
  const leb = (n) => n < 128 ? [n] : [n & 127 | 128, ...leb(n >> 7)];
  const long = (id, bytes) => [id, ...leb(bytes.length), ...bytes];
  const whole = (...code) => [...leb(code.length + 2), 0, ...code, 0x0b];
  const others = Array.from({ length: 200 }, (_, i) => whole(...Array(30).fill(0x01), 0x41, i % 60, 0x41, i % 7, 0x6a));
  const many = whole(0x41, 0, ...Array(300).fill([0x10, ...leb(201), 0x6a]).flat());
  const given = Uint8Array.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, ...section(1, 1, 0x60, 0, 1, 0x7f),
    ...long(3, [...leb(202), ...Array(202).fill(0)]), ...section(7, 1, ...name('all'), 0, 0),
    ...long(10, [...leb(202), ...many, ...others.flat(), ...whole(0x41, 5)])]);
  const now = ordered(given);
  assert.strictEqual(new WebAssembly.Instance(new WebAssembly.Module(now)).exports.all(), 1500);
  assert.strictEqual(now.length, given.length - 300);
});

test('alignments are no reason for code to differ', () => {
  const loads = (hint) => Uint8Array.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0,
    ...section(1, 1, 0x60, 0, 1, 0x7f), ...section(3, 1, 0), ...section(5, 1, 0, 1), ...section(7, 1, ...name('all'), 0, 0),
    ...section(10, 1, ...body(0x41, 8, 0x41, 5, 0x36, hint, 16, 0x41, 8, 0x28, hint, 16,
      0x41, 0, 0xfd, 0, hint, 24, 0xfd, 0x1b, 0, 0x6a))]);
  const one = ordered(loads(2)), other = ordered(loads(1));
  assert.deepStrictEqual(one, other);
  assert.strictEqual(new WebAssembly.Instance(new WebAssembly.Module(one)).exports.all(), 10);
});

test('a module with instructions that are not known is refused', () => {
  const bad = Uint8Array.from(small);
  bad[bad.length - 2] = 0xff;
  assert.throws(() => ordered(bad), /no instruction: 0xff/);
});

test('locals that are used most have the first numbers of their type, and those of no use are gone', () => {
  // (x: i32) => i32 with locals 1: f64, 2: i64, of no use, 3 and 4: i32; 4 is used most.
  const code = [0x20, 0, 0x41, 5, 0x6a, 0x21, 4, 0x20, 4, 0xb7, 0x22, 1, 0xaa, 0x22, 3, 0x20, 4, 0x6a, 0x20, 4, 0x6a];
  const given = Uint8Array.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, ...section(1, 1, 0x60, 1, 0x7f, 1, 0x7f),
    ...section(3, 1, 0), ...section(7, 1, ...name('f'), 0, 0),
    ...section(10, 1, code.length + 8, 3, 1, 0x7c, 1, 0x7e, 2, 0x7f, ...code, 0x0b)]);
  const now = ordered(given);
  const f = (bytes) => new WebAssembly.Instance(new WebAssembly.Module(bytes)).exports.f;
  for (const x of [0, 7, -100]) assert.deepStrictEqual([f(given)(x), f(now)(x)], [3 * (x + 5), 3 * (x + 5)]);
  assert(Buffer.from(now).includes(Buffer.from([2, 2, 0x7f, 1, 0x7c, 0x20, 0, 0x41, 5, 0x6a, 0x21, 1, 0x20, 1, 0xb7, 0x22, 3])));
});
