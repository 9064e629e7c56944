// The page of `rondure run --watch`: it follows a simulated run, its button stops the run after a
// question, it says when the program is gone, and everybody can read it.

import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import test, {after} from 'node:test';

import {axePath, open} from './support/browser.mjs';
import {folder} from './support/runs.mjs';

const axe = readFileSync(axePath, 'utf8');
const started = [];
after(() => { for (const run of started) run.kill('SIGKILL'); });

/// Starts a run that somebody can watch; gives {url, directory, ended: its exit status, kill}.
async function watch(plan, speed, more = []) {
  const directory = join(folder, `watched-${started.length + 1}`);
  const run = spawn(process.env.RONDURE_BINARY,
      ['run', join(process.env.RONDURE_SOURCE_DIR, 'plans/examples', plan), '--out', directory, '--archive', 'none',
       '--watch', '--speed', String(speed), ...more], {stdio: ['ignore', 'ignore', 'pipe']});
  started.push(run);
  const ended = new Promise((done) => run.on('exit', (status) => done(status)));
  const url = await new Promise((found, failed) => {
    let told = '';
    run.stderr.on('data', (text) => {
      told += text;
      const address = told.match(/http:\S+/);
      if (address) found(address[0]);
    });
    run.on('exit', () => failed(new Error(`no page: ${told}`)));
  });
  return {url, directory, ended, kill: () => run.kill('SIGKILL')};
}

const words = (page, id) => page.locator(`#${id}`).innerText();
const touches = async (page) => Number((await words(page, 'now')).match(/(\d+) of \d+/)?.[1] ?? 0);

/// What axe finds of serious and critical impact. Injected past the policy of the page, as a
/// debugger would.
async function findings(page) {
  const {violations} = await page.evaluate(`${axe}; axe.run({resultTypes: ['violations'], elementRef: false})`);
  return violations.filter((v) => ['serious', 'critical'].includes(v.impact))
    .map((v) => `${v.id}: ${v.nodes.length} times, first ${v.nodes[0].html.slice(0, 160)}`);
}

test('the page follows the run and shows its verdict', async () => {
  const run = await watch('01_spool_simulated.json', 10);  // slow enough for a browser that starts, and axe that looks, slowly
  const {page, said} = await open(run.url, {online: true});
  await page.waitForSelector('#drawing svg.polar');
  const before = await touches(page);
  await page.waitForFunction((n) => Number(document.getElementById('now').innerText.match(/(\d+) of \d+/)?.[1]) > n,
                             before + 5);
  assert.match(await words(page, 'now'), /f of this pose[\s\S]*µm/);
  assert.match(await words(page, 'now'), /Time left/);
  assert.equal(await page.locator('button#stop').count(), 0, 'read-only');
  assert.ok(await page.locator('#touches tbody tr').count() > 5);
  for (const scheme of ['light', 'dark']) {
    await page.emulateMedia({colorScheme: scheme});
    assert.deepEqual(await findings(page), [], scheme);
  }
  await page.waitForSelector('#result .verdict', {timeout: 60000});
  assert.match(await words(page, 'result'), /Conforms/);
  assert.match(await words(page, 'now'), /Run finished/);
  assert.equal(await run.ended, 0);
  await page.waitForTimeout(1500);  // nothing may call it lost: nothing is asked any more
  assert.equal(await page.locator('#lost').isVisible(), false);
  assert.deepEqual(await findings(page), [], 'at its end');
  assert.deepEqual(said, []);
  await page.close();
});

test('the button stops the run after a question, by keyboard alone', async () => {
  const run = await watch('11_pose_search_as_published.json', 60, ['--control']);
  const {page, said} = await open(run.url, {online: true});
  const button = page.locator('button#stop');
  await button.waitFor({state: 'visible'});
  await page.waitForSelector('#drawing svg.polar');
  await button.focus();
  await page.keyboard.press('Enter');
  const question = page.locator('dialog#question');
  assert.equal(await question.isVisible(), true);
  assert.equal(await page.evaluate(() => document.activeElement.id), 'no', 'the harmless answer has the focus');
  assert.deepEqual(await findings(page), []);
  await page.keyboard.press('Escape');
  assert.equal(await question.isVisible(), false);
  const before = await touches(page);
  await page.waitForFunction((n) => Number(document.getElementById('now').innerText.match(/(\d+) of \d+/)?.[1]) > n,
                             before + 5);  // it goes on
  await button.click();
  await page.locator('dialog #yes').click();
  await page.waitForFunction(() => document.body.dataset.state === 'ended');
  assert.match(await words(page, 'now'), /Run stopped/);
  assert.equal(await run.ended, 3);
  assert.deepEqual(said, []);
  await page.close();
});

test('without the token of the address there is no button', async () => {
  const run = await watch('11_pose_search_as_published.json', 60, ['--control']);
  const {page} = await open(run.url.replace(/#.*/, ''), {online: true});
  await page.waitForSelector('#drawing svg.polar');
  assert.equal(await page.locator('button#stop').isVisible(), false);
  assert.equal(await page.locator('#no-token').isVisible(), true);
  run.kill();
  await page.waitForSelector('#lost', {state: 'visible'});
  assert.match(await words(page, 'lost'), /Connection lost/);
  await page.close();
});
