// Print: no figure is cut, on A4 and on Letter.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {join} from 'node:path';
import test from 'node:test';

import {open} from './support/browser.mjs';
import {folder, run} from './support/runs.mjs';

const papers = {A4: [595, 842], Letter: [612, 792]};

/// Words of a PDF file with their places, page by page [pt].
function wordsOf(file) {
  const text = execFileSync('pdftotext', ['-bbox', file, '-'], {encoding: 'utf8', maxBuffer: 1e8});
  return text.split('<page ').slice(1).map((page) => ({
    size: /width="([\d.]+)" height="([\d.]+)"/.exec(page).slice(1).map(Number),
    words: [...page.matchAll(/<word xMin="([\d.-]+)" yMin="([\d.-]+)" xMax="([\d.-]+)" yMax="([\d.-]+)">([^<]*)</g)]
      .map((m) => ({x0: +m[1], y0: +m[2], x1: +m[3], y1: +m[4], text: m[5]})),
  }));
}

/// Puts a word into the upper left and the lower right corner of every drawing that print shows.
const mark = (page) => page.evaluate(() => {
  const drawings = [...document.querySelectorAll('figure svg[role]')]
    .filter((svg) => !svg.closest('.screen-only, details:not([open])'));
  drawings.forEach((svg, i) => {
    const {width, height} = svg.viewBox.baseVal;
    for (const [name, x, y, anchor] of [['qa', 0, 7, 'start'], ['qz', width, height - 1, 'end']]) {
      const text = document.createElementNS('http://www.w3.org/2000/svg', 'text');
      text.setAttribute('x', x);
      text.setAttribute('y', y);
      text.setAttribute('text-anchor', anchor);
      text.setAttribute('style', 'font-size:7px');
      text.textContent = `${name}${i}q`;
      svg.append(text);
    }
  });
  return [...drawings].map((svg) => svg.viewBox.baseVal.height / svg.viewBox.baseVal.width);
});

for (const plan of ['01_spool_simulated', '03_calibrate_fixture', '05_spindle_three_probe', '06_wheel', '07_crank_pin',
                    '11_pose_search_as_published', '15_shaft_points_file']) {
  test(`no figure of ${plan} is cut on A4 or Letter`, async () => {
    const {page} = await open(run(plan).html, {scheme: 'dark'});
    await page.emulateMedia({media: null, colorScheme: 'dark'});
    const ratios = await mark(page);
    assert.ok(ratios.length > 0);
    for (const [paper, [width, height]] of Object.entries(papers)) {
      const file = join(folder, `${plan}-${paper}.pdf`);
      await page.pdf({path: file, format: paper, printBackground: true});
      const pages = wordsOf(file);
      for (const {size, words} of pages) {
        assert.ok(Math.abs(size[0] - width) < 2 && Math.abs(size[1] - height) < 2, `${paper} is ${size}`);
        for (const word of words) {
          assert.ok(word.x0 >= 0 && word.x1 <= width && word.y0 >= 0 && word.y1 <= height, `${word.text} is cut off`);
        }
      }
      ratios.forEach((ratio, i) => {
        const places = [`qa${i}q`, `qz${i}q`].map((name) => {
          const at = pages.findIndex(({words}) => words.some((word) => word.text === name));
          assert.notEqual(at, -1, `${name} is not on paper`);
          return {at, ...pages[at].words.find((word) => word.text === name)};
        });
        assert.equal(places[0].at, places[1].at, `drawing ${i + 1} is on two pages of ${paper}`);
        const drawn = (places[1].y1 - places[0].y0) / (places[1].x1 - places[0].x0);
        assert.ok(Math.abs(drawn / ratio - 1) < 0.08, `drawing ${i + 1} is squeezed: ${drawn} for ${ratio}`);
      });
      const headings = await page.evaluate(() => [...document.querySelectorAll('h2, h3')]
        .filter((one) => !one.closest('.screen-only, details:not([open])')).map((one) => one.textContent.replace(/\s+/g, '')));
      pages.slice(0, -1).forEach(({size, words}, i) => {
        const body = words.filter(({y1}) => y1 < size[1] - 36);
        const last = Math.max(...body.map(({y1}) => y1));
        const line = body.filter(({y1}) => last - y1 < 3).map(({text}) => text).join('');
        assert.ok(!headings.includes(line), `page ${i + 1} of ${paper} ends with the heading ${line}`);
      });
      assert.ok(!pages.some(({words}) => words.some(({text}) => ['Reset', 'Contents'].includes(text))),
                'what is for the screen is on paper');
    }
    await page.close();
  });
}

/// Words of each page of a PDF file.
const textsOf = (file) => execFileSync('pdftotext', ['-layout', file, '-'], {encoding: 'utf8', maxBuffer: 1e8})
  .split('\f').slice(0, -1);

for (const [plan, most] of [['01_spool_simulated', 3], ['15_shaft_points_file', 6]]) {
  test(`${plan} has at most ${most} pages, and page one alone says what is signed`, async () => {
    const {page} = await open(run(plan).html);
    await page.emulateMedia({media: null});
    for (const paper of Object.keys(papers)) {
      const file = join(folder, `${plan}-pages-${paper}.pdf`);
      await page.pdf({path: file, format: paper, printBackground: true});
      const texts = textsOf(file);
      assert.ok(texts.length <= most, `${texts.length} pages of ${paper}`);
      texts.forEach((text) => assert.equal(/SIMULATED/.test(text), plan.includes('simulated')));
      for (const words of [/ of \d+ conforms?[.;]/, /Measured/, /Rule/, /Uncertainty/, /Not seen/, /signature/, /rondure verify/])
        assert.match(texts[0], words);
    }
    await page.close();
  });
}
