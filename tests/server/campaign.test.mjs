// `stagger campaign` against the real binary, on the pendulum.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, test } from 'node:test';
import { binary, command, eventually, interrupted, root, within } from './support.mjs';
import { wellFormed } from './well_formed.mjs';

const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-campaign-'));
after(() => fs.rmSync(scratch, { recursive: true }));
let made = 0;
const folder = () => path.join(scratch, String(made++));

const small = {
  version: 1,
  name: 'small',
  seed: 3,
  base: {
    robot: 'kasaei', plant: 'lipm', settle_s: 2, observe_s: 2,
    push: { duration_s: 0.05, trigger: { phase: 'single_support', leg: 'left', fraction: 0.1 } },
  },
  design: { kind: 'grid', repeats: 2 },
  factors: { 'push.direction_deg': [0, 90], 'push.impulse_ns': [2, 150] },
};
/** Enough of them to be interrupted. */
const long = { ...small, name: 'long', design: { kind: 'grid', repeats: 60 } };

const written = (spec) => {
  const file = path.join(scratch, `spec-${made++}.json`);
  fs.writeFileSync(file, typeof spec === 'string' ? spec : JSON.stringify(spec));
  return file;
};
const campaign = (...args) => command(['campaign', ...args]);
async function run(spec, ...args) {
  const out = folder();
  const result = await campaign('run', written(spec), '--out', out, ...args);
  const file = path.join(out, 'summary.json');
  const summary = fs.existsSync(file) ? JSON.parse(fs.readFileSync(file)) : undefined;
  return { ...result, out, summary };
}
const text = (out, name) => fs.readFileSync(path.join(out, name), 'utf8');

test('a campaign leaves its results, and exit code 0', async () => {
  const { code, stderr, stdout, out, summary } = await run({ ...small, thresholds: ['falls == 4'] });
  assert.equal(code, 0, stderr);
  assert.match(stdout, /complete, 8 trials: 4 recovered, 4 fell/);
  assert.deepEqual([summary.state, summary.trials, summary.fell, summary.mismatches],
    ['complete', 8, 4, []]);
  assert.ok(summary.run_twice >= 1);
  assert.equal(text(out, 'trials.csv').trim().split('\n').length, 9);
  assert.match(text(out, 'junit.xml'), /failures="0"/);

  // Any trial can be had back and repeats to the bit.
  const trials = text(out, 'trials.ndjson').trim().split('\n').map((line) => JSON.parse(line));
  const one = trials.find((trial) => trial.outcome === 'fell');
  const again = await command(['trial', '-'], JSON.stringify(one.spec));
  assert.equal(JSON.parse(again.stdout).state_hash, one.state_hash);
  const shown = await campaign('trial', out, String(one.number));
  assert.deepEqual(JSON.parse(shown.stdout), one.spec);

  const status = await campaign('status', out, '--json');
  assert.equal(JSON.parse(status.stdout).results_hash, summary.results_hash);
});

test('the report tells how to run each failed trial again', async () => {
  const { out } = await run(small);
  const html = text(out, 'report.html');
  const commands = [...html.matchAll(/stagger campaign trial (\S+) (\d+) \| stagger trial -/g)];
  const fallen = text(out, 'trials.ndjson').trim().split('\n').map((line) => JSON.parse(line))
    .filter((trial) => !trial.passed);
  assert.deepEqual(commands.map(([, , number]) => Number(number)), fallen.map(({ number }) => number));
  const [, name, number] = commands[0];
  assert.equal(name, path.basename(out));
  const spec = await campaign('trial', out, number);
  const again = await command(['trial', '-'], spec.stdout);
  assert.equal(JSON.parse(again.stdout).state_hash, fallen[0].state_hash);

  fs.rmSync(path.join(out, 'report.html'));
  const { code, stdout } = await campaign('report', out);
  assert.equal(code, 0);
  assert.equal(stdout.trim(), path.join(out, 'report.html'));
  assert.equal(text(out, 'report.html'), html);
  assert.equal((await campaign('report', folder())).code, 2);
});

