// The command line against the real binary.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { command, interrupted, root } from './support.mjs';

const push = { impulse_ns: 5, direction_deg: 90, trigger: { phase: 'single_support', leg: 'left' } };
const spec = { robot: 'kasaei', plant: 'lipm', settle_s: 2, observe_s: 2, push };
const trial = (value) =>
  command(['trial', '-'], typeof value === 'string' ? value : JSON.stringify(value));

test('--version and --help', async () => {
  const version = await command(['--version']);
  assert.equal(version.code, 0);
  assert.match(version.stdout, /^\d+\.\d+\.\d+\n$/);
  const help = await command(['--help']);
  assert.equal(help.code, 0);
  for (const name of ['serve', 'run', 'trial', 'limits', 'campaign', 'robots', 'paper']) assert.match(help.stdout, RegExp(name));
});

test('bad options end with 2', async () => {
  for (const args of [[], ['fly'], ['run'], ['run', '--robot', 'kasaei', '--vx', '1'],
    ['run', '--robot', 'kasaei', '--vx', 'nan'], ['run', '--robot', 'nobody'],
    ['run', '--robot', 'kasaei', '--seconds', '-1'], ['serve', '--port', '70000'],
    ['serve', '--robot', 'nobody'], ['serve', '--plant', 'mujoco'], ['serve', '--state', 'exact'],
    ['run', '--robot', 'kasaei', '--control-delay-ms', '11'], ['trial', '/no/such/file']]) {
    const { code, stderr } = await command(args);
    assert.equal(code, 2, args.join(' '));
    assert.notEqual(stderr, '', args.join(' '));
  }
});

test('run tells how the walk went', async () => {
  const { code, stdout } = await command(
    ['run', '--robot', 'kasaei', '--plant', 'lipm', '--seconds', '5', '--vx', '0.1', '--json']);
  assert.equal(code, 0);
  const result = JSON.parse(stdout);
  for (const key of ['robot', 'plant', 'seed', 'seconds', 'ticks', 'fell', 'fall_reason', 'steps',
    'worst_dcm_error_m', 'real_time_factor', 'state_hash', 'version']) {
    assert.ok(key in result, key);
  }
  assert.deepEqual([result.ticks, result.fell, result.fall_reason], [5000, false, null]);
  assert.ok(result.steps > 3);
  assert.match(result.state_hash, /^[0-9a-f]{16}$/);
});

test('the same run gives the same hash, another walk another', async () => {
  const run = async (vx) => {
    const args = ['run', '--robot', 'kasaei', '--plant', 'lipm', '--seconds', '3', '--json'];
    return JSON.parse((await command([...args, '--vx', vx])).stdout).state_hash;
  };
  assert.equal(await run('0.1'), await run('0.1'));
  assert.notEqual(await run('0.1'), await run('0.12'));
});

test('run on the full body', async () => {
  const { code, stdout } = await command(
    ['run', '--robot', 'kasaei', '--plant', 'bullet', '--seconds', '1', '--json']);
  const result = JSON.parse(stdout);
  assert.equal(result.plant, 'bullet');
  assert.equal(code, result.fell ? 1 : 0);
  assert.deepEqual([result.state, result.control_delay_ms], ['estimated', 1]);
});

test('run with perfect knowledge and late torques', async () => {
  const run = async (...args) => JSON.parse((await command(
    ['run', '--robot', 'kasaei', '--seconds', '0.2', '--json', ...args])).stdout);
  const result = await run('--state', 'perfect', '--control-delay-ms', '5');
  assert.deepEqual([result.state, result.control_delay_ms], ['perfect', 5]);
  assert.notEqual(result.state_hash, (await run('--state', 'perfect')).state_hash);
  assert.notEqual(result.state_hash, (await run('--control-delay-ms', '5')).state_hash);
  const lipm = await run('--plant', 'lipm');
  assert.deepEqual([lipm.state, lipm.control_delay_ms], [null, null]);
});

test('the same trial twice gives the same result to the bit', async () => {
  const first = await trial(spec);
  const second = await trial(spec);
  assert.equal(first.code, 0, first.stderr);
  assert.equal(first.stdout, second.stdout);
  const result = JSON.parse(first.stdout);
  for (const key of ['outcome', 'reason', 'delivered_ns', 'steps_to_recover', 'recovery_time_s', 'fall_time_s',
    'push_tick', 'worst_dcm_error_m', 'ticks', 'state_hash', 'spec', 'version']) {
    assert.ok(key in result, key);
  }
  assert.equal(result.outcome, 'recovered');
  assert.ok(Math.abs(result.delivered_ns - 5) < 1e-9);
  // The resolved specification is the same trial.
  const again = JSON.parse((await trial(result.spec)).stdout);
  assert.deepEqual(again, result);
});

