// The page opens from a file without network, the console stays silent, and every drawing is there.

import assert from 'node:assert/strict';
import test from 'node:test';

import {open} from './support/browser.mjs';
import {expected} from './support/plots.mjs';
import {run} from './support/runs.mjs';

for (const plan of ['01_spool_simulated', '03_calibrate_fixture', '04_part_in_two_poses', '05_spindle_three_probe',
                    '06_wheel', '07_crank_pin', '08_shaft_scanned', '09_axle_points_file', '11_pose_search_as_published',
                    '15_shaft_points_file']) {
  test(`the page of ${plan} opens from a file, says nothing on the console, and has every plot`, async () => {
    const {html, report} = run(plan);
    const {page, said} = await open(html);
    assert.equal(await page.locator('h1').count(), 1);
    await page.evaluate(() => document.querySelectorAll('details').forEach((one) => { one.open = true; }));
    const heading = await page.locator('#result h3').allInnerTexts();
    const drawn = await page.locator('figure svg[aria-label]').evaluateAll(
        (all) => all.map((svg) => ({label: svg.getAttribute('aria-label'), area: svg.getBoundingClientRect().width *
                                    svg.getBoundingClientRect().height, marks: svg.querySelectorAll('path,circle,rect,line').length})));
    const {labels, bars} = expected(report, heading[0] ?? null);
    assert.equal(drawn.length, labels.length);
    for (const label of labels) {
      const at = drawn.findIndex((svg) => label.test(svg.label));
      assert.notEqual(at, -1, `no drawing ${label}`);
      const [found] = drawn.splice(at, 1);
      assert.ok(found.area > 10_000 && found.marks > 0, `${found.label} is empty`);
    }
    assert.equal(await page.locator('svg.bar').count(), bars);
    assert.deepEqual(said, []);
    await page.close();
  });
}

test('the policy of the page stops every other script', async () => {
  const {page, said} = await open(run('01_spool_simulated').html);
  await page.evaluate(() => {
    const script = document.createElement('script');
    script.textContent = 'window.intruder = true';
    document.body.append(script);
  });
  assert.equal(await page.evaluate(() => window.intruder), undefined);
  assert.match(said.join(), /Content Security Policy/);
  await page.close();
});
