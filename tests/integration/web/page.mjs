// SPDX-License-Identifier: BSD-3-Clause
// The page as a person sees it. Orders what shall happen to isobard by the FIFO of test_page.sh.
//   node page.mjs URL ECHO.txt ORDERS
import assert from 'node:assert/strict';
import { appendFileSync, existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import net from 'node:net';

import { check_basics, check_shifts, watch_shifts } from './basics.mjs';

const puppeteer = createRequire(new URL('./npm/', import.meta.url))('puppeteer-core');
const [url, echo_file, orders] = process.argv.slice(2);
const order = (word) => appendFileSync(orders, `${word}\n`);
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const ok = (text) => console.log(`ok: ${text}`);

const browser = await puppeteer.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-dev-shm-usage', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
    '--disable-background-networking'],
});
const requests = [];
const errors = [];

async function open(width, height) {
  const page = await browser.newPage();
  await watch_shifts(page);
  await page.setViewport({ width, height });
  page.on('request', (request) => requests.push(request.url()));
  page.on('console', (message) => { if (message.type() === 'error') errors.push(message.text()); });
  page.on('pageerror', (error) => errors.push(`uncaught: ${error.message}`));
  await page.goto(url);
  await page.evaluate(() => (window.not_reloaded = true));
  return page;
}

/** Waits for words in the summary of the page's health. */
async function summary(page, level, words, within_ms) {
  try {
    await page.waitForFunction((level, words) => document.querySelector(`.summary.${level}`)?.textContent.includes(words),
      { timeout: within_ms, polling: 100 }, level, words);
  } catch {
    assert.fail(`no ${level} with "${words}": ${await page.$eval('.summary', (element) => `${element.className} ${element.textContent}`)}`);
  }
}

const shown_pose = (page) => page.$eval('.pose', (pose) =>
  ['x', 'y', 'z'].map((axis) => Number(pose.querySelector(`.pose-${axis} dd`).textContent.replace('−', '-'))));

/** Poses that DDS has delivered: [x, y, z]. */
function dds_poses() {
  return [...readFileSync(echo_file, 'utf8').matchAll(/ x +(\S+) +y +(\S+) +z +(\S+) m/g)].map((match) => match.slice(1, 4).map(Number));
}

/** What the page answers to its actions, once it fits. */
async function told(page, fits, within_ms) {
  try {
    await page.waitForFunction((fits) => new RegExp(fits).test(document.querySelector('.answer').textContent), { timeout: within_ms, polling: 50 }, fits);
  } catch {
    assert.fail(`no answer like "${fits}": ${await page.$eval('.answer', (element) => element.textContent)}`);
  }
  return page.$eval('.answer', (element) => [element.textContent, element.classList.contains('failed')]);
}

const press = (page, label) => page.$$eval('.actions button', (buttons, label) => buttons.find((button) => button.textContent === label).click(), label);

/** Presses all that a person with the token may press, while the robot drives. */
async function press_all(page) {
  await page.type('.actions .token', 'a-token-of-this-test');
  await press(page, 'The robot is here');
  assert.deepEqual(await told(page, 'needed', 8000), ['x, y and yaw are needed.', true]);
  const fields = await page.$$('.actions input[type=number]');
  const yaw = await page.$eval('.pose-yaw dd', (element) => element.textContent.replace('−', '-'));
  for (const [index, value] of [...(await shown_pose(page)).slice(0, 2), yaw].entries()) await fields[index].type(String(value));
  await press(page, 'The robot is here');
  const [hint, is_refused] = await told(page, '^Hint ', 15_000);
  assert.equal(is_refused, hint.includes('refused'), hint);
  await press(page, 'Save the black box');
  const [saved, has_failed] = await told(page, 'aved: ', 15_000);
  assert.ok(!has_failed, saved);
  return { hint, saved };
}

