// Whether the dashboard holds its memory and keeps up, in a real browser on the real server, walking and pushed
// now and then. First at the clock's pace: how old what is shown is, against the server's time. Then faster,
// until the page has read as many frames as in so many minutes at its full rate and so much simulation time
// has passed: what the JavaScript heap has grown by, collected before and after, from a minute on. Prints a table;
// exit code 1 beyond the bounds below. Not a test: its figures depend on what else the machine does.
//   node tests/bench/page.mjs [--minutes 60] [--speed 8] [--lag-seconds 120] [--plant bullet]
// The server's time is that of a client of our own that reads nothing else, by its quickest message in each
// second. The page's is what its bar says, and that of the robot in the 3D view; each counts with the age that it had
// when the next picture of the page was drawn, its greatest. What the screen takes to show a picture is not in it.
import { parseArgs } from 'node:util';
import { Server, eventually, sleep } from '../server/support.mjs';
import { Dashboard, call, launchBrowser } from '../web/support.mjs';

const limits = { heap_growth_mb: 5, lag_ms: 200 };
const fullRateHz = 100;
const warmUpS = 60;
const pushEveryS = 8; // of simulation time
const turnEveryS = 30;

const { values } = parseArgs({
  options: {
    minutes: { type: 'string', default: '60' },
    speed: { type: 'string', default: '8' },
    'lag-seconds': { type: 'string', default: '120' },
    plant: { type: 'string', default: 'bullet' },
  },
});
const minutes = Number(values.minutes);
const speed = Number(values.speed);
const lagS = Number(values['lag-seconds']);

const mb = (bytes) => bytes / 2 ** 20;
const quantile = (sorted, q) => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))];

/** Walks to and fro and round about and is pushed from all sides, by simulation time; what falls gets up. */
class Hand {
  constructor(server) {
    this.server = server;
    this.pushes = 0;
    this.falls = 0;
    this.simulated = 0; // in all worlds so far [s]
  }

  async begin() {
    await call(this.server, 'POST', '/simulation/reset', {});
    const { mass_kg: mass } = await call(this.server, 'GET', '/robots/kasaei');
    this.impulse = Number((0.12 * mass).toFixed(2));
    this.last = this.pushed = this.turned = 0;
    await this.turn();
  }

  async turn() {
    this.way = -(this.way ?? -1);
    await call(this.server, 'POST', '/walk', { vx: 0.15 * this.way, vy: 0, wz: 0.1 });
  }

  async look() {
    const { time_s: t, fallen } = await this.server.state();
    this.simulated += t - this.last;
    this.last = t;
    if (fallen) {
      this.falls += 1;
      await this.begin();
    } else if (t >= this.pushed + pushEveryS) {
      this.pushed = t;
      this.pushes += 1;
      const push = { impulse_ns: this.impulse, direction_deg: (this.pushes * 75) % 360 };
      await call(this.server, 'POST', '/pushes', push);
    } else if (t >= this.turned + turnEveryS) {
      this.turned = t;
      await this.turn();
    }
  }
}

/** Arrivals of the server's frames at a client of our own: by the second, the least of clock minus frame [ms]. */
async function serverClock(server) {
  const stream = await server.stream();
  await stream.subscribe({ rate_hz: 200, channels: [] });
  const least = new Map();
  stream.socket.removeAllListeners('message');
  stream.socket.on('message', (data) => {
    const now = Date.now();
    const { op, t } = JSON.parse(data);
    if (op !== 'data') return;
    const second = Math.floor(now / 1000);
    least.set(second, Math.min(least.get(second) ?? Infinity, now - 1000 * t));
  });
  return { least, close: () => stream.close() };
}

/**
 * Notes in the page the time that its bar says, and that of the robot in 3D, and when the next picture of the page has
 * replaced them: [clock ms, shown s].
 */
function watchTimes() {
  const bar = document.querySelector('#bar-time');
  const seen = { bar: [], robot: [] };
  window.shownTimes = seen;
  let shown = null;
  const look = () => {
    const now = Date.now();
    for (const where of Object.keys(shown ?? {})) seen[where].push([now, shown[where]]);
    const { tick } = window.stagger.scene_state().scene;
    shown = { bar: Number.parseFloat(bar.textContent), robot: tick / 1000 };
    window.watching = requestAnimationFrame(look);
  };
  window.watching = requestAnimationFrame(look);
}

async function measureLag(server, dashboard, hand) {
  const clock = await serverClock(server);
  await dashboard.page.evaluate(watchTimes);
  const end = performance.now() + 1000 * lagS;
  while (performance.now() < end) {
    await hand.look();
    await sleep(250);
  }
  const shown = await dashboard.page.evaluate(() => {
    cancelAnimationFrame(window.watching);
    const seen = window.shownTimes;
    window.shownTimes = undefined;
    return seen;
  });
  await clock.close();
  return Object.fromEntries(
    Object.entries(shown).map(([where, times]) => {
      const ages = times.flatMap(([now, t]) => {
        const zero = clock.least.get(Math.floor(now / 1000));
        return zero === undefined ? [] : [now - 1000 * t - zero];
      });
      ages.sort((a, b) => a - b);
      const pictures = new Set(times.map(([, t]) => t)).size;
      return [where, { pictures, p50: quantile(ages, 0.5), p99: quantile(ages, 0.99), greatest: ages.at(-1) }];
    }),
  );
}

