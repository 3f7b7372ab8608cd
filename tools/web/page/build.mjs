// SPDX-License-Identifier: BSD-3-Clause
// Bundles src/main.ts into OUT/page.js and OUT/page.css, src/charts.ts and src/report.ts into OUT/charts.* and
// OUT/report.*, copies the files that need no bundling, and compresses all.
// Usage, in the folder of node_modules: node build.mjs OUT
import { build } from 'esbuild';
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

const source = join(dirname(fileURLToPath(import.meta.url)), 'src');
const out = process.argv[2];
if (!out) throw new Error('usage: node build.mjs OUT');
mkdirSync(out, { recursive: true });
// The licences of the bundled libraries go with every copy.
const licences = ['three', 'uplot'].map((name) => `${name}: ${readFileSync(join('node_modules', name, 'LICENSE'), 'utf8').trim()}`);
await build({
  entryPoints: { page: join(source, 'main.ts'), charts: join(source, 'charts.ts'), report: join(source, 'report.ts') },
  outdir: out,
  bundle: true,
  minify: true,
  format: 'iife',
  target: ['chrome109', 'firefox115', 'safari16'],
  legalComments: 'none',
  footer: { js: `/*\n${licences.join('\n\n')}\n*/` },
  logLevel: 'warning',
});
for (const file of ['index.html', 'icon.svg']) copyFileSync(join(source, file), join(out, file));
for (const file of ['index.html', 'icon.svg', 'page.js', 'page.css', 'charts.js', 'charts.css', 'report.js', 'report.css']) {
  writeFileSync(join(out, `${file}.gz`), gzipSync(readFileSync(join(out, file)), { level: 9 }));
}
