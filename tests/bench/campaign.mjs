// Campaigns under load: does every trial survive kill -9, what does a trial cost, and what do two workers gain?
//   node tests/bench/campaign.mjs kill [trials] [kills] [lipm|bullet]   kills at random moments, then compares
//   node tests/bench/campaign.mjs cost [lipm|bullet] [trials...]        cost and memory, campaign by campaign
//   node tests/bench/campaign.mjs workers [trials] [lipm|bullet]        one worker against two
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const program = process.env.STAGGER_BIN ?? fileURLToPath(new URL('../../build/bin/stagger', import.meta.url));
const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-bench-'));
let running;
process.on('exit', () => {
  running?.kill('SIGKILL');
  fs.rmSync(scratch, { recursive: true });
});
for (const signal of ['SIGINT', 'SIGTERM']) process.on(signal, () => process.exit(1));

function specification(trials, plant) {
  const file = path.join(scratch, `${trials}-${plant}.json`);
  fs.writeFileSync(file, JSON.stringify({
    version: 1, name: 'bench', seed: 9,
    base: { robot: 'kasaei', plant, settle_s: 2, observe_s: 2, push: { duration_s: 0.05 } },
    design: { kind: 'random', samples: trials },
    factors: { 'push.direction_deg': { uniform: [0, 360] }, 'push.delta_v': { uniform: [0.1, 0.8] } },
    limits: { max_trials: trials },
  }));
  return file;
}

/** Runs to the end, or until it is killed after so many trials of its own. */
function run(args, killAfter = Infinity) {
  return new Promise((resolve, reject) => {
    const began = performance.now();
    const child = spawn(program, ['campaign', ...args, '--quiet', '--json'], { stdio: ['ignore', 'pipe', 'inherit'] });
    running = child;
    const numbers = [];
    let rest = '';
    let peak = 0;
    const look = setInterval(() => {
      try {
        const found = /VmHWM:\s+(\d+)/.exec(fs.readFileSync(`/proc/${child.pid}/status`, 'utf8'));
        if (found) peak = Number(found[1]) / 1024;
      } catch { /* it has ended */ }
    }, 20);
    child.stdout.on('data', (data) => {
      const lines = (rest + data).split('\n');
      rest = lines.pop();
      for (const line of lines) {
        const event = JSON.parse(line);
        if (event.event === 'trial') numbers.push(event.number);
      }
      if (numbers.length >= killAfter) child.kill('SIGKILL');
    });
    child.on('error', reject);
    child.on('close', (code, signal) => {
      clearInterval(look);
      resolve({ code, signal, numbers, peak, seconds: (performance.now() - began) / 1000 });
    });
  });
}
const summary = (out) => JSON.parse(fs.readFileSync(path.join(out, 'summary.json')));

const [mode, ...rest] = process.argv.slice(2);
if (mode === 'kill') {
  const trials = Number(rest[0] ?? 2000);
  const kills = Number(rest[1] ?? 20);
  const file = specification(trials, rest[2] ?? 'lipm');
  const whole = path.join(scratch, 'whole');
  await run(['run', file, '--out', whole]);
  const out = path.join(scratch, 'killed');
  const told = new Map();
  let killed = 0;
  let args = ['run', file, '--out', out];
  for (; killed < kills; args = ['resume', out]) {
    const result = await run(args, 1 + Math.floor(Math.random() * 1.9 * trials / (kills + 1)));
    for (const number of result.numbers) told.set(number, (told.get(number) ?? 0) + 1);
    if (result.signal !== 'SIGKILL') break;
    ++killed;
  }
  const last = await run(['resume', out]);
  for (const number of last.numbers) told.set(number, (told.get(number) ?? 0) + 1);
  const again = [...told.values()].filter((count) => count > 1).length;
  assert.equal(again, 0, `${again} trials were run again`);
  assert.equal(fs.readFileSync(path.join(out, 'trials.csv'), 'utf8'),
    fs.readFileSync(path.join(whole, 'trials.csv'), 'utf8'));
  assert.equal(summary(out).trials, trials);
  console.log(`killed ${killed} times: ${trials} trials, each once, results ${summary(out).results_hash} as without`);
} else if (mode === 'cost') {
  for (const trials of rest.length > 1 ? rest.slice(1).map(Number) : [100, 1000, 20000]) {
    const out = path.join(scratch, `cost-${trials}`);
    const { seconds, peak } = await run(['run', specification(trials, rest[0] ?? 'lipm'), '--out', out]);
    const { cost } = summary(out);
    const size = fs.statSync(path.join(out, 'campaign.sqlite')).size;
    console.log(`${trials} trials: ${(1000 * cost.cpu_s / trials).toFixed(3)} ms of a core each, ` +
      `${cost.real_time_factor.toFixed(0)} x real time, ${(1000 * seconds / trials).toFixed(3)} ms on the clock, ` +
      `${peak.toFixed(0)} MB at the most, ${(size / trials).toFixed(0)} bytes a trial on disk`);
  }
} else if (mode === 'workers') {
  const file = specification(Number(rest[0] ?? 5000), rest[1] ?? 'lipm');
  const rate = [];
  for (const threads of [1, 2]) {
    const out = path.join(scratch, `workers-${threads}`);
    const { seconds, numbers } = await run(['run', file, '--out', out, '--threads', String(threads)]);
    rate.push(numbers.length / seconds);
    console.log(`${threads} workers: ${rate.at(-1).toFixed(1)} trials/s`);
  }
  console.log(`two workers are ${(rate[1] / rate[0]).toFixed(2)} times as quick`);
} else {
  console.error('usage: campaign.mjs kill|cost|workers');
  process.exitCode = 2;
}