test('a fall is a result, not a failure', async () => {
  const { code, stdout } = await trial({ ...spec, push: { ...push, impulse_ns: 150 } });
  const result = JSON.parse(stdout);
  assert.equal(code, 0);
  assert.equal(result.outcome, 'fell');
  assert.notEqual(result.fall_time_s, null);
});

test('a trigger that never comes is a time-out', async () => {
  const never = { ...push, trigger: { phase: 'double_support', leg: 'left', fraction: 0.999999 } };
  const { code, stdout } = await trial({ ...spec, push: never });
  assert.equal(JSON.parse(stdout).outcome, 'timeout');
  assert.equal(code, 0);
});

test('a bad specification is refused with a line for each error', async () => {
  const text = `{
  "robot": "kasaei",
  "plant": "mujoco",
  "push": { "impulse_ns": -1, "link": "tail" },
  "colour": "red"
}`;
  const { code, stdout, stderr } = await trial(text);
  assert.equal(code, 2);
  assert.equal(stdout, '');
  const lines = stderr.trim().split('\n');
  assert.equal(lines.length, 4, stderr);
  for (const [line, pointer] of [[3, '/plant'], [4, '/push/impulse_ns'], [4, '/push/link'],
    [5, '/colour']]) {
    assert.ok(lines.some((l) => l.includes(`:${line}:`) && l.includes(pointer)), pointer);
  }
  for (const bad of ['', '{', '[]', '{"robot":"nobody"}', '{"robot":"kasaei","robot":"kasaei"}']) {
    assert.equal((await trial(bad)).code, 2, bad);
  }
});

test('a trial is read from a file too', async () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-'));
  try {
    const file = path.join(folder, 'trial.json');
    fs.writeFileSync(file, JSON.stringify({ ...spec, push: undefined, observe_s: 0.5 }));
    const { code, stdout } = await command(['trial', file]);
    assert.equal(code, 0);
    assert.equal(JSON.parse(stdout).push_tick, null);
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
});

const limits = (...args) => command(['limits', '--robot', 'kasaei', '--plant', 'lipm', '--quiet', ...args]);
const small = ['--directions', '0,90', '--phases', '0.1', '--strategies', 'ankle', '--seeds', '3'];

test('limits are numbers with their conditions', async () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-'));
  try {
    const file = path.join(folder, 'limits.json');
    const page = path.join(folder, 'limits.md');
    const { code, stdout, stderr } =
      await limits(...small, '--to', '0.4', '--json', '--out', file, '--markdown', page);
    assert.equal(code, 0, stderr);
    assert.equal(stderr, '');
    const { conditions, results } = JSON.parse(stdout);
    assert.deepEqual(conditions.seeds, [1, 2, 3]);
    assert.deepEqual(conditions.strategies, ['ankle']);
    assert.deepEqual(conditions.ladder, [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4]);
    assert.deepEqual(results.map((r) => [r.direction_deg, r.phase, r.duration_s]),
      [[0, 0.1, 0.01], [90, 0.1, 0.01]]);
    assert.deepEqual([results[0].pass_dv, results[0].fail_dv], [0.2, 0.25]);
    for (const result of results) {
      assert.ok(result.ceiling_percent > 50 && result.ceiling_percent <= 100, result.ceiling_percent);
    }
    assert.equal(fs.readFileSync(file, 'utf8'), stdout);
    assert.match(fs.readFileSync(page, 'utf8'), /stagger limits --robot kasaei/);
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
});

test('limits are the same on one core and on many', async () => {
  const one = await limits(...small, '--json', '--threads', '1');
  const many = await limits(...small, '--json', '--threads', '5');
  assert.equal(one.code, 0, one.stderr);
  assert.equal(one.stdout, many.stdout);
});

test('limits are those of the parameters that were given', async () => {
  const forward = ['--directions', '0', '--phases', '0.1', '--seeds', '1', '--to', '0.8', '--json'];
  const long = await limits(...forward);
  const short = await limits(...forward, '--parameter', 'step.max_length=0.1');
  assert.equal(short.code, 0, short.stderr);
  const { conditions, results } = JSON.parse(short.stdout);
  assert.deepEqual(conditions.parameters, { 'step.max_length': 0.1 });
  assert.ok(results[0].pass_dv < JSON.parse(long.stdout).results[0].pass_dv);
});

