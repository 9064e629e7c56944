// The pictures of the report, as .ci/make_pictures.sh asks for them.

import {cpSync} from 'node:fs';
import {join} from 'node:path';
import test from 'node:test';

import {open} from '../tests/browser/support/browser.mjs';
import {rondure, run} from '../tests/browser/support/runs.mjs';

const place = (name) => join(process.env.RONDURE_PICTURES, name);
const spool = () => run('01_spool_simulated', ['--serial', '0042']);

async function picture(name, html, options, what) {
  const {page} = await open(html, options);
  await (what ? page.locator(what).first() : page).screenshot({path: place(`${name}.png`)});
  await page.close();
}

const screen = {width: 960, height: 1180};
test('screen', () => picture('screen', spool().html, screen));
test('dark', () => picture('dark', spool().html, {...screen, scheme: 'dark'}));
test('narrow', () => picture('narrow', spool().html, {width: 360, height: 900}));
test('solid', () => picture('solid', spool().html, screen, 'figure.solid'));
test('map', () => picture('map', spool().html, screen, 'figure:has([aria-label^="Deviations on the unrolled"])'));

// From the call-outs of seat C to the first of face E.
test('drawing', async () => {
  const {page} = await open(run('15_shaft_points_file').html, screen);
  const rows = page.locator('table.results tbody tr');
  const from = await rows.filter({hasText: 'coaxiality 10'}).first().boundingBox();
  const behind = await rows.filter({hasText: 'square 8'}).first().boundingBox();
  const clip = {x: 24, y: from.y - 10, width: 912, height: behind.y - from.y};
  await page.screenshot({path: place('drawing.png'), fullPage: true, clip});
  await page.close();
});

test('print', async () => {
  const {page} = await open(spool().html);
  await page.emulateMedia({media: null});
  await page.pdf({path: place('print.pdf'), format: 'A4', printBackground: true});
  await page.close();
});

test('chinese', async () => {
  const copy = `${spool().directory}-zh`;
  cpSync(spool().directory, copy, {recursive: true});
  rondure(['report', copy, '--format', 'html', '--lang', 'zh']);
  await picture('chinese', join(copy, 'report.html'), screen);
});
