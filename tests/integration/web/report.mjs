// SPDX-License-Identifier: BSD-3-Clause
// Reports and the page of a run in Debian's Chromium: they load nothing from outside, show charts and map, answer to their
// buttons and to the mouse, keep the basics (basics.mjs), and write no error to the console.
//   node report.mjs EVALUATION.html RUN.html NOISE.html URL-OF-RUN
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';

import { check_basics, check_shifts, watch_shifts } from './basics.mjs';

const require = createRequire(new URL('./npm/package.json', import.meta.url));
const puppeteer = require('puppeteer-core');
const [evaluation, run, noise, url_of_run] = process.argv.slice(2);
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

const browser = await puppeteer.launch({
  executablePath: '/usr/bin/chromium',
  headless: true,
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

/** Opens a page, and collects what it must not do. */
async function open(url) {
  const page = await browser.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('console', (message) => message.type() === 'error' && faults.push(message.text()));
  page.on('request', (request) => /^(file|data|blob):/.test(request.url()) || request.url().startsWith(url_of_run) || faults.push(`loads ${request.url()}`));
  await watch_shifts(page);
  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(url);
  return { page, faults };
}

async function check(name, { page, faults }) {
  const shift = await check_shifts(page, name);
  await check_basics(page, name);
  assert.deepEqual(faults, []);
  await page.close();
  console.log(`ok: ${name}, layout shift ${shift}`);
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

try {
  const report = await open(`file://${evaluation}`);
  await report.page.waitForSelector('.curve-chart canvas', { timeout: 10_000 });
  await report.page.$eval('.map-box', (box) => box.scrollIntoView());
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
  await check('report of an evaluation', report);

  for (const [name, url] of [['report of a run', `file://${run}`], ['page of a run', url_of_run]]) {
    const single = await open(url);
    await single.page.waitForSelector('.map-view canvas', { timeout: 10_000 });
    await single.page.waitForFunction(() => /\d[ kM]* points/.test(document.body.innerText), { timeout: 10_000 });
    await check(name, single);
  }

  const samples = await open(`file://${noise}`);
  await samples.page.waitForSelector('.curve-chart canvas', { timeout: 10_000 });
  await check_charts(samples.page, 'noise');
  await check('report of noise', samples);
} catch (error) {
  console.log(`FAILED: ${error.stack}`);
  process.exitCode = 1;
} finally {
  await browser.close();
}
