#!/usr/bin/env node
// The commands of freiform where its program is not built: files that arguments name are read into memory, what the
// module makes is written. FREIFORM_WASM names another folder with the module.
import { readFileSync, statSync, writeFileSync, writeSync } from 'node:fs';
import { join } from 'node:path';
import { load } from './freiform.js';

function put(fd, bytes) {
  for (let done = 0; done < bytes.length;) {
    try {
      done += writeSync(fd, bytes, done);
    } catch (error) {
      if (error.code === 'EPIPE') process.exit(5);
      if (error.code !== 'EAGAIN') throw error;
    }
  }
}

const args = process.argv.slice(2);
const files = {};
for (const word of args) {
  const name = word.startsWith('@') ? word.slice(1) : word.startsWith('--') ? word.slice(word.indexOf('=') + 1) : word;
  if (name === '-') files['-'] = readFileSync(0);
  else if (statSync(name, { throwIfNoEntry: false })?.isFile()) files[name] = readFileSync(name);
}
const folder = process.env.FREIFORM_WASM;
const ff = await load(folder ? readFileSync(join(folder, 'freiform.wasm')) : undefined);
const { code, stdout, stderr, files: made } = ff.command(args, files);
let ended = code;
for (const [name, bytes] of Object.entries(made)) {
  try {
    writeFileSync(name, bytes);
  } catch (error) {
    put(2, Buffer.from(`freiform: ${name}: cannot be written: ${error.message}\n`));
    ended = 5;
  }
}
put(1, stdout);
put(2, Buffer.from(stderr));
process.exit(ended);
