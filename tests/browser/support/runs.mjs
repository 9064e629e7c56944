// Runs of the example plans: those of this pass of ctest (tests/app/run_examples.sh), others measured once a file,
// in a folder that goes away at the end.

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

/// The run of an example that all tests share; null where there is none, or where its page also shows earlier runs.
function shared(plan, more) {
  const directory = join(process.env.RONDURE_EXAMPLE_RUNS ?? '', 'runs', plan);
  const is = process.env.RONDURE_EXAMPLE_RUNS && more.length === 0 && existsSync(join(directory, 'report.html')) &&
             !existsSync(join(directory, 'earlier.json'));
  return is ? directory : null;
}

/// A run of an example plan ("01_spool_simulated"), or of a plan file of one's own.
/// returns {directory, html, report}: its folder, the path of its page, its report.json as an object
export function run(plan, more = []) {
  const key = [plan, ...more].join(' ');
  if (!made.has(key)) {
    const file = plan.endsWith('.json') ? plan
        : join(process.env.RONDURE_SOURCE_DIR, 'plans/examples', `${plan}.json`);
    const directory = shared(plan, more) ?? join(folder, `run-${made.size + 1}`);
    if (!existsSync(directory)) {
      rondure(['run', file, '--out', directory, '--archive', 'none', '--format', 'html,json', '--quiet', ...more]);
    }
    made.set(key, {
      directory,
      html: join(directory, 'report.html'),
      report: JSON.parse(readFileSync(join(directory, 'report.json'), 'utf8')),
    });
  }
  return made.get(key);
}
