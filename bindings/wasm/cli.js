#!/usr/bin/env node
// The commands of freiform where its program is not built: files that arguments name are read into memory, what the
// module makes is written. FREIFORM_WASM names another folder with the module.
import { readFileSync, readdirSync, statSync, writeFileSync, writeSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { filesNamedIn, load } from './freiform.js';

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

const isFile = (name) => statSync(name, { throwIfNoEntry: false })?.isFile();

// What has the name but for capital letters.
function alike(name) {
  const folder = dirname(name), last = basename(name).toLowerCase();
  const found = isFile(folder) === false && readdirSync(folder).find((other) => other.toLowerCase() === last);
  return found && join(folder, found);
}

// The file, and those beside it that a STEP file says parts are in.
function take(name, file = name) {
  if (Object.hasOwn(files, name) || !file || !isFile(file)) return;
  files[name] = readFileSync(file);
  if (!/\.(stp|step|p21)$/i.test(name)) return;
  const folder = name.slice(0, name.lastIndexOf('/') + 1);
  for (const path of filesNamedIn(files[name])) take(folder + path, isFile(folder + path) ? folder + path : alike(folder + path));
}

for (const word of args) {
  const name = word.startsWith('@') ? word.slice(1) : word.startsWith('--') ? word.slice(word.indexOf('=') + 1) : word;
  if (name === '-') files['-'] = readFileSync(0);
  else take(name);
}
const folder = process.env.FREIFORM_WASM;
const ff = await load(folder ? readFileSync(join(folder, 'freiform.packed')) : undefined);
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
