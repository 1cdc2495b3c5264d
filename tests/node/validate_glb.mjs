// Prints what the Khronos validator says about each file; exit code 1 if it has found an error or a warning.
import { readFile } from 'node:fs/promises';
import validator from 'gltf-validator';

let bad = false;
for (const file of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), { maxIssues: 20 });
  const { numErrors, numWarnings, messages } = report.issues;
  for (const m of messages) console.log(`${file}: ${['error', 'warning', 'info', 'hint'][m.severity]} ${m.code} ${m.pointer}: ${m.message}`);
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${report.info.totalTriangleCount ?? 0} triangles, ` +
              `${report.info.totalVertexCount ?? 0} vertices`);
  bad ||= numErrors + numWarnings > 0;
}
process.exit(bad ? 1 : 0);
