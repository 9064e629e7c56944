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

const screen = {width: 1100, height: 1180};
test('screen', () => picture('screen', spool().html, screen));
test('dark', () => picture('dark', spool().html, {...screen, scheme: 'dark'}));
test('narrow', () => picture('narrow', spool().html, {width: 360, height: 900}));
test('solid', () => picture('solid', spool().html, screen, 'figure.solid'));
test('map', () => picture('map', spool().html, screen, 'figure:has([aria-label^="Deviations on the unrolled"])'));

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
