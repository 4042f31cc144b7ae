// How many moments of a gait cycle survive a push, a direction at a time: the table in the README.
//   node tests/bench/push_sweep.mjs [impulse in N s] [robot] [estimated|perfect] [delay of the control in ms]
// What is left out is as a trial has it by default.
import { execFile } from 'node:child_process';
import { cpus } from 'node:os';
import { fileURLToPath } from 'node:url';

const program = process.env.STAGGER_BIN ?? fileURLToPath(new URL('../../build/bin/stagger', import.meta.url));
const impulse = Number(process.argv[2] ?? 6);
const robot = process.argv[3] ?? 'kasaei';
const senses = {};
if (process.argv[4]) senses.state = process.argv[4];
if (process.argv[5]) senses.control_delay_ms = Number(process.argv[5]);
const directions = [0, 90, 180, 270];
const moments = Array.from({ length: 20 }, (_, i) => 3 + 0.05 * i); // two steps take a second

const trial = (specification) => new Promise((resolve, reject) => {
  const child = execFile(program, ['trial', '-'], (error, stdout, stderr) => {
    if (error && error.code !== 4) reject(new Error(stderr));
    else resolve(JSON.parse(stdout));
  });
  child.stdin.end(JSON.stringify(specification));
});

const jobs = directions.flatMap((direction_deg) => moments.map((at_s) => ({ direction_deg, at_s })));
const survived = new Map(directions.map((direction) => [direction, []]));
const fell = new Map(directions.map((direction) => [direction, []]));
const work = async () => {
  for (let job = jobs.shift(); job; job = jobs.shift()) {
    const push = { ...job, impulse_ns: impulse, duration_s: 0.05 };
    const { outcome } = await trial({ robot, ...senses, settle_s: 3, observe_s: 5, push });
    (outcome === 'recovered' ? survived : fell).get(job.direction_deg).push(job.at_s.toFixed(2));
  }
};
await Promise.all(cpus().map(work));

for (const direction of directions) {
  const lost = fell.get(direction).sort().join(' ');
  console.log(`${impulse} N s towards ${direction} deg: ${survived.get(direction).length} of ${moments.length}` +
    (lost ? `, fell when pushed at ${lost} s` : ''));
}