test('a gate that is not passed ends with 1', async () => {
  assert.equal((await limits(...small, '--gate', '0.1')).code, 0);
  const { code, stdout } = await limits(...small, '--gate', '0.32', '--json');
  assert.equal(code, 1);
  assert.equal(JSON.parse(stdout).conditions.ladder.at(-1), 0.32);
});

test('Ctrl-C ends a search at once, and says so', async () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'limits-'));
  try {
    const file = path.join(folder, 'limits.json');
    fs.writeFileSync(file, 'of the last search');
    const { code, stdout, stderr } = await interrupted(['limits', '--robot', 'kasaei', '--out', file]);
    assert.equal(code, 130);
    assert.equal(stdout, '');
    assert.match(stderr, /stopped at 0\.1 m\/s after \d+ trials/);
    assert.equal(fs.readFileSync(file, 'utf8'), 'of the last search');
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
});

test('limits refuses naming option, value and range', async () => {
  for (const [option, value, range] of [['--directions', '0,400', '360'], ['--phases', '1', 'less than 1'],
    ['--phases', 'standing,standing', 'twice'], ['--durations', '0.0001', '0.001'], ['--seeds', '0', '1000'],
    ['--strategies', 'knee', 'ankle'], ['--from', 'nan', '0.001'], ['--to', '0.05', '0.1'], ['--step', '0', '0.001'],
    ['--gate', '0.05', '0.1'], ['--link', 'tail', 'torso'], ['--leg', 'middle', 'either'], ['--vx', '1', '0.5'],
    ['--observe-s', '61', '60'], ['--recover-s', '7', '6'], ['--threads', '-1', '1024'],
    ['--seed', '9007199254740992', '2^53'], ['--out', '/no/such/file', 'cannot write']]) {
    const { code, stdout, stderr } = await limits(option, value);
    assert.equal(code, 2, option);
    assert.equal(stdout, '', option);
    for (const part of [option, value.split(',').at(-1), range]) assert.ok(stderr.includes(part), stderr);
  }
});

test('robots are listed', async () => {
  assert.match((await command(['robots'])).stdout, /kasaei/);
  const { items } = JSON.parse((await command(['robots', '--json'])).stdout);
  assert.ok(items.some((robot) => robot.name === 'kasaei' && robot.joints.length === 12));
  assert.equal((await command(['robots', '--robots-dir', '/no/such/folder'])).stdout, '');
});

test('robots check tells what a URDF is, and makes a robot of it', async () => {
  const file = (name) => path.join(root, 'tests/data/robots', `${name}.urdf`);
  const kasaei = path.join(root, 'robots/kasaei/robot.urdf');
  const found = await command(['robots', 'check', kasaei, '--json']);
  assert.equal(found.code, 0, found.stderr);
  const result = JSON.parse(found.stdout);
  assert.equal(result.walks, true);
  assert.ok(Math.abs(result.figures.mass_kg - 30) < 1e-9);
  assert.deepEqual(result.legs.left.joints.map((joint) => joint.role),
    ['hip_yaw', 'hip_roll', 'hip_pitch', 'knee', 'ankle_pitch', 'ankle_roll']);

  for (const [name, reason] of [['point_feet', /point or a line/], ['four_joints', /has 4 joints/]]) {
    const { code, stdout, stderr } = await command(['robots', 'check', file(name), '--json']);
    assert.equal(code, 1, name);
    assert.match(stderr, reason);
    assert.equal(JSON.parse(stdout).walks, false);
  }
  assert.equal((await command(['robots', 'check', '/no/such.urdf'])).code, 2);
  assert.equal((await command(['robots', 'check', path.join(root, 'README.md')])).code, 2);
  assert.equal((await command(['robots', 'check'])).code, 2);

  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-'));
  try {
    const robot = path.join(folder, 'made');
    const write = ['robots', 'check', file('waist_and_arms'), '--write', robot];
    const first = await command(write);
    assert.equal(first.code, 0, first.stderr);
    assert.match(first.stdout, /waist_yaw/);
    // What may hold corrections by hand is not written over.
    assert.equal((await command(write)).code, 2);
    const list = await command(['robots', '--robots-dir', folder, '--json']);
    assert.equal(JSON.parse(list.stdout).items[0].joints.length, 12);
    const run = ['run', '--robots-dir', folder, '--robot', 'made', '--seconds', '1'];
    assert.equal((await command(run)).code, 0);
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
});