test('figures of the report stand alone', async () => {
  const { out } = await run({ ...small,
    factors: { ...small.factors, strategies: [['ankle'], ['ankle', 'step']] } });
  const place = path.join(folder(), 'new');
  const { code, stdout } = await campaign('report', out, '--figures', place);
  assert.equal(code, 0);
  assert.deepEqual(stdout.trim().split('\n'),
    [path.join(out, 'report.html'), path.join(place, 'survival.svg'), path.join(place, 'ablation.svg')]);
  for (const name of fs.readdirSync(place)) {
    const svg = text(place, name);
    const tags = wellFormed(svg);
    assert.equal(tags[0], 'svg', name);
    assert.ok(tags.includes('style') && !tags.includes('a') && !tags.includes('script'), name);
    assert.match(svg, /^<svg xmlns="http:\/\/www.w3.org\/2000\/svg" id="figure-\w+" viewBox="0 0 /);
    assert.match(svg, /class="foot">small\. Version: stagger \S+, campaign seed 3, results \w{16}/);
    // Programs that set papers know neither variables nor what lies outside.
    assert.doesNotMatch(svg, /var\(|url\(|@import|href|prefers-color-scheme/);
  }
  assert.match(text(place, 'survival.svg'), />2 of 2 \(34–100 %\)<.*>0 of 2 \(0–66 %\)</s);
  const json = await campaign('report', out, '--figures', place, '--json');
  assert.equal(JSON.parse(json.stdout).figures.length, 2);
  const refused = await campaign('report', out, '--figures', path.join(out, 'report.html'));
  assert.equal(refused.code, 2);
  assert.match(refused.stderr, /cannot make .*report\.html/);
});

test('a threshold that is not met ends with 1', async () => {
  const { code, stdout, out } = await run({ ...small, thresholds: ['fall_rate == 0'] });
  assert.equal(code, 1);
  assert.match(stdout, /FAILED: fall_rate == 0 \(it is 0\.5\)/);
  assert.match(text(out, 'junit.xml'), /<failure message="the value is 0\.5"/);
});

test('a specification that is not right ends with 2, and says where', async () => {
  const spec = `{
  "version": 1, "name": "broken",
  "base": { "robot": "kasaei", "plant": "lipm",
            "push": { "impulse_ns": 5, "link": "tail" } },
  "design": { "kind": "grid" },
  "factors": {
    "walk.vx": [0, 0.1,
                7]
  }
}`;
  const { code, stderr } = await run(spec);
  assert.equal(code, 2);
  assert.match(stderr, /json:4:48: \/base\/push\/link is "tail"/);
  const { code: other, stderr: lines } = await run(spec.replace('tail', 'torso'));
  assert.equal(other, 2);
  assert.match(lines, /json:8:17: \/factors\/walk\.vx\/2 .* is 7; allowed: -0\.5 to 0\.5 m\/s/);
  assert.match((await run('{"version": 1,\n "name": }')).stderr, /json:2:10: /);
  for (const bad of ['', '[]', '{}', { ...small, colour: 1 }, { ...small, thresholds: ['falls'] },
    { ...small, base: { ...small.base, robot: 'nobody' } }, { ...small, limits: { max_trials: 3 } }]) {
    assert.equal((await run(bad)).code, 2, JSON.stringify(bad));
  }
});

test('bad usage ends with 2', async () => {
  const { out } = await run(small);
  for (const args of [[], ['fly'], ['run'], ['run', '/no/such/file'], ['resume', scratch], ['status', '/no/such'],
    ['run', written(small), '--out', out], ['run', written(small), '--out', '/proc/no/such'],
    ['run', written(small), '--threads', '-1'], ['trial', out, '8'], ['compare', out, scratch],
    ['compare', out, out, '--tolerance', '2']]) {
    const { code, stderr } = await campaign(...args);
    assert.equal(code, 2, args.join(' '));
    assert.notEqual(stderr, '', args.join(' '));
  }
});

test('invalid trials end with 4', async () => {
  // On one foot's ankle alone, without steps, and walking: it falls before the push.
  const spec = { ...small, base: { ...small.base, settle_s: 20, walk: { vx: 0.5 }, strategies: [] } };
  const { code, stderr, summary } = await run(spec);
  assert.equal(code, 4, JSON.stringify(summary));
  assert.match(stderr, /8 trials are invalid/);
  assert.deepEqual([summary.invalid, summary.fell, summary.fall_rate], [8, 0, null]);
});

test('validate tells how many trials there will be', async () => {
  const { code, stdout } = await campaign('validate', written(small), '--json');
  assert.equal(code, 0);
  assert.deepEqual(JSON.parse(stdout), { name: 'small', cells: 4, most_trials: 8 });
  for (const name of ['smoke', 'omni', 'ihmc-like', 'ablation']) {
    const file = path.join(root, 'tests/campaigns', `${name}.json`);
    assert.equal((await campaign('validate', file)).code, 0, name);
  }
});

test('Ctrl-C ends with 130 and a summary; resume ends as if it had not been', async () => {
  const whole = await run(long, '--threads', '1', '--quiet');
  const out = folder();
  const first = await interrupted(['campaign', 'run', written(long), '--out', out]);
  assert.equal(first.code, 130, first.stderr);
  assert.match(first.stderr, /go on with: stagger campaign resume /);
  const summary = JSON.parse(text(out, 'summary.json'));
  assert.equal(summary.state, 'incomplete');
  assert.ok(summary.trials < 240, summary.trials);
  assert.equal((await campaign('run', written(long), '--out', out)).code, 2);

  const second = await campaign('resume', out, '--threads', '3');
  assert.equal(second.code, whole.code, second.stderr);
  assert.equal(text(out, 'trials.csv'), text(whole.out, 'trials.csv'));
  assert.equal(JSON.parse(text(out, 'summary.json')).results_hash, whole.summary.results_hash);
});

test('kill -9 loses nothing that was done', async () => {
  const whole = await run(long, '--quiet');
  const out = folder();
  let args = ['campaign', 'run', written(long), '--out', out, '--json', '--quiet'];
  const seen = new Set();
  for (let kill = 0; kill < 4; ++kill) {
    const child = spawn(binary, args, {
      env: { STAGGER_ROBOTS: path.join(root, 'robots'), ...process.env },
      stdio: ['ignore', 'pipe', 'ignore'],
    });
    const ended = new Promise((resolve) => child.on('close', resolve));
    let output = '';
    child.stdout.on('data', (data) => (output += data));
    const trials = () => output.split('\n').filter((line) => line.includes('"event":"trial"') && line.endsWith('}'));
    try {
      const enough = Math.ceil(Math.random() * 40);
      await eventually(() => trials().length >= enough, 'trials');
    } finally {
      child.kill('SIGKILL');
      await within(ended, 'the end');
    }
    for (const line of trials()) {
      const { number } = JSON.parse(line);
      assert.ok(!seen.has(number), `trial ${number} was run again`);
      seen.add(number);
    }
    args = ['campaign', 'resume', out, '--json', '--quiet'];
  }
  const last = await campaign('resume', out, '--quiet');
  assert.equal(last.code, whole.code, last.stderr);
  assert.equal(text(out, 'trials.csv'), text(whole.out, 'trials.csv'));
});

test('a campaign of another robot is not gone on with', async () => {
  const robots = path.join(scratch, 'robots');
  fs.cpSync(path.join(root, 'robots/kasaei'), path.join(robots, 'kasaei'), { recursive: true });
  const out = folder();
  const file = written(long);
  await interrupted(['campaign', 'run', file, '--out', out, '--robots-dir', robots]);
  const description = path.join(robots, 'kasaei/robot.json');
  const json = JSON.parse(fs.readFileSync(description));
  json.walk.com_height_m -= 0.05;
  fs.writeFileSync(description, JSON.stringify(json));
  const { code, stderr } = await campaign('resume', out, '--robots-dir', robots);
  assert.equal(code, 2);
  assert.match(stderr, /the program or a robot has changed/);
});

test('a campaign that runs is not run twice, but can be looked at', async () => {
  const out = folder();
  const running = spawn(binary, ['campaign', 'run', written(long), '--out', out, '--json', '--quiet'], {
    env: { STAGGER_ROBOTS: path.join(root, 'robots'), ...process.env },
    stdio: ['ignore', 'pipe', 'ignore'],
  });
  const ended = new Promise((resolve) => running.on('close', resolve));
  try {
    let output = '';
    running.stdout.on('data', (data) => (output += data));
    await eventually(() => output.includes('"event":"trial"'), 'a trial');
    running.kill('SIGSTOP'); // so that it does not end before it has been looked at
    const { code, stderr } = await campaign('resume', out);
    assert.equal(code, 2);
    assert.match(stderr, /another process runs this campaign/);
    const status = await campaign('status', out, '--json');
    assert.equal(status.code, 0, status.stderr);
    assert.equal(JSON.parse(status.stdout).state, 'incomplete');
  } finally {
    running.kill('SIGKILL');
    await within(ended, 'the end');
  }
});

test('a bisection finds limits', async () => {
  const { code, summary, stdout } = await run({
    ...small,
    name: 'limits',
    design: { kind: 'bisect', axis: 'push.delta_v', lo: 0.1, hi: 6.1, tol: 0.5, repeats: 2 },
    factors: { 'push.direction_deg': [0, 180] },
    thresholds: ['min(limit_dv) >= 0.1'],
  });
  assert.equal(code, 0, stdout);
  assert.equal(summary.limits.length, 2);
  for (const limit of summary.limits) {
    assert.ok(limit.done && limit.monotone);
    assert.ok(Math.abs(limit.fail - limit.pass - 0.5) < 1e-9, JSON.stringify(limit));
    assert.ok(Math.abs(limit.pass_ns - 30 * limit.pass) < 1e-9);
  }
});

test('an interrupted bisection tells the limits that it has begun, and counts the others', async () => {
  const out = folder();
  const directions = Array.from({ length: 360 }, (_, i) => i);
  const spec = {
    ...small,
    design: { kind: 'bisect', axis: 'push.delta_v', lo: 0.1, hi: 6.1, tol: 0.5, repeats: 2 },
    factors: { 'push.direction_deg': directions },
  };
  assert.equal((await interrupted(['campaign', 'run', written(spec), '--out', out])).code, 130);
  const { stdout } = await campaign('status', out);
  const listed = stdout.match(/^  push.direction_deg /gm) ?? [];
  assert.equal(listed.length + Number(/^  (\d+) more have not begun$/m.exec(stdout)[1]), 360, stdout);
});

test('compare tells what became worse, and ends with 1', async () => {
  const spec = (strategies) => ({
    ...small,
    base: { ...small.base, strategies },
    factors: { 'push.direction_deg': [0, 90, 180, 270], 'push.delta_v': [0.05, 0.3] },
  });
  const strong = await run(spec(['ankle', 'hip', 'step', 'time']));
  const weak = await run(spec(['ankle']));
  const worse = await campaign('compare', strong.out, weak.out, '--json');
  assert.equal(worse.code, 1, worse.stderr);
  const { pairs, regressions, worse: trials, groups } = JSON.parse(worse.stdout);
  assert.equal(pairs, 16);
  assert.ok(trials.length > 0 && regressions.length > 0);
  const [all] = groups;
  assert.ok(all.difference.low < all.difference.value && all.difference.value < all.difference.high);
  assert.equal((await campaign('compare', weak.out, strong.out)).code, 0);
  assert.equal((await campaign('compare', strong.out, strong.out)).code, 0);
  assert.equal((await campaign('compare', strong.out, weak.out, '--tolerance', '1')).code, 0);
});

test('progress as events', async () => {
  const { stdout, stderr } = await run(small, '--json', '--quiet');
  assert.equal(stderr, '');
  const events = stdout.trim().split('\n').map((line) => JSON.parse(line));
  assert.deepEqual([events[0].event, events[0].most], ['start', 8]);
  assert.equal(events.filter((event) => event.event === 'trial').length, 8);
  assert.equal(events.at(-1).summary.state, 'complete');
});
