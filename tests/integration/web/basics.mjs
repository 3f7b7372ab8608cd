// SPDX-License-Identifier: BSD-3-Clause
// What every page and report keeps: WCAG 2.2 A and AA by axe-core, contrast included, in light and dark, at every width;
// nothing wider than the window; nothing that moves by itself while data come.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const require = createRequire(new URL('./npm/', import.meta.url));
const axe_source = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
const kTags = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa'];
export const kWidths = [2560, 1280, 390];
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Sums the layout shifts of a page; call it before goto. */
export async function watch_shifts(page) {
  await page.evaluateOnNewDocument(() => {
    window.shifts = [];
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries()) {
        if (entry.hadRecentInput) continue;
        const parts = entry.sources.map(({ node }) => node?.className || node?.nodeName || '?');
        window.shifts.push({ value: entry.value, parts });
      }
    }).observe({ type: 'layout-shift', buffered: true });
  });
}

/** Asserts that what has moved by itself stays far below 0.1, which Lighthouse calls good; tells the sum. */
export async function check_shifts(page, what, most = 0.01) {
  const shifts = await page.evaluate(() => window.shifts);
  const sum = shifts.reduce((total, { value }) => total + value, 0);
  assert.ok(sum < most, `${what}: layout shift ${sum.toFixed(4)}: ${JSON.stringify(shifts)}`);
  return sum.toFixed(4);
}

/** Width of the page, once its charts follow the window: on a busy machine that takes longer. */
async function settled_width(page, width) {
  const read = () => page.evaluate(() => document.documentElement.scrollWidth);
  for (const end = Date.now() + 5000; Date.now() < end && (await read()) > width;) await wait(100);
  return read();
}

/** @param theme dark: another theme changes colours only, so that contrast alone is looked at again */
async function violations(page, theme) {
  if (!(await page.evaluate(() => 'axe' in window))) await page.evaluate(axe_source);
  const only = theme === 'dark' ? { type: 'rule', values: ['color-contrast'] } : { type: 'tag', values: kTags };
  const result = await page.evaluate((runOnly) => window.axe.run({ runOnly, resultTypes: ['violations'] }), only);
  return result.violations.map(({ id, nodes }) => `${id}: ${nodes.slice(0, 6).map(({ target, any }) => `${target.join(' ')} (${any[0]?.message ?? ''})`).join('; ')}`);
}

/** Asserts the basics of a page that shows its data. */
export async function check_basics(page, what, height = 900) {
  const found = [];
  for (const width of kWidths) {
    await page.setViewport({ width, height });
    for (const theme of ['light', 'dark']) {
      await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: theme }]);
      await wait(120);
      const wide = await settled_width(page, width);
      if (wide > width) found.push(`${width} px ${theme}: ${wide} px wide`);
      found.push(...(await violations(page, theme)).map((text) => `${width} px ${theme}: ${text}`));
    }
  }
  assert.equal(found.join('\n'), '', what);
}
