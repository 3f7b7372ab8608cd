// SPDX-License-Identifier: BSD-3-Clause
// Saves a figure of a report as PNG, as Debian's Chromium shows it on a light page.
// Usage: node figure.mjs REPORT.html FILE.png CAPTION...     the figures whose captions begin so, below each other;
// "2:CAPTION" is the second that does
import { createRequire } from 'node:module';
import { resolve } from 'node:path';

const require = createRequire(new URL('../../tests/integration/web/npm/package.json', import.meta.url));
const puppeteer = require('puppeteer-core');
const [report, file, ...captions] = process.argv.slice(2);

const browser = await puppeteer.launch({
  executablePath: '/usr/bin/chromium',
  headless: true,
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
try {
  const page = await browser.newPage();
  await page.setViewport({ width: 1000, height: 900, deviceScaleFactor: 1.5 });
  await page.goto(`file://${resolve(report)}`);
  await page.waitForSelector('figure canvas', { timeout: 20_000 });
  await page.evaluate((wanted) => {
    const figures = [...document.querySelectorAll('figure')];
    const chosen = wanted.map((words) => {
      const [, number, caption] = words.match(/^(?:(\d+):)?(.*)$/s);
      return figures.filter((figure) => figure.querySelector('figcaption')?.textContent.startsWith(caption))[(number ?? 1) - 1];
    });
    if (chosen.includes(undefined)) throw new Error(`no figure "${wanted[chosen.indexOf(undefined)]}"`);
    for (const figure of chosen) figure.querySelector('figcaption').remove();
    const place = document.createElement('div');
    place.id = 'picture';
    place.style.cssText = 'padding: 0 14px 10px; background: #fff';
    place.append(...chosen);
    document.body.replaceChildren(place);
  }, captions);
  await new Promise((resolve) => setTimeout(resolve, 1500));  // the map comes to rest
  await (await page.$('#picture')).screenshot({ path: file });
} catch (error) {
  console.error(`figure.mjs: ${report}: ${error.message}`);
  process.exitCode = 65;
} finally {
  await browser.close();
}
