// The page opens from a file without network, and the console stays silent.

import assert from 'node:assert/strict';
import test from 'node:test';

import {open} from './support/browser.mjs';
import {run} from './support/runs.mjs';

for (const plan of ['01_spool_simulated', '05_spindle_three_probe', '06_wheel', '07_crank_pin',
                    '08_shaft_scanned']) {
  test(`the page of ${plan} opens from a file and the console stays silent`, async () => {
    const {page, said} = await open(run(plan).html);
    assert.equal(await page.locator('h1').count(), 1);
    assert.deepEqual(said, []);
    await page.close();
  });
}
