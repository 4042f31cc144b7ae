// Many simulated hours in one process, as fast as they go: walks, pushes, resets to other robots and grounds,
// recordings on and off, clients coming and going, not all of them politely. Prints a JSON object; exit code 1 when
// the robot fell without a push, memory grew, recordings took more than their quota, or a question failed. Not a
// test: it takes half an hour.
//   node tests/bench/soak.mjs [--hours 6] [--quota-mb 200] [--seed 1]
// Memory is the median of the process's resident set over the last simulated hour against that over the second one:
// by then each robot and each kind of client has been there, and what is kept of the past is full. That of each robot
// in each sixth of the run stands beside it.
import fs from 'node:fs';
import net from 'node:net';
import os from 'node:os';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { Server, sleep, stalledClient } from '../server/support.mjs';

const limits = { rss_growth_mb: 5, over_quota_mb: 0 };
/** A fall later than this after the last push has another reason [s of simulation time]. */
const pushFallS = 10;
const every = { walk: 20, push: 30, recording: 240, armed: 400, world: 600 }; // [s of simulation time]
const clientEveryMs = 1500;
const mostClients = 8;
const robots = ['kasaei', 'h1_2', 'g1', 'op3'];
const grounds = [{ kind: 'flat' }, { kind: 'slope', angle_deg: 3 }, { kind: 'uneven', height_m: 0.01 }];

const { values } = parseArgs({
  options: {
    hours: { type: 'string', default: '6' },
    'quota-mb': { type: 'string', default: '200' },
    seed: { type: 'string', default: '1' },
  },
});
const wanted = 3600 * Number(values.hours);
const quotaMb = Number(values['quota-mb']);

let random = Number(values.seed);
/** The same course each time, as far as the machine's pace allows: in [0, 1). */
const chance = () => (random = (random * 16807) % 2147483647) / 2147483647;
const oneOf = (list) => list[Math.floor(chance() * list.length)];

const server = await Server.start('--plant', 'bullet', '--quota-gb', String(quotaMb / 1000));
const seen = { worlds: 0, walks: 0, pushes: 0, falls: 0, recordings: 0, clients: 0, questions: 0 };
const failures = [];
const fallsWithoutPush = [];

async function ask(method, route, body, others = []) {
  seen.questions += 1;
  const answer = await server.request(method, `/api/v1${route}`, { body });
  if (answer.status >= 300 && !others.includes(answer.status)) {
    failures.push(`${method} ${route} ${JSON.stringify(body)}: ${answer.status} ${answer.text}`);
  }
  return answer.json;
}

const rssMb = () =>
  Number(/VmRSS:\s+(\d+)/.exec(fs.readFileSync(`/proc/${server.child.pid}/status`, 'utf8'))[1]) / 1024;
const descriptors = () => fs.readdirSync(`/proc/${server.child.pid}/fd`).length;
function diskMb() {
  const folder = path.join(server.data, 'recordings');
  const sizes = fs.readdirSync(folder).map((name) => fs.statSync(path.join(folder, name), { throwIfNoEntry: false }));
  return sizes.reduce((sum, stat) => sum + (stat?.size ?? 0), 0) / 1e6;
}

/** What is simulated: the present world, and when it was last walked and pushed in it. */
const world = { simulated: 0, time: 0, session: '', walked: 0, pushed: -Infinity, began: 0, told: false };
const since = { recording: 0, armed: 0 };
let recording = null;
let robot = robots[0];
let unit = 1; // of velocity: that of a robot as high as kasaei is 1
let mass = 30;

async function begin() {
  robot = robots[seen.worlds % robots.length];
  const terrain = { ...grounds[Math.floor(seen.worlds / robots.length) % grounds.length] };
  seen.worlds += 1;
  const description = await ask('GET', `/robots/${robot}`);
  mass = description.mass_kg;
  unit = Math.sqrt(description.com_height_m);
  if (terrain.kind === 'uneven') terrain.height_m *= description.com_height_m;
  await ask('POST', '/simulation/reset', { robot, seed: seen.worlds, terrain });
  Object.assign(world, { time: 0, walked: 0, pushed: -Infinity, began: world.simulated, told: false });
}

async function look() {
  const state = await ask('GET', '/simulation');
  if (state.session_id !== world.session) {
    world.session = state.session_id;
    world.time = 0;
  }
  world.simulated += Math.max(0, state.time_s - world.time);
  world.time = state.time_s;
  return state;
}

/** The flight recorder's file of the newest fall, copied to where it outlives the server. */
async function keepFall() {
  await sleep(2000); // its end is still to come
  const [newest] = (await ask('GET', '/recordings?reason=fall&limit=1')).items;
  const file = path.join(os.tmpdir(), `soak-fall-${newest.id}.mcap`);
  fs.copyFileSync(path.join(server.data, 'recordings', `${newest.id}.mcap`), file);
  return file;
}

async function fell(state) {
  seen.falls += 1;
  const [event] = (await ask('GET', '/events?kind=fall&limit=1')).items;
  if (event.tick / 1000 - world.pushed > pushFallS) {
    const file = await keepFall();
    fallsWithoutPush.push({ robot, seed: seen.worlds, tick: event.tick, why: state.fall_reason, file });
  }
  await begin();
}

