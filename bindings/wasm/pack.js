// node pack.js FILE.wasm PACKED: a module as unpack.js reads it. Needs `xz`.
//
// Idea. In a module what an instruction does stands beside a number that only it needs: a local, a distance in memory, a
// function. Each is alike from place to place, yet what follows it is not, so that what finds texts again finds short ones.
// With all instructions after each other, then all locals, and so on, it finds long ones, and knows of what kind the next
// number is. Constants are told apart by the instruction after them, which says whether they are addresses.
import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { Bytes } from './order_functions.js';
import { follows, kBytes, kMagic, kStreams, streamOf, sumOf, unpack } from './unpack.js';

// The streams of a module, as lists of bytes.
function split(module) {
  const streams = Object.fromEntries(kStreams.map((name) => [name, []]));
  const file = new Bytes(module);
  const put = (name, from) => { for (let i = from; i < file.at; ++i) streams[name].push(module[i]); };
  const number = (name) => {
    const from = file.at, value = file.number();
    put(name, from);
    return value;
  };
  const bytes = (name, n) => put(name, (file.at += n) - n);
  bytes('before', 8);
  for (let seen = false; !file.ended;) {
    const from = file.at, id = module[file.at++], size = file.number();
    if (id !== 10) {
      file.at += size;
      put(seen ? 'after' : 'before', from);
      continue;
    }
    seen = true;
    for (let functions = number('locals'); functions > 0; --functions) {
      const end = file.number() + file.at;
      for (let n = number('locals'); n > 0; --n) number('locals'), bytes('locals', 1);
      while (file.at < end) {
        bytes('ops', 1);
        const op = module[file.at - 1], begin = file.at, letters = follows(op, op === 0xfc || op === 0xfd ? number('ops') : 0);
        if (letters === undefined) throw new Error(`no instruction: ${op} at ${begin - 1}`);
        const past = after(module, file.at, letters);
        for (const letter of letters) {
          const name = streamOf(letter, module[past]);
          if (kBytes[letter]) bytes(name, kBytes[letter]);
          else if (letter === 's' || letter === 't') for (let n = number(name) + (letter === 't'); n > 0; --n) number(name);
          else number(name);
        }
      }
    }
  }
  return streams;
}

// Where the instruction after a constant begins; for others nobody asks.
function after(module, at, letters) {
  const code = new Bytes(module);
  code.at = at;
  if (letters === 'n') code.number();
  return code.at;
}

function lzma(bytes, high) {
  const done = spawnSync('xz', ['--format=raw', `--lzma1=preset=9e,lc=${high},lp=0,pb=0`, '-c'], { input: bytes, maxBuffer: 1 << 28 });
  if (done.status !== 0) throw new Error(`xz: ${done.error?.message ?? done.stderr}`);
  return done.stdout;
}

export function pack(module) {
  const streams = split(module), number = (value) => [0, 8, 16, 24].map((by) => value >>> by & 255);
  const parts = kStreams.map((name) => {
    const bytes = Uint8Array.from(streams[name]);
    if (bytes.length === 0) return { size: 0, packed: Uint8Array.of(), high: 0 };
    const [best] = [0, 3].map((high) => ({ size: bytes.length, packed: lzma(bytes, high), high }))
      .sort((a, b) => a.packed.length - b.packed.length);
    return best;
  });
  const packed = Buffer.concat([Uint8Array.from([...kMagic, ...number(module.length), ...number(sumOf(module)),
    ...parts.flatMap(({ size, packed, high }) => [...number(size), ...number(packed.length), high])]), ...parts.map((p) => p.packed)]);
  if (Buffer.compare(unpack(packed), module) !== 0) throw new Error('what was packed is not what comes out again');
  return packed;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) writeFileSync(process.argv[3], pack(readFileSync(process.argv[2])));
