// SPDX-License-Identifier: BSD-3-Clause
// Reports in Debian's Chromium: files that load nothing, show charts and map, answer to their buttons and to the mouse,
// fit 390 px, and write no error to the console.
//   node report.mjs EVALUATION.html RUN.html NOISE.html
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';

const require = createRequire(new URL('./npm/package.json', import.meta.url));
const puppeteer = require('puppeteer-core');
const [evaluation, run, noise] = process.argv.slice(2);
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

const browser = await puppeteer.launch({
  executablePath: '/usr/bin/chromium',
  headless: true,
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

/** Opens a file, and collects what it must not do. */
async function open(file) {
  const page = await browser.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('console', (message) => message.type() === 'error' && faults.push(message.text()));
  page.on('request', (request) => /^(file|data|blob):/.test(request.url()) || faults.push(`loads ${request.url()}`));
  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(`file://${file}`);
  return { page, faults };
}

/** Every chart is drawn: its canvas has pixels of its own colours, nothing says that it is missing. */
async function check_charts(page, what) {
  const blank = await page.evaluate(() => [...document.querySelectorAll('.curve-chart, .box-chart')].filter((chart) => {
    const canvas = chart.querySelector('canvas');
    const data = canvas?.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data ?? [];
    return !data.some((value, i) => i % 4 === 1 && data[i + 2] > 200 && Math.abs(value - data[i + 1]) > 60);
  }).length);
  assert.equal(blank, 0, `${what}: charts without a coloured line`);
  const missing = await page.evaluate(() => document.querySelectorAll('.no-chart').length);
  assert.equal(missing, 0, `${what}: charts that are not drawn`);
}

/** The page as wide as the window, at every width. */
async function check_widths(page, what) {
  for (const width of [2560, 1280, 390]) {
    await page.setViewport({ width, height: 900 });
    await wait(300);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= width, `${what}: ${wide} px wide in a window of ${width}`);
  }
}

try {
  const report = await open(evaluation);
  await report.page.waitForSelector('.curve-chart canvas', { timeout: 10_000 });
  await report.page.waitForSelector('.map-view canvas', { timeout: 10_000 });
  const curves = () => report.page.evaluate(() => [...document.querySelectorAll('.chips .chip[aria-pressed="true"]')].length);
  const before = await curves();
  await report.page.click('.chips .chip');
  assert.equal(await curves(), before - 1, 'a click switches a method off');
  await check_charts(report.page, 'report');
  const box = await report.page.$('.box-chart .u-over');
  await box.scrollIntoView();
  const { x, y, width } = await box.boundingBox();
  await report.page.mouse.move(x + width / 2, y + 8);
  await report.page.mouse.move(x + width / 2, y + 12);
  await wait(200);
  const readouts = await report.page.$eval('.box-chart .readout', (readout) => readout.innerText);
  assert.match(readouts, /median .* %/, 'values of a box under the cursor');
  await check_widths(report.page, 'report');
  assert.deepEqual(report.faults, []);

  const single = await open(run);
  await single.page.waitForSelector('.map-view canvas', { timeout: 10_000 });
  await single.page.waitForFunction(() => /points/.test(document.body.innerText), { timeout: 10_000 });
  await check_widths(single.page, 'run');
  assert.deepEqual(single.faults, []);

  const samples = await open(noise);
  await samples.page.waitForSelector('.curve-chart canvas', { timeout: 10_000 });
  await check_charts(samples.page, 'noise');
  await check_widths(samples.page, 'noise');
  assert.deepEqual(samples.faults, []);
  console.log('ok: three reports');
} catch (error) {
  console.log(`FAILED: ${error.stack}`);
  process.exitCode = 1;
} finally {
  await browser.close();
}
