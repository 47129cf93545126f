// SPDX-License-Identifier: Apache-2.0
// node scripts/validate_gltf.mjs FILE…: the report of the Khronos glTF validator on each file.
// Exits 1 if any has errors, 2 for wrong use. The package `gltf-validator` is looked for in
// $GLTF_VALIDATOR (a folder with node_modules), build/node (scripts/setup), and the working folder.
import { createRequire } from 'node:module';
import { readFile } from 'node:fs/promises';
import { basename, resolve } from 'node:path';

function load_validator() {
  const folders = [process.env.GLTF_VALIDATOR, 'build/node', '.'].filter(Boolean);
  for (const folder of folders) {
    try {
      return createRequire(resolve(folder, 'package.json'))('gltf-validator');
    } catch (error) {
      if (error.code !== 'MODULE_NOT_FOUND') throw error;
    }
  }
  console.error('gltf-validator not found: scripts/setup test');
  process.exit(2);
}

const files = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node scripts/validate_gltf.mjs FILE…');
  process.exit(2);
}
const validator = load_validator();
let broken = false;
for (const file of files) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
    uri: basename(file),
    maxIssues: 100,
    writeTimestamp: false,
  });
  const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ` +
              `${numHints} hints`);
  for (const m of messages)
    console.log(`  ${['error', 'warning', 'info', 'hint'][m.severity]} ${m.code} ` +
                `${m.pointer ?? ''}: ${m.message}`);
  broken ||= numErrors > 0;
}
process.exit(broken ? 1 : 0);