try {
  const page = await open(1000, 800);
  await summary(page, 'error', 'isobard is not running', 5000);
  ok('without isobard the page says so');
  order('start');
  await summary(page, 'stale', 'nothing received yet', 8000);
  ok('it follows isobard without being loaded again');

  await press(page, 'Save the black box');
  assert.deepEqual(await told(page, 'token is', 5000), ['the token is missing or wrong', true]);
  ok('an action without the token is refused, and the page says why');

  order('play');
  const seen = [];
  const has_moved = ([x, y]) => Math.hypot(x, y) > 0.02;
  let pressed = null;
  let is_answered = false;
  // A busy machine shows few poses, and answers late.
  for (const end = Date.now() + 25_000; Date.now() < end && !(is_answered && seen.filter(has_moved).length >= 10); await sleep(100)) {
    const pose = await shown_pose(page);
    const is_on_scan = (await page.$eval('.pose-pose dd', (mode) => mode.textContent)) === 'lidar';
    if (is_on_scan && pose.every(Number.isFinite)) seen.push(pose);
    if (!pressed && seen.length >= 5) pressed = press_all(page).catch((error) => error).finally(() => { is_answered = true; });
  }
  order('unplug');
  const sent = dds_poses();
  const moved = seen.filter(has_moved);
  assert.ok(moved.length >= 3, `only ${moved.length} poses away from the start were shown, of ${seen.length}`);
  // Rounded to 0.01, 0.01 and 0.001 m.
  const agreeing = moved.filter(([x, y, z]) => sent.some((pose) => Math.abs(pose[0] - x) < 0.0065 && Math.abs(pose[1] - y) < 0.0065 && Math.abs(pose[2] - z) < 0.0015));
  // Not all: a busy machine loses messages of DDS. Of poses that are others, none would be among them.
  assert.ok(agreeing.length >= 3 && agreeing.length > 0.5 * moved.length, `${agreeing.length} of ${moved.length} shown poses are among the ${sent.length} that DDS delivered`);
  ok(`${agreeing.length} of ${moved.length} poses shown are among those that DDS delivered`);
  const points = await page.$eval('.map-foot', (foot) => foot.textContent);
  assert.match(points, /[1-9].* points/);
  ok(`the map is there: ${points}`);
  const done = await pressed;
  if (done instanceof Error) throw done;
  const recording = done.saved.match(/\/\S+/)?.[0] ?? '';
  assert.ok(existsSync(`${recording}/recording.toml`), `no recording in "${recording}": ${done.saved}`);
  ok(`actions: "${done.hint}"; "${done.saved}"`);

  await summary(page, 'error', 'silent for', 10_000);
  assert.ok(await page.$$eval('.lights li.error', (entries) => entries.some((entry) => entry.textContent.startsWith('lidar'))));
  await page.waitForFunction(() => document.querySelector('.pose.old .pose-pose dd')?.textContent === 'no pose', { timeout: 8000, polling: 100 });
  ok('an unplugged lidar is red, with the sentence that explains it; the last pose is told to be old');

  const narrow = await open(390, 844);
  await summary(narrow, 'error', 'silent for', 5000);
  const shifts = [await check_shifts(page, 'page'), await check_shifts(narrow, 'page at 390 px')];
  await check_basics(narrow, 'page');
  ok(`a second viewer sees the same, at 390 px, too; the basics hold, layout shift while data come ${shifts.join(', ')}`);
  const answer = await narrow.evaluate(async () => (await fetch('/api/save-black-box', { method: 'POST', headers: { Authorization: 'Bearer wrong' } })).status);
  assert.equal(answer, 401);
  assert.equal(errors.filter((error) => !error.includes('401')).join('\n'), '');
  await narrow.close();
  ok('a wrong token is refused, and until here there was no error on the console');
  const deaf = net.connect(18080, 'localhost', () => deaf.write('GET /api/events HTTP/1.1\r\nHost: localhost\r\n\r\n'));
  deaf.on('error', () => {});
  deaf.pause();

  order('kill');
  await summary(page, 'error', 'not running', 8000);
  order('start');
  await page.waitForFunction(() => !document.body.classList.contains('cut-off'), { timeout: 10_000, polling: 100 });
  await summary(page, 'stale', '', 5000);
  assert.equal(await page.evaluate(() => window.not_reloaded), true);
  ok('it survives a restart of isobard, with a viewer that does not read beside it');
  deaf.destroy();

  const foreign = requests.filter((request) => !request.startsWith(url));
  assert.deepEqual(foreign, []);
  // While isobar web starts again, its events cannot be loaded.
  assert.equal(errors.filter((error) => !/401|ERR_|Failed to load resource/.test(error)).join('\n'), '');
  ok(`nothing of ${requests.length} requests went elsewhere, and no script failed`);
} catch (error) {
  console.log(`FAILED: ${error.message}`);
  process.exitCode = 1;
} finally {
  await browser.close();
}
