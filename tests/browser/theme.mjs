// Light and dark: as the system asks, as the button says, and print in light always.

import assert from 'node:assert/strict';
import test from 'node:test';

import {open} from './support/browser.mjs';
import {run} from './support/runs.mjs';

const paper = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
const light = 'rgb(255, 255, 255)';

test('the page follows the system, and the button overrules it', async () => {
  for (const scheme of ['light', 'dark']) {
    const {page, said} = await open(run('01_spool_simulated').html, {scheme});
    const button = page.getByRole('button', {name: 'Dark colours'});
    const [first] = [await paper(page)];
    assert.equal(first === light, scheme === 'light');
    assert.equal(await button.getAttribute('aria-pressed'), String(scheme === 'dark'));
    await button.click();
    assert.equal(await paper(page) === light, scheme !== 'light');
    assert.equal(await button.getAttribute('aria-pressed'), String(scheme !== 'dark'));
    await button.click();
    assert.equal(await paper(page), first);
    assert.deepEqual(said, []);
    await page.close();
  }
});

test('the drawings follow the theme', async () => {
  const {page} = await open(run('01_spool_simulated').html);
  const strokes = () => page.locator('figure').evaluateAll((all) => all.map((figure) =>
    [...figure.querySelectorAll('text, .frame, .tick')].map((item) => getComputedStyle(item).fill +
                                                            getComputedStyle(item).stroke).join()));
  const before = await strokes();
  await page.emulateMedia({colorScheme: 'dark'});
  const after = await strokes();
  before.forEach((colours, i) => assert.notEqual(colours, after[i], `figure ${i + 1} keeps its colours`));
  await page.close();
});

test('the choice is forgotten with the page', async () => {
  const {page} = await open(run('01_spool_simulated').html);
  await page.getByRole('button', {name: 'Dark colours'}).click();
  assert.notEqual(await paper(page), light);
  await page.reload();
  assert.equal(await paper(page), light);
  await page.close();
});

test('print is light, also of a dark page', async () => {
  const {page} = await open(run('01_spool_simulated').html, {scheme: 'dark'});
  await page.emulateMedia({media: 'print', colorScheme: 'dark'});
  assert.equal(await paper(page), light);
  await page.emulateMedia({media: 'screen', colorScheme: 'light'});
  await page.getByRole('button', {name: 'Dark colours'}).click();
  await page.emulateMedia({media: 'print', colorScheme: 'light'});
  assert.equal(await paper(page), light);
  await page.close();
});
