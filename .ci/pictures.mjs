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

// Page one with the numbers of docs/reading-the-report.md.
test('reading', async () => {
  const {page} = await open(spool().html, {width: 1100, height: 1400});
  const bottom = await page.evaluate(() => {
    const one = (selector) => document.querySelector(selector);
    const every = (selector) => [...document.querySelectorAll(selector)];
    every('header.top').forEach((bar) => bar.remove());
    one('table.results').style.marginTop = '32px';
    const columns = every('table.results th').filter(
      (cell) => ['Call-out', 'Value', 'U', 'Share of the limit', 'Worst at'].includes(cell.textContent));
    const put = (number, left, top) => {
      const mark = document.body.appendChild(document.createElement('div'));
      mark.textContent = number;
      mark.style.cssText = `position:absolute;left:${left}px;top:${top}px;width:22px;height:22px;border-radius:50%;` +
        'background:#b00060;color:#fff;font:bold 13px/22px sans-serif;text-align:center;z-index:9';
    };
    let number = 0;
    for (const part of [one('.ident'), one('.word'), one('.banner'), ...columns, ...every('.worst-one figure'),
                        ...every('dl.lines > div'), one('.sign-box'), one('.foot dl')]) {
      const box = part.getBoundingClientRect();
      const text = document.createRange();
      text.selectNodeContents(part);
      const words = text.getBoundingClientRect();
      if (columns.includes(part)) put(++number, words.left, box.top - 20);
      else if (part.matches('.word, .banner')) put(++number, words.right + 8, words.top);
      else put(++number, box.left - 26, box.top);
    }
    return one('.foot').getBoundingClientRect().bottom;
  });
  await page.screenshot({path: place('reading.png'), clip: {x: 0, y: 0, width: 1100, height: bottom + 20}});
  await page.close();
});
