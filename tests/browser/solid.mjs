// The cylinder in three dimensions turns under mouse, touch, keys and buttons, and comes back.

import assert from 'node:assert/strict';
import test from 'node:test';

import {open} from './support/browser.mjs';
import {run} from './support/runs.mjs';

const drawing = 'figure.solid svg';

/// What the drawing shows: every coordinate of it.
const shown = (page) => page.locator(drawing).evaluate((svg) => [...svg.querySelectorAll('*')]
  .map((item) => ['d', 'x', 'y', 'cx', 'cy', 'ry', 'y1', 'y2'].map((name) => item.getAttribute(name)).join())
  .sort().join('\n'));
const told = (page) => page.locator('figure.solid output').innerText();

async function opened(options) {
  const made = await open(run('01_spool_simulated').html, options);
  await made.page.locator(drawing).scrollIntoViewIfNeeded();
  return made;
}

test('what the script draws first is what the page shows without it', async () => {
  const {page} = await opened();
  const plain = await page.evaluate(async ([source, selector]) => {
    const bare = new DOMParser().parseFromString(source, 'text/html');
    return [...bare.querySelector(selector).querySelectorAll('*')]
      .map((item) => ['d', 'x', 'y', 'cx', 'cy', 'ry', 'y1', 'y2'].map((name) => item.getAttribute(name)).join())
      .sort().join('\n');
  }, [(await import('node:fs')).readFileSync(run('01_spool_simulated').html, 'utf8'), drawing]);
  const numbers = (text) => text.match(/-?\d+(\.\d+)?/g).map(Number);
  const [a, b] = [numbers(plain), numbers(await shown(page))];
  assert.equal(a.length, b.length);
  // Half a unit of the last digit may round to either side.
  const apart = a.filter((value, i) => Math.abs(value - b[i]) > 0.11).length;
  assert.ok(apart < a.length / 100, `${apart} of ${a.length} numbers differ`);
  await page.close();
});

test('dragging turns it, and the reset button brings it back', async () => {
  const {page, said} = await opened();
  const before = await shown(page);
  const picture = await page.locator(drawing).screenshot();
  const box = await page.locator(drawing).boundingBox();
  const [x, y] = [box.x + 0.4 * box.width, box.y + 0.5 * box.height];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 80, y + 30, {steps: 4});
  await page.mouse.up();
  assert.equal(await told(page), 'turned -20°, tilted 37°');
  assert.notEqual(await shown(page), before);
  assert.ok(!picture.equals(await page.locator(drawing).screenshot()));
  await page.mouse.move(x - 50, y, {steps: 2});
  assert.equal(await told(page), 'turned -20°, tilted 37°');
  await page.getByRole('button', {name: 'Reset view'}).click();
  assert.equal(await shown(page), before);
  assert.deepEqual(said, []);
  await page.close();
});

test('the arrow keys turn it when it has the focus, and only then', async () => {
  const {page} = await opened();
  const before = await shown(page);
  await page.keyboard.press('ArrowRight');
  assert.equal(await shown(page), before);
  await page.locator(drawing).focus();
  await page.keyboard.press('ArrowRight');
  assert.equal(await told(page), 'turned -55°, tilted 22°');
  assert.notEqual(await shown(page), before);
  for (let i = 0; i < 30; i++) await page.keyboard.press('ArrowDown');
  assert.equal(await told(page), 'turned -55°, tilted 90°');
  await page.keyboard.press('Home');
  assert.equal(await shown(page), before);
  await page.close();
});

test('a full turn by the buttons ends where it began', async () => {
  const {page} = await opened();
  const before = await shown(page);
  for (let i = 0; i < 24; i++) await page.getByRole('button', {name: 'Turn right'}).click();
  assert.equal(await shown(page), before);
  await page.close();
});

test('a finger turns it sideways and still scrolls the page', async () => {
  const {page} = await opened({width: 360, height: 700});
  assert.equal(await page.locator(drawing).evaluate((svg) => getComputedStyle(svg).touchAction), 'pan-y');
  const before = await told(page);
  await page.locator(drawing).evaluate((svg) => {
    const point = (type, clientX) => svg.dispatchEvent(new PointerEvent(type,
      {pointerId: 1, pointerType: 'touch', isPrimary: true, clientX, clientY: 300, bubbles: true}));
    svg.setPointerCapture = () => {};
    point('pointerdown', 100);
    point('pointermove', 160);
    point('pointerup', 160);
  });
  assert.equal(before, 'turned -60°, tilted 22°');
  assert.equal(await told(page), 'turned -30°, tilted 22°');
  await page.close();
});

test('a thousand points turn at once', async () => {
  const {page} = await open(run('08_shaft_scanned').html);
  const took = await page.locator(drawing).evaluate((svg) => {
    const start = performance.now();
    for (let i = 0; i < 20; i++) svg.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft'}));
    return (performance.now() - start) / 20;
  });
  console.log(`one turn of the drawing: ${took.toFixed(1)} ms`);
  assert.ok(took < 50, `${took} ms`);
  await page.close();
});