/** After a collection, with the world at rest: the heap with what it holds outside, and the nodes. */
async function collected(server, dashboard, debug) {
  await call(server, 'POST', '/simulation/pause', {});
  await dashboard.until((s) => s.condition === 'paused', 'the pause');
  await sleep(1000); // its last pictures and requests
  for (let i = 0; i < 3; i += 1) await debug.send('HeapProfiler.collectGarbage');
  const { usedSize, backingStorageSize = 0 } = await debug.send('Runtime.getHeapUsage');
  const { nodes, jsEventListeners } = await debug.send('Memory.getDOMCounters');
  await call(server, 'POST', '/simulation/resume', {});
  return { heap: mb(usedSize), stores: mb(backingStorageSize), nodes, listeners: jsEventListeners };
}

/** Counts the page's frames over resets, which begin anew. */
function frameCounter() {
  let [session, last, total] = [null, 0, 0];
  return ({ session_id: now, frames_received: received }) => {
    if (now !== session) [session, last] = [now, 0];
    total += received - last;
    last = received;
    return total;
  };
}

async function measureHeap(server, dashboard, hand) {
  const debug = await dashboard.context.newCDPSession(dashboard.page);
  await debug.send('HeapProfiler.enable');
  await call(server, 'POST', '/simulation/speed', { factor: speed });
  const count = frameCounter();
  const stream = async (until) => {
    let seen = { frames: 0, hz: 0 };
    for (let i = 0; !until(seen); i += 1) {
      await hand.look();
      if (i % 4 === 0) {
        const state = await dashboard.state();
        seen = { frames: count(state), hz: state.rate_hz };
      }
      await sleep(250);
    }
    return seen;
  };
  const began = performance.now();
  const { frames: earlier } = await stream(() => performance.now() - began > 1000 * warmUpS);
  const before = await collected(server, dashboard, debug);
  const [pushes, simulated, start] = [hand.pushes, hand.simulated, performance.now()];
  const wanted = minutes * 60;
  const { frames, hz } = await stream(
    (seen) => seen.frames - earlier >= wanted * fullRateHz && hand.simulated - simulated >= wanted,
  );
  const after = await collected(server, dashboard, debug);
  return {
    before,
    after,
    frames: frames - earlier,
    hz,
    pushes: hand.pushes - pushes,
    simulated: hand.simulated - simulated,
    seconds: (performance.now() - start) / 1000,
  };
}

const browser = await launchBrowser();
const server = await Server.start('--plant', values.plant);
try {
  const hand = new Hand(server);
  await hand.begin();
  const dashboard = await Dashboard.open(browser, server.url, { scale: 1, period: 0 });
  await eventually(async () => (await dashboard.state()).t > 5, 'the first pictures');
  const lag = await measureLag(server, dashboard, hand);
  const heap = await measureHeap(server, dashboard, hand);
  await dashboard.close();

  const growth = heap.after.heap + heap.after.stores - heap.before.heap - heap.before.stores;
  const met = {
    bar: lag.bar.greatest <= limits.lag_ms,
    robot: lag.robot.greatest <= limits.lag_ms,
    heap: growth <= limits.heap_growth_mb,
  };
  const rows = [
    ...['bar', 'robot'].flatMap((where) => {
      const { pictures, p50, p99, greatest } = lag[where];
      return [
        [`Shown behind the server, ${where}`, `${pictures} pictures in ${lagS} s`],
        ['  median, 99th percentile [ms]', `${p50.toFixed(0)}, ${p99.toFixed(0)}`],
        ['  greatest [ms]', `${greatest.toFixed(0)} of ${limits.lag_ms}: ${met[where] ? 'met' : 'MISSED'}`],
      ];
    }),
    [
      `Heap, speed ${speed}`,
      `${heap.frames} frames, ${heap.simulated.toFixed(0)} s simulated in ${heap.seconds.toFixed(0)} s`,
    ],
    ['  pushes, falls, last rate [Hz]', `${heap.pushes}, ${hand.falls}, ${heap.hz}`],
    ...['before', 'after'].map((when) => [
      `  ${when} [MB]`,
      `${heap[when].heap.toFixed(2)} and ${heap[when].stores.toFixed(2)} outside, ` +
        `${heap[when].nodes} nodes, ${heap[when].listeners} listeners`,
    ]),
    ['  growth [MB]', `${growth.toFixed(2)} of ${limits.heap_growth_mb}: ${met.heap ? 'met' : 'MISSED'}`],
  ];
  for (const [name, text] of rows) console.log(`${name.padEnd(34)}${text}`);
  if (!Object.values(met).every(Boolean)) process.exitCode = 1;
} finally {
  await browser.close();
  await server.kill();
}
