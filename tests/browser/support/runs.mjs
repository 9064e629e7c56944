// Runs of the example plans, each measured once a file, in a folder that goes away at the end.

import {spawnSync} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after} from 'node:test';

// In memory where there is such a place: a run waits for the disk at every touch.
export const folder = mkdtempSync(join(existsSync('/dev/shm') ? '/dev/shm' : tmpdir(), 'rondure-runs-'));
after(() => rmSync(folder, {recursive: true, force: true}));

/// Starts the program and waits for it; throws when it ends with a status that is not listed.
export function rondure(args, allowed = [0, 1]) {
  const done = spawnSync(process.env.RONDURE_BINARY, args, {encoding: 'utf8'});
  if (!allowed.includes(done.status)) {
    throw new Error(`rondure ${args.join(' ')} ended with ${done.status}: ${done.stderr}`);
  }
  return done.stdout;
}

const made = new Map();

/// A run of an example plan ("01_spool_simulated"), or of a plan file of one's own.
/// returns {directory, html, report}: its folder, the path of its page, its report.json as an object
export function run(plan, more = []) {
  const key = [plan, ...more].join(' ');
  if (!made.has(key)) {
    const file = plan.endsWith('.json') ? plan
        : join(process.env.RONDURE_SOURCE_DIR, 'plans/examples', `${plan}.json`);
    const directory = join(folder, `run-${made.size + 1}`);
    rondure(['run', file, '--out', directory, '--archive', 'none', '--format', 'html,json', '--quiet', ...more]);
    made.set(key, {
      directory,
      html: join(directory, 'report.html'),
      report: JSON.parse(readFileSync(join(directory, 'report.json'), 'utf8')),
    });
  }
  return made.get(key);
}
