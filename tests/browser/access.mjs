// Everybody can read it: axe-core finds nothing serious in light and in dark, headings are in order, the
// keyboard reaches everything, and a narrow screen needs no scrolling sideways.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import test from 'node:test';

import {axePath, open} from './support/browser.mjs';
import {run} from './support/runs.mjs';

const axe = readFileSync(axePath, 'utf8');
const full = process.env.RONDURE_FULL !== undefined;
// One page of each structure; the scanned shaft has none that is not in the drawing of 15 too.
const plans = ['01_spool_simulated', '03_calibrate_fixture', '04_part_in_two_poses', '05_spindle_three_probe',
               '06_wheel', '07_crank_pin', ...(full ? ['08_shaft_scanned'] : []), '15_shaft_points_file'];

// Colours do not change with the width, and nothing but colours with the scheme: contrast, which takes axe most of its
// time, is measured once a scheme and the rest once a width, or with RONDURE_FULL=1 everything in every view.
const contrast = 'color-contrast';
const views = [{scheme: 'light', width: 1000, rules: {}},
               {scheme: 'dark', width: 1000, rules: full ? {} : {runOnly: [contrast]}},
               {scheme: 'light', width: 360, rules: full ? {} : {rules: {[contrast]: {enabled: false}}}}];

/// What axe finds by its rules, one line each, of the impacts that are asked for.
async function findings(page, impacts, rules) {
  const {violations} = await page.evaluate((asked) => axe.run({resultTypes: ['violations'], elementRef: false, ...asked}),
                                           rules);
  return violations.filter((v) => impacts.includes(v.impact))
    .map((v) => `${v.impact}: ${v.id}: ${v.nodes.length} times, first ${v.nodes[0].html.slice(0, 160)}`);
}

/// Until the page has been laid out anew, its script has heard of it, and that was drawn too.
async function drawn(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/// Headings that leave out a level, and what has no name.
async function structure(page) {
  const levels = await page.locator('h1, h2, h3, h4, [role=heading]').evaluateAll((all) => all.map(
      (h) => Number(h.getAttribute('aria-level') ?? h.tagName[1])));
  assert.equal(levels[0], 1);
  levels.slice(1).forEach((level, i) => assert.ok(level >= 2 && level <= levels[i] + 1, `${levels}`));
  assert.equal(await page.locator('table:not(:has(> caption))').count(), 0);
  assert.equal(await page.locator('th:not([scope])').count(), 0);
  assert.equal(await page.locator('figure:not(:has(figcaption))').count(), 0);
  assert.equal(await page.locator('svg:not([aria-label]):not([aria-hidden])').count(), 0);
}

for (const plan of plans) {
  test(`the page of ${plan}: headings in order, names, nothing that axe finds serious in light, dark and narrow, 360 px`,
       async () => {
    const {page} = await open(run(plan).html);
    await structure(page);
    await page.evaluate(axe);
    for (const {scheme, width, rules} of views) {
      await page.setViewportSize({width, height: 800});
      await page.emulateMedia({colorScheme: scheme});
      await drawn(page);
      assert.deepEqual(await findings(page, ['critical', 'serious', 'moderate'], rules), [], `${scheme}, ${width} px`);
      const [wide, seen] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
      assert.ok(wide <= seen, `${wide} px wide at ${width} px`);
    }
    await page.close();
  });
}

test('the keyboard passes the contents, reaches the theme, the cylinder and what scrolls', async () => {
  const {page} = await open(run('01_spool_simulated').html, {width: 360, height: 700});
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Skip to the result');
  assert.ok(await page.evaluate(() => document.activeElement.getBoundingClientRect().left >= 0), 'it is seen');
  const reached = [];
  for (let i = 0; i < 60; i++) {
    await page.keyboard.press('Tab');
    const here = await page.evaluate(() => {
      const item = document.activeElement;
      const outline = getComputedStyle(item).outlineStyle;
      return item === document.body ? null : {what: `${item.tagName} ${item.className.baseVal ?? item.className}`, outline};
    });
    if (!here) break;
    assert.notEqual(here.outline, 'none', `${here.what} shows no focus`);
    reached.push(here.what);
  }
  for (const what of ['A ', 'BUTTON theme', 'svg wide turn', 'DIV scroll']) {
    assert.ok(reached.some((one) => one.startsWith(what)), `${what} is not reached: ${reached}`);
  }
  await page.close();
});