async function act() {
  if (world.simulated - world.began >= every.world) return begin();
  if (world.time - world.walked >= every.walk) {
    world.walked = world.time;
    seen.walks += 1;
    const way = oneOf([[0.3, 0, 0], [-0.2, 0, 0], [0, 0.1, 0], [0.1, 0, 0.2], [0, 0, -0.3], null]);
    if (way === null) await ask('POST', '/stop', {});
    else await ask('POST', '/walk', { vx: way[0] * unit, vy: way[1] * unit, wz: way[2] });
  }
  const last = Math.max(0, world.pushed);
  if (world.time - last >= every.push) {
    seen.pushes += 1;
    // Near the limit of the robots, now and then beyond it.
    const speed = (chance() < 0.05 ? 1.5 : 0.1 + 0.3 * chance()) * unit;
    const push = { impulse_ns: speed * mass, direction_deg: Math.floor(360 * chance()), duration_s: oneOf([0.01, 0.1]) };
    const made = await ask('POST', '/pushes', push, [409]); // it fell meanwhile
    world.pushed = (made?.tick ?? 1000 * world.time) / 1000 + 0.1;
  }
  if (world.simulated - since.recording >= every.recording) {
    since.recording = world.simulated;
    if (recording === null) {
      seen.recordings += 1;
      recording = (await ask('POST', '/recordings', { before_s: oneOf([0, 20]), tags: ['soak'] }, [409]))?.id ?? null;
    } else {
      await ask('POST', `/recordings/${recording}/stop`, {}, [404]);
      recording = null;
    }
  }
  if (world.simulated - since.armed >= every.armed) {
    since.armed = world.simulated;
    seen.recordings += 1;
    await ask('POST', '/recordings', { when: 'push', before_s: 5, after_s: 10 }, [409]);
  }
}

const clients = [];
/** Without a word. */
const leave = (socket) => (socket instanceof net.Socket ? socket.destroy() : socket.terminate());
async function comeAndGo() {
  while (clients.length >= mostClients || (clients.length > 0 && chance() < 0.45)) {
    const [client] = clients.splice(Math.floor(chance() * clients.length), 1);
    leave(client);
  }
  seen.clients += 1;
  const kind = chance();
  if (kind < 0.1) {
    clients.push(await stalledClient(server));
    return;
  }
  const stream = await server.stream();
  stream.socket.removeAllListeners('message');
  stream.socket.on('message', () => {}); // read, and not kept
  stream.send({ op: 'subscribe', rate_hz: oneOf([10, 100]), format: oneOf(['json', 'float64', 'float32']) });
  clients.push(stream.socket);
}

try {
  await ask('POST', '/simulation/speed', { factor: 'max' });
  await begin();
  const samples = [];
  let disk = 0;
  const start = performance.now();
  let client = start;
  let told = start;
  while (world.simulated < wanted && server.child.exitCode === null) {
    const state = await look();
    if (state.fallen) await fell(state);
    else await act();
    if (performance.now() - client > clientEveryMs) {
      client = performance.now();
      await comeAndGo();
    }
    samples.push({ at: world.simulated, robot, rss: rssMb(), descriptors: descriptors() });
    disk = Math.max(disk, diskMb());
    if (performance.now() - told > 60_000) {
      told = performance.now();
      console.error(`${(world.simulated / 3600).toFixed(2)} h, ${rssMb().toFixed(1)} MB, ${JSON.stringify(seen)}`);
    }
    await sleep(60);
  }
  const seconds = (performance.now() - start) / 1000;
  clients.forEach(leave);
  const end = await server.stop();

  const median = (column, wants) => {
    const some = samples.filter(wants).map((sample) => sample[column]).sort((a, b) => a - b);
    return some[Math.floor(some.length / 2)];
  };
  const hour = Math.min(3600, wanted / 6);
  const early = ({ at }) => at >= hour && at < 2 * hour;
  const late = ({ at }) => at >= wanted - hour;
  const rss = { second_hour: median('rss', early), last_hour: median('rss', late) };
  const sixths = (of) =>
    [...Array(6).keys()].map((sixth) =>
      median('rss', ({ at, robot: one }) => one === of && Math.floor((6 * at) / wanted) === sixth),
    );
  const result = {
    simulated_h: world.simulated / 3600,
    seconds,
    real_time_factor: world.simulated / seconds,
    seen,
    falls_without_push: fallsWithoutPush,
    failures,
    rss_mb: {
      ...rss,
      growth: rss.last_hour - rss.second_hour,
      sixths: Object.fromEntries(robots.map((one) => [one, sixths(one)])),
    },
    descriptors: { second_hour: median('descriptors', early), last_hour: median('descriptors', late) },
    recordings_mb: { most: disk, quota: quotaMb },
    exit_code: end.code,
  };
  const met = {
    falls: fallsWithoutPush.length === 0,
    memory: result.rss_mb.growth <= limits.rss_growth_mb,
    disk: disk - quotaMb <= limits.over_quota_mb,
    questions: failures.length === 0,
    end: end.code === 0,
  };
  console.log(JSON.stringify({ ...result, met }, null, 2));
  if (!Object.values(met).every(Boolean)) process.exitCode = 1;
} finally {
  await server.kill();
}
