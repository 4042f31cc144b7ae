// `stagger paper` against the real binary. Quick sections only: sanitizers repeat these.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { command } from './support.mjs';
import { wellFormed } from './well_formed.mjs';

// A push so late that the ladder of forces is climbed on a short gait.
const timing = ['--t-ss', '0.4', '--t-ds', '0.1', '--t-left', '0.3'];
const paper = async (...args) => {
  const result = await command(['paper', ...args]);
  assert.equal(result.code, 0, result.stderr);
  return result;
};
const json = async (...args) => JSON.parse((await paper(...args, '--json')).stdout);

async function inFolder(use) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-'));
  try {
    return await use(folder);
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
}

test('the plan agrees with an independent solution', async () => {
  const result = await json('plan');
  assert.deepEqual(Object.keys(result), ['plan', 'version']);
  const { plan } = result;
  for (const key of ['max_velocity_jump', 'max_node_error', 'max_ode_residual']) {
    assert.ok(plan[key] >= 0 && plan[key] < 1e-9, `${key} ${plan[key]}`);
  }
  assert.equal(plan.nodes.length, 14);
  assert.deepEqual(plan.nodes[0], { t: 0, com_m: 0, dcm_m: plan.nodes[0].dcm_m, independent_com_m: 0 });
  assert.ok(Math.abs(plan.nodes[1].com_m - 0.19296) < 1e-4);
});

test('tracking under noise', async () => {
  const { lqg, ...others } = await json('lqg', '--seeds', '2');
  assert.deepEqual(Object.keys(others), ['version']);
  assert.equal(lqg.seeds, 2);
  for (const key of ['rms_com_m', 'rms_dcm_m', 'rms_com_y_m', 'rms_dcm_y_m']) {
    assert.ok(lqg[key] > 1e-4 && lqg[key] < 0.01, `${key} ${lqg[key]}`);
  }
  assert.ok(lqg.zmp_outside_fraction >= 0 && lqg.zmp_outside_fraction < 0.05);
});

test('any timing and direction has its limits', async () => {
  const { scenario2 } = await json('scenario2', ...timing, '--seeds', '1', '--direction-deg', '90');
  const [entry, ...more] = scenario2.stagger;
  assert.equal(more.length, 0);
  assert.ok(!('directions' in scenario2));
  assert.deepEqual([entry.t_ss, entry.t_ds, entry.t_left, entry.direction_deg], [0.4, 0.1, 0.3, 90]);
  assert.equal(entry.noise_seeds, 1);
  for (const strategy of ['ankle', 'location', 'time']) {
    const key = `${strategy}_n`;
    assert.ok(entry[key] > 0 && entry[key] <= entry.ceiling[key], `${key} ${entry[key]}`);
    assert.ok(Math.abs(entry.percent[strategy] - (100 * entry[key]) / entry.ceiling[key]) < 1e-6);
    assert.equal(entry.noise_median[key], entry.noise_least[key]);
  }
  assert.ok(entry.ankle_n <= entry.location_n);
  assert.equal(scenario2.published.ankle_n, 325);
});

test('text has a line for every number', async () => {
  const { stdout } = await paper('plan');
  const lines = stdout.trim().split('\n');
  assert.match(lines[0], /ours +noisy +published +ceiling/);
  assert.equal(lines.length, 1 + 2 + 3);
});

test('the same command gives the same bytes', async () => {
  await inFolder(async (folder) => {
    const run = () => command(['paper', 'lqg', '--seeds', '1', '--json', '--out', folder]);
    const first = await run();
    const page = fs.readFileSync(path.join(folder, 'report.html'));
    const second = await run();
    assert.equal(first.stdout, second.stdout);
    assert.ok(page.equals(fs.readFileSync(path.join(folder, 'report.html'))));
  });
});

test('the report stands alone', async () => {
  await inFolder(async (folder) => {
    const out = path.join(folder, 'new', 'folder');
    for (const [args, sections, pictures] of [
      [['plan'], 1, 4], [['lqg', '--seeds', '1'], 1, 6],
      [['scenario2', ...timing, '--seeds', '1'], 1, 1]]) {
      const { stdout } = await paper(...args, '--out', out);
      const file = path.join(out, 'report.html');
      assert.ok(stdout.includes(file), stdout);
      const html = fs.readFileSync(file, 'utf8');
      const tags = wellFormed(html);
      const count = (name) => tags.filter((tag) => tag === name).length;
      assert.equal(count('section'), sections);
      assert.equal(html.match(/<svg xmlns=/g).length, pictures);
      assert.equal(count('desc'), pictures);
      assert.equal(count('script') + count('link') + count('img') + count('iframe'), 0);
      assert.ok(count('caption') >= 1 && count('figcaption') >= 1);
      const addresses = html.match(/(?:https?:)?\/\/[\w.]+[^"\s]*/g) ?? [];
      assert.deepEqual([...new Set(addresses)], ['http://www.w3.org/2000/svg']);
      assert.ok(!/url\(|@import/.test(html));
      assert.ok(Buffer.byteLength(html) < 1_500_000);
    }
  });
});

test('what cannot be is refused by name', async () => {
  const at = (name, value) => {
    const args = ['scenario2', ...timing];
    args[args.indexOf(name) + 1] = value;
    return args;
  };
  await inFolder(async (folder) => {
    const file = path.join(folder, 'file');
    fs.writeFileSync(file, '');
    for (const [args, ...words] of [
      [['scenario3'], 'scenario3'],
      [['lqg', '--seeds', '0'], '--seeds', '1', '1000'],
      [['lqg', '--seeds', 'many'], '--seeds', 'many'],
      [at('--t-ss', '0.1'), '--t-ss', '0.1', '0.2', '3'],
      [at('--t-ss', 'nan'), '--t-ss', 'nan'],
      [at('--t-ds', '1.5'), '--t-ds', '1.5', '0', '1'],
      [at('--t-left', '0.02'), '--t-left', '0.02', '0.4'],
      [at('--t-left', '0.41'), '--t-left', '0.41', '0.4'],
      [['scenario2', ...timing, '--direction-deg', '361'], '--direction-deg', '361', '-360', '360'],
      [['scenario2', '--t-ss', '0.8'], '--t-ds', 'missing'],
      [['scenario2', '--direction-deg', '90'], '--t-ss', 'missing'],
      [['scenario1', ...timing], '--t-ss', 'scenario2'],
      [['plan', '--out', path.join(file, 'below')], '--out', file]]) {
      const { code, stdout, stderr } = await command(['paper', ...args]);
      assert.equal(code, 2, args.join(' '));
      assert.equal(stdout, '');
      for (const word of words) assert.ok(stderr.includes(word), `${word} in: ${stderr}`);
    }
  });
});
