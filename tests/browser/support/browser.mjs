// Chromium as every subject uses it: one browser a file, one fresh page a test, no network, and a
// list of what the console said.

import {mkdtempSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after} from 'node:test';
import {pathToFileURL} from 'node:url';

const load = createRequire(join(process.env.RONDURE_NODE_MODULES, 'any.js'));
const {chromium} = load('playwright-core');
export const axePath = load.resolve('axe-core/axe.min.js');

const profile = mkdtempSync(join(tmpdir(), 'rondure-browser-'));
const asRoot = process.getuid() === 0 ? ['--no-sandbox'] : [];
const context = await chromium.launchPersistentContext(profile, {
  executablePath: process.env.RONDURE_CHROMIUM,
  headless: true,
  args: [...asRoot, '--disable-gpu', '--disable-quic', '--no-first-run',
         '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});
after(async () => {
  await context.close();
  rmSync(profile, {recursive: true, force: true});
});

/// Opens a page in a new tab.
/// options: {width, height, scheme: 'light'|'dark', online: true for a page of a local server}
/// returns {page, said}: `said` gathers console messages of level error and warning, exceptions of
/// scripts and requests for anything but the page itself; close the page when done.
export async function open(target, options = {}) {
  const page = await context.newPage();
  const said = [];
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) said.push(`${message.type()}: ${message.text()}`);
  });
  page.on('pageerror', (error) => said.push(`exception: ${error.message}`));
  await context.setOffline(options.online !== true);
  const url = target.startsWith('http') ? target : pathToFileURL(target).href;
  page.on('request', (request) => {
    if (options.online !== true && request.url() !== url) said.push(`request: ${request.url()}`);
  });
  await page.setViewportSize({width: options.width ?? 1000, height: options.height ?? 800});
  await page.emulateMedia({colorScheme: options.scheme ?? 'light', media: 'screen'});
  await page.goto(url);
  return {page, said};
}
