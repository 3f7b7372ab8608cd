// SPDX-License-Identifier: BSD-3-Clause
// Reports and the page of a run in Debian's Chromium: they load nothing from outside, show curves and map, answer to their
// buttons, keep the basics (basics.mjs), and write no error to the console.
//   node report.mjs EVALUATION.html RUN.html URL-OF-RUN
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';

import { check_basics, check_shifts, watch_shifts } from './basics.mjs';

const require = createRequire(new URL('./npm/package.json', import.meta.url));
const puppeteer = require('puppeteer-core');
const [evaluation, run, url_of_run] = process.argv.slice(2);

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

try {
  const report = await open(`file://${evaluation}`);
  await report.page.waitForSelector('.distance-chart canvas', { timeout: 10_000 });
  await report.page.$eval('.map-box', (box) => box.scrollIntoView());
  await report.page.waitForSelector('.map-view canvas', { timeout: 10_000 });
  const curves = () => report.page.evaluate(() => [...document.querySelectorAll('.chips .chip[aria-pressed="true"]')].length);
  const before = await curves();
  await report.page.click('.chips .chip');
  assert.equal(await curves(), before - 1, 'a click switches a method off');
  const visible = await report.page.evaluate(() => [...document.querySelectorAll('.static-only')].some((e) => e.offsetHeight > 0));
  assert.ok(!visible, 'pictures give way to what moves');
  await check('report of an evaluation', report);

  for (const [name, url] of [['report of a run', `file://${run}`], ['page of a run', url_of_run]]) {
    const single = await open(url);
    await single.page.waitForSelector('.map-view canvas', { timeout: 10_000 });
    await single.page.waitForFunction(() => /\d points/.test(document.body.innerText), { timeout: 10_000 });
    await check(name, single);
  }
} catch (error) {
  console.log(`FAILED: ${error.stack}`);
  process.exitCode = 1;
} finally {
  await browser.close();
}
