// How the server bears its clients: 32 on the stream at 100 Hz, one more that never reads, and 50
// requests a second, for 5 minutes. Prints a JSON object; exit code 1 when a limit below is missed.
// Not a test: its figures depend on what else the machine does.
//   node tests/bench/load.mjs [--seconds 300] [--rate 100] [--clients 32] [--stalled 1]
//        [--requests 50] [--plant bullet] [--format json]
// Latency is from the frame's place in time to its arrival, over the quickest message of the run: the
// stream's clock and this one's have no common zero. The clients share this one process, whose own
// work counts in it.
import fs from 'node:fs';
import { parseArgs } from 'node:util';
import { Server, decode, sleep, stalledClient } from '../server/support.mjs';

const limits = {
  late_share: 0.001, // of the ticks, more than 5 ms late
  p99_ms: 20,
  rss_growth_mb: 5, // after the first minute
};

const number = (fallback) => ({ type: 'string', default: String(fallback) });
const { values } = parseArgs({
  options: {
    seconds: number(300),
    rate: number(100),
    clients: number(32),
    stalled: number(1),
    requests: number(50),
    plant: { type: 'string', default: 'bullet' },
    format: { type: 'string', default: 'json' },
  },
});
const [seconds, rate, clients, stalledCount, requests] = [
  'seconds', 'rate', 'clients', 'stalled', 'requests',
].map((name) => Number(values[name]));

/** Keeps numbers only: minutes of frames would be much memory. Offsets are clock minus frame [ms]. */
function watch(stream, offsets) {
  const seen = { messages: 0, bytes: 0, lost: 0, irregular: 0 };
  let last;
  stream.socket.removeAllListeners('message');
  stream.socket.on('message', (data, isBinary) => {
    const now = performance.now();
    const message = isBinary ? decode(stream.layout, data) : JSON.parse(data);
    seen.bytes += data.length;
    if (message.op !== 'data') return;
    if (last) {
      seen.lost += message.seq - last.seq - 1;
      if (seen.messages > 1 && message.tick - last.tick !== 1000 / rate) seen.irregular += 1;
    }
    seen.messages += 1;
    offsets.push(now - message.t * 1000);
    last = message;
  });
  return seen;
}

/** Time given up (docs/api.md) shifts frames against the clock for good: each second counts anew. */
function latencies(offsets) {
  const chunk = Math.max(1, rate * clients);
  const all = [];
  for (let i = 0; i < offsets.length; i += chunk) {
    const part = offsets.slice(i, i + chunk);
    const least = part.reduce((a, b) => Math.min(a, b));
    for (const offset of part) all.push(offset - least);
  }
  return all.sort((a, b) => a - b);
}

const quantile = (sorted, q) => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))];

function rssMb(pid) {
  return Number(/VmRSS:\s+(\d+)/.exec(fs.readFileSync(`/proc/${pid}/status`, 'utf8'))[1]) / 1024;
}

/** Looks and commands in turn, at a steady pace, whatever the answers take. */
function ask(server) {
  const seen = { sent: 0, answered: 0, failed: 0, took: [] };
  const one = async (i) => {
    const start = performance.now();
    try {
      const answer =
        i % 5 === 0
          ? await server.post('/api/v1/walk', { vx: 0 })
          : await server.get(i % 2 ? '/api/v1/simulation' : '/api/v1/pushes?limit=10');
      answer.status === 200 ? (seen.answered += 1) : (seen.failed += 1);
    } catch {
      seen.failed += 1;
    }
    seen.took.push(performance.now() - start);
  };
  const timer = requests > 0 ? setInterval(() => void one(seen.sent++), 1000 / requests) : null;
  return async () => {
    clearInterval(timer);
    for (let i = 0; i < 200 && seen.answered + seen.failed < seen.sent; ++i) await sleep(50);
    const sorted = seen.took.sort((a, b) => a - b);
    return { ...seen, took: undefined, p99_ms: quantile(sorted, 0.99) };
  };
}

const server = await Server.start('--plant', values.plant);
try {
  const offsets = [];
  const seen = [];
  for (let i = 0; i < clients; ++i) {
    const stream = await server.stream();
    await stream.subscribe({ rate_hz: rate, format: values.format });
    seen.push(watch(stream, offsets));
  }
  await sleep(1000); // the start of a process is not its load
  offsets.length = 0;
  const before = await server.state();
  const start = performance.now();
  const stalled = [];
  for (let i = 0; i < stalledCount; ++i) stalled.push(await stalledClient(server));
  const stopAsking = ask(server);
  const rss = [];
  while (performance.now() - start < seconds * 1000) {
    await sleep(1000);
    rss.push(rssMb(server.child.pid));
  }
  const wall_s = (performance.now() - start) / 1000;
  const rest = await stopAsking();
  const after = await server.state();
  const end = await server.stop();
  for (const socket of stalled) socket.destroy();

  const ticks = after.tick - before.tick;
  const late_ticks = after.late_ticks - before.late_ticks;
  const sorted = latencies(offsets);
  const settled = rss[Math.min(60, Math.floor(rss.length / 2))];
  const result = {
    plant: values.plant,
    seconds: wall_s,
    rate_hz: rate,
    clients,
    format: values.format,
    real_time_factor: (after.time_s - before.time_s) / wall_s,
    ticks,
    late_ticks,
    late_share: late_ticks / ticks,
    worst_lateness_ms: after.worst_lateness_ms,
    latency_ms: {
      p50: quantile(sorted, 0.5),
      p99: quantile(sorted, 0.99),
      worst: sorted.at(-1),
    },
    messages: seen.reduce((sum, client) => sum + client.messages, 0),
    bytes_a_message: seen[0] && seen[0].bytes / seen[0].messages,
    lost: seen.reduce((sum, client) => sum + client.lost, 0),
    irregular: seen.reduce((sum, client) => sum + client.irregular, 0),
    requests: rest,
    dropped_clients: after.stream.dropped_clients - before.stream.dropped_clients,
    rss_mb: { settled, last: rss.at(-1), growth: rss.at(-1) - settled },
    exit_code: end.code,
    exit_ms: end.ms,
  };
  const met = {
    late_ticks: result.late_share <= limits.late_share,
    latency: !sorted.length || result.latency_ms.p99 <= limits.p99_ms,
    nothing_lost: result.lost === 0 && result.irregular === 0,
    stalled_dropped: result.dropped_clients === stalledCount,
    all_answered: rest.failed === 0 && rest.answered === rest.sent,
    memory: result.rss_mb.growth <= limits.rss_growth_mb,
    exit: end.code === 0,
  };
  console.log(JSON.stringify({ ...result, met }, null, 2));
  if (!Object.values(met).every(Boolean)) process.exitCode = 1;
} finally {
  await server.kill();
}
