// SPDX-License-Identifier: BSD-3-Clause
// Frames a second of the page's map in headless Chromium with software GL, at 1280 x 800: while a hand turns it, while the
// robot drives through it, and the time of one frame with all points at rest.
//   node tests/benchmark/page/frame_rate.mjs build/release/tools/isobar [POINTS, default 2000000] [SCREENSHOT.png]
// Needs chromium, and `npm ci` in tests/integration/web/npm.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const puppeteer = createRequire(new URL('../../integration/web/npm/', import.meta.url))('puppeteer-core');
const [isobar, wanted = '2000000', screenshot] = process.argv.slice(2);
const points = Number(wanted);
const port = 18082;
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Three floors of 64 x 48 m with walls every 8 m, 3 m high: x, y, z, the same for each number. */
function place(random) {
  const floor = Math.floor(3 * random());
  const [u, v] = [64 * random(), 48 * random()];
  const kind = random();
  if (kind < 0.4) return [u, v, 3.5 * floor + 0.005 * random()];
  const up = 3.5 * floor + 3 * random();
  return kind < 0.7 ? [u, 8 * Math.floor(v / 8), up] : [8 * Math.floor(u / 8), v, up];
}

function write_run(folder) {
  let seed = 1;
  const random = () => (seed = (Math.imul(seed, 1_664_525) + 1_013_904_223) >>> 0) / 2 ** 32;
  const head = Buffer.from(`ply\nformat binary_little_endian 1.0\nelement vertex ${points}\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\nend_header\n`);
  const data = new Float32Array(4 * points);
  for (let i = 0; i < points; ++i) data.set([...place(random), 100], 4 * i);
  writeFileSync(join(folder, 'map.ply'), Buffer.concat([head, Buffer.from(data.buffer)]));
  const rows = Array.from({ length: 600 }, (_, i) => `${100 + i / 10} ${4 + i / 12} ${4 + 3 * Math.sin(i / 40)} 0.5 0 0 0 1`);
  writeFileSync(join(folder, 'trajectory.tum'), `${rows.join('\n')}\n`);
}

/** Frames a second of the page, and the longest, from the second second on: the share of points is found in the first. */
const frames_in = (page, seconds) => page.evaluate((seconds) => new Promise((done) => {
  const times = [];
  const frame = (now) => {
    times.push(now);
    if (now - times[0] < 1000 * seconds) requestAnimationFrame(frame);
    else {
      const later = times.filter((time) => time - times[0] > 1000);
      const steps = later.slice(1).map((time, i) => time - later[i]).sort((a, b) => a - b);
      done({ fps: (1000 * steps.length) / (later.at(-1) - later[0]), median_ms: steps[steps.length >> 1], p95_ms: steps[Math.floor(0.95 * steps.length)] });
    }
  };
  requestAnimationFrame(frame);
}), seconds);

const shown = ({ fps, median_ms, p95_ms }) => `${fps.toFixed(1)} frames/s, median ${median_ms.toFixed(0)} ms, 95 % below ${p95_ms.toFixed(0)} ms`;

const folder = mkdtempSync(join(tmpdir(), 'isobar-frames-'));
write_run(folder);
const server = spawn(isobar, ['web', folder, '--port', String(port)], { stdio: ['ignore', 'pipe', 'inherit'] });
await new Promise((resolve) => server.stdout.on('data', (text) => String(text).includes('http') && resolve()));
const browser = await puppeteer.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
try {
  const page = await browser.newPage();
  await page.setViewport({ width: 1280, height: 800 });
  const start_ms = Date.now();
  await page.goto(`http://localhost:${port}/`);
  await page.waitForFunction((least) => {
    const [number, unit] = document.querySelector('.map-foot')?.textContent.split(/\s/) ?? [];
    return Number(number) * ({ k: 1e3, M: 1e6 }[unit] ?? 1) >= least;
  }, { timeout: 60_000 }, 0.99 * points);
  const box = await page.$eval('.map-view canvas', (canvas) => { const { x, y, width, height } = canvas.getBoundingClientRect(); return { x, y, width, height }; });
  console.log(`${await page.$eval('.map-foot', (foot) => foot.textContent)}, map of ${box.width.toFixed(0)} x ${box.height.toFixed(0)} px, there after ${((Date.now() - start_ms) / 1000).toFixed(1)} s`);
  await sleep(3000);

  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(...middle);
  await page.mouse.down();
  const counted = frames_in(page, 6);
  for (const end = Date.now() + 6500, begin = Date.now(); Date.now() < end; await sleep(12)) {
    const angle = (Date.now() - begin) / 700;
    await page.mouse.move(middle[0] + 120 * Math.sin(angle), middle[1] + 40 * Math.cos(angle));
  }
  console.log(`a hand turns the map: ${shown(await counted)}`);
  if (screenshot) await page.screenshot({ path: screenshot.replace(/(\.png)?$/, '-moving.png') });
  await page.mouse.up();
  await sleep(2000);
  if (screenshot) await page.screenshot({ path: screenshot });

  await page.$$eval('button', (buttons) => buttons.find((button) => button.textContent === 'Play' || button.ariaLabel === 'Play').click());
  console.log(`the robot drives: ${shown(await frames_in(page, 6))}`);
} finally {
  await browser.close();
  server.kill();
  rmSync(folder, { recursive: true });
}
