// node --test: what comes out of a packed module is what was packed, and damage is seen.
import assert from 'node:assert';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { load } from '../freiform.js';
import { pack } from '../pack.js';
import { unpack } from '../unpack.js';

const root = new URL('../../../', import.meta.url).pathname;
const modules = process.env.FREIFORM_WASM ?? join(root, 'build-wasm/bin');
const size = (n) => n < 128 ? [n] : [n % 128 | 128, n >> 7];
const section = (id, ...bytes) => [id, ...size(bytes.length), ...bytes];
const name = (s) => [s.length, ...Buffer.from(s)];

// A function of a number, with every kind of what can follow an instruction. Where bytes end it is 7: there is no such instruction.
const code = [
  2, 2, 0x7f, 1, 0x7b,                                              // locals: two i32, a v128
  0x02, 0x40, 0x02, 0x40, 0x20, 0, 0x0e, 2, 0, 1, 1, 0x0b, 0x0b,    // br_table
  0x43, 0, 0, 0x80, 7, 0x1a, 0x44, 0, 0, 0, 0, 0, 0, 0x0b, 7, 0x1a,  // f32.const, f64.const with what looks like `end`
  0xfd, 12, ...Array(16).fill(0x0b), 0x22, 3, 0xfd, 21, 7, 0x1a,    // v128.const, i8x16.extract_lane_s
  0x20, 3, 0x20, 3, 0xfd, 13, ...Array(16).fill(5), 0x1a,           // i8x16.shuffle
  0x41, 8, 0x41, 0xff, 0, 0x3a, 0, 3,                               // i32.store8 of 127 at 8 + 3
  0x41, 8, 0x20, 3, 0xfd, 88, 0, 16, 7, 0x41, 0, 0x41, 32, 0x41, 4, 0xfc, 10, 0, 0,  // v128.store8_lane, memory.copy
  0x42, 0x80, 0x80, 0x80, 0x80, 0x10, 0xa7, 0x1a,                   // i64.const
  0x20, 0, 0x41, 5, 0x41, 0, 0x1c, 1, 0x7f, 0x21, 1,                // select of a type
  0x20, 0, 0x41, 0, 0x11, 0, 0, 0x41, 8, 0x2d, 0, 3, 0x6a, 0x0b,    // call_indirect; i32.load8_u
];
const small = Uint8Array.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0,
  ...section(1, 1, 0x60, 1, 0x7f, 1, 0x7f),
  ...section(3, 2, 0, 0),
  ...section(4, 1, 0x70, 0, 1),
  ...section(5, 1, 0, 2),
  ...section(7, 1, ...name('f'), 0, 1),
  ...section(9, 1, 0, 0x41, 0, 0x0b, 1, 0),
  ...section(10, 2, 7, 0, 0x20, 0, 0x41, 3, 0x6c, 0x0b, ...size(code.length), ...code),
  ...section(0, ...name('note'), 0x0b, 0x0b),
]);
const answer = (bytes) => new WebAssembly.Instance(new WebAssembly.Module(bytes)).exports.f(7);

test('every kind of instruction comes back', () => {
  assert.equal(answer(small), 148);  // 7 times 3, and 127
  const back = unpack(pack(small));
  assert.deepStrictEqual([...back], [...small]);
  assert.equal(answer(back), 148);
});

test('of a packed module that was changed comes the same module or a refusal, at once', async () => {
  const packed = pack(small);
  let refused = 0;
  for (let at = 0; at < packed.length; ++at)
    for (const by of [1, 0x80, 0xff]) {
      const other = Uint8Array.from(packed);
      other[at] ^= by;
      try {
        assert.deepStrictEqual([...unpack(other)], [...small], `byte ${at}`);
      } catch (error) {
        assert.match(error.message, /^a packed module is damaged: /, `byte ${at}`);
        ++refused;
      }
    }
  assert(refused > packed.length, `${refused} of ${3 * packed.length}`);
  for (let end = 8; end < packed.length; ++end) assert.throws(() => unpack(packed.subarray(0, end)), /is damaged/);
  await assert.rejects(load(packed.subarray(0, 50)), { name: 'FreiformError', kind: 'unreadable' });
});

test('the modules were packed whole', { skip: !existsSync(join(modules, 'freiform.packed')) && 'no module is built' }, () => {
  for (const each of ['freiform', 'freiform-curves']) {
    const packed = readFileSync(join(modules, `${each}.packed`)), began = performance.now();
    assert.equal(Buffer.compare(unpack(packed), readFileSync(join(modules, `${each}.wasm`))), 0);
    console.log(`${each}: ${packed.length} bytes, unpacked in ${Math.round(performance.now() - began)} ms`);
    for (let at = 300; at < packed.length; at += packed.length >> 4) {
      const other = Uint8Array.from(packed);
      other[at] ^= 16;
      assert.throws(() => unpack(other), /is damaged/);
    }
  }
});
