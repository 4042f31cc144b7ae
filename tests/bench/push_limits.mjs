// The largest push, by direction, that a robot survives at all of 4 moments of its gait while it steps in place.
//   node tests/bench/push_limits.mjs ROBOT [duration in s] [Froude numbers to try, rising: 0.1,0.12,...]
// A push's Froude number is delta-v / sqrt(g h), h the CoM's height while walking. Pushes to the right are the mirror
// image of those to the left half a gait cycle later, and so left out.
import { execFile } from 'node:child_process';
import { cpus } from 'node:os';
import { fileURLToPath } from 'node:url';

const program = process.env.STAGGER_BIN ?? fileURLToPath(new URL('../../build/bin/stagger', import.meta.url));
const [name = 'kasaei', duration = '0.01', ladder = '0.1,0.12,0.14,0.16,0.2,0.245'] = process.argv.slice(2);

const run = (args, input) => new Promise((resolve, reject) => {
  const child = execFile(program, args, (error, stdout, stderr) => {
    if (error && error.code !== 4) reject(new Error(stderr));
    else resolve(JSON.parse(stdout));
  });
  child.stdin.end(input);
});

const robot = (await run(['robots', '--json'])).items.find((item) => item.name === name);
const height = robot.walking_com_height_m;
const speed = Math.sqrt(9.81 * height);
const time = Math.sqrt(height); // what takes the reference robot, of 1 m, a second
const moments = [0, 1, 2, 3].map((i) => (3 + i / 4) * time); // two steps take it a second

const survives = async (direction_deg, froude) => {
  for (const at_s of moments) {
    const push = {
      direction_deg, at_s, impulse_ns: froude * speed * robot.mass_kg, duration_s: Number(duration),
    };
    const spec = { robot: name, settle_s: 3 * time, observe_s: 3.5 * time, push };
    if ((await run(['trial', '-'], JSON.stringify(spec))).outcome !== 'recovered') return false;
  }
  return true;
};

const directions = [0, 45, 90, 135, 180];
const limits = new Map();
const work = async () => {
  for (let direction = directions.shift(); direction !== undefined; direction = directions.shift()) {
    let limit = 0;
    for (const froude of ladder.split(',').map(Number)) {
      if (!(await survives(direction, froude))) break;
      limit = froude;
    }
    limits.set(direction, limit);
  }
};
await Promise.all(cpus().map(work));
for (const [direction, froude] of [...limits].sort(([a], [b]) => a - b)) {
  console.log(`${name}, ${direction} deg: ${froude} (${(froude * speed).toFixed(2)} m/s)`);
}
