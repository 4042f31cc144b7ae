// Campaigns on a real Slurm of one machine with two virtual nodes: the same results as on this machine alone.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { command, eventually } from './support.mjs';
import { Slurm, missing } from './slurm.mjs';

const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-campaign-slurm-'));
after(() => fs.rmSync(scratch, { recursive: true }));
const patience = 300_000;

const grid = {
  version: 1,
  name: 'grid',
  seed: 3,
  base: {
    robot: 'kasaei', plant: 'lipm', settle_s: 2, observe_s: 2,
    push: { duration_s: 0.05, trigger: { phase: 'single_support', leg: 'left', fraction: 0.1 } },
  },
  design: { kind: 'grid', repeats: 3 },
  factors: { 'push.direction_deg': [0, 90, 180], 'push.impulse_ns': [2, 150] },
};
const bisection = {
  ...grid,
  name: 'bisection',
  design: { kind: 'bisect', axis: 'push.delta_v', lo: 0.1, hi: 4.1, tol: 0.5, scan: 3, repeats: 2 },
  factors: { 'push.direction_deg': [0, 90] },
};

const written = (spec) => {
  const file = path.join(scratch, `${spec.name}-${Math.random()}.json`);
  fs.writeFileSync(file, JSON.stringify(spec));
  return file;
};
const text = (folder, name) => fs.readFileSync(path.join(folder, name), 'utf8');
const results = (folder) => JSON.parse(text(folder, 'summary.json')).results_hash;

describe('on Slurm', { skip: missing() }, () => {
  let slurm;
  before(async () => (slurm = await Slurm.start()));
  after(() => slurm?.end());
  const campaign = (...args) => command(['campaign', ...args], '', () => {}, slurm.environment);
  const local = async (spec) => {
    const out = path.join(scratch, `${spec.name}-local-${Math.random()}`);
    const { code, stderr } = await command(['campaign', 'run', written(spec), '--out', out, '--quiet']);
    assert.equal(code, 0, stderr);
    return out;
  };
  async function submitted(spec, ...args) {
    const out = path.join(scratch, `${spec.name}-slurm-${Math.random()}`);
    const { code, stdout, stderr } = await campaign('submit', written(spec), '--slurm', '--out', out, '--json', ...args);
    assert.equal(code, 0, stderr);
    return { out, ...JSON.parse(stdout) };
  }
  const logs = (out) => fs.readdirSync(path.join(out, 'shards')).filter((name) => name.endsWith('.log'))
    .map((name) => `${name}: ${text(out, `shards/${name}`)}`).join('\n');
  async function ended(out) {
    try {
      await eventually(() => fs.existsSync(path.join(out, 'report.html')), 'the end of the campaign', patience);
    } catch (error) {
      throw new Error(`${error.message}\n${logs(out)}\n${await slurm.command('squeue')}`);
    }
  }
  function sameAs(out, reference) {
    assert.equal(results(out), results(reference));
    assert.equal(text(out, 'trials.csv'), text(reference, 'trials.csv'));
    assert.equal(JSON.parse(text(out, 'summary.json')).state, 'complete');
  }

  test('a campaign in shards gives what it gives here', async () => {
    const { out, shards, trials } = await submitted(grid, '--shards', '3');
    assert.deepEqual([shards, trials], [3, 18]);
    await ended(out);
    sameAs(out, await local(grid));
    const { stdout } = await campaign('status', out);
    assert.match(stdout, /complete, 18 trials/);
    assert.match(stdout, /slurm: round 1, job \d+: ended/);
  });

  test('a bisection goes round by round', async () => {
    const { out } = await submitted(bisection, '--shards', '2');
    await ended(out);
    sameAs(out, await local(bisection));
    assert.ok(JSON.parse(text(out, 'slurm.json')).rounds.length > 1);
  });

  test('a node that dies loses no trial, and none counts twice', async () => {
    const many = { ...grid, name: 'many', design: { kind: 'grid', repeats: 150 } };
    const { out, array } = await submitted(many, '--shards', '2', '--sbatch=--exclusive');
    const attempts = (shard = '') =>
      fs.readdirSync(path.join(out, 'shards'))
        .filter((name) => name.endsWith('.sqlite') && name.includes(`-shard-${shard}`));
    const running = () => slurm.command('squeue', '-h', '-r', '-j', array, '-t', 'running', '-o', '%N %K');
    const [, shard] = await eventually(async () => /^node1 (\d+)/m.exec(await running()), 'a shard on node1', patience);
    await eventually(() => attempts(`${shard}-`).length > 0, 'its store', patience);
    const under_way = await eventually(async () => {
      const { stdout } = await campaign('status', out);
      return /; [1-9]\d* of 900 trials run and not merged yet/.test(stdout) && stdout;
    }, 'trials of the shards', patience);
    assert.match(under_way, /round 1, job \d+: .*running/);
    await slurm.killNode('node1');
    await slurm.command('scontrol', 'update', 'nodename=node1', 'state=down', 'reason=killed');
    slurm.startNode('node1');
    // Either Slurm starts the shard again, or it has seen it end and the next round takes what it has left out.
    await ended(out);
    sameAs(out, await local(many));
    assert.ok(attempts().length > 2, `somebody took over: ${attempts()}`);
  });

  test('what sbatch refuses is told, and bad usage', async () => {
    const refused = await campaign('submit', written(grid), '--slurm', '--out', path.join(scratch, 'refused'),
      '--sbatch=--partition=nowhere');
    assert.notEqual(refused.code, 0);
    assert.match(refused.stderr, /sbatch: .*partition/);
    assert.equal((await campaign('submit', written(grid))).code, 2);
  });
});
