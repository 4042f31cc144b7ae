// How the server bears stream clients: three at 100 Hz for 60 s, one more that never reads. Prints a
// JSON object. Not a test: its figures depend on what else the machine does.
//   node tests/bench/stream_load.mjs [--seconds 60] [--rate 100] [--clients 3] [--stalled 1]
//        [--plant bullet]
import { parseArgs } from 'node:util';
import { Server, sleep, stalledClient } from '../server/support.mjs';

const number = (fallback) => ({ type: 'string', default: String(fallback) });
const { values } = parseArgs({
  options: {
    seconds: number(60),
    rate: number(100),
    clients: number(3),
    stalled: number(1),
    plant: { type: 'string', default: 'bullet' },
  },
});
const [seconds, rate, clients, stalledCount] = ['seconds', 'rate', 'clients', 'stalled'].map((name) =>
  Number(values[name]),
);

/** Keeps numbers only: a minute of frames would be much memory. */
function watch(stream) {
  const seen = { messages: 0, bytes: 0, gaps: 0, lost: 0, irregular: 0, longest_silence_ms: 0 };
  let last;
  let at;
  stream.socket.removeAllListeners('message');
  stream.socket.on('message', (data) => {
    const message = JSON.parse(data);
    seen.bytes += data.length;
    if (message.op !== 'data') return;
    const now = performance.now();
    if (last) {
      const missing = message.seq - last.seq - 1;
      if (missing > 0) seen.gaps += 1;
      seen.lost += missing;
      if (seen.messages > 1 && message.tick - last.tick !== 1000 / rate) seen.irregular += 1;
      seen.longest_silence_ms = Math.max(seen.longest_silence_ms, now - at);
    }
    seen.messages += 1;
    last = message;
    at = now;
  });
  return seen;
}

const server = await Server.start('--plant', values.plant);
try {
  const seen = [];
  for (let i = 0; i < clients; ++i) {
    const stream = await server.stream();
    await stream.subscribe({ rate_hz: rate });
    seen.push(watch(stream));
  }
  const before = await server.state();
  const start = performance.now();
  const stalled = [];
  for (let i = 0; i < stalledCount; ++i) stalled.push(await stalledClient(server));
  await sleep(seconds * 1000);
  const wall_s = (performance.now() - start) / 1000;
  const after = await server.state();
  const end = await server.stop();
  for (const socket of stalled) socket.destroy();
  const result = {
    plant: values.plant,
    seconds: wall_s,
    rate_hz: rate,
    clients: seen,
    simulated_s: after.time_s - before.time_s,
    real_time_factor: (after.time_s - before.time_s) / wall_s,
    late_ticks: after.late_ticks - before.late_ticks,
    worst_lateness_ms: after.worst_lateness_ms,
    stream: after.stream,
    exit_code: end.code,
    exit_ms: end.ms,
  };
  console.log(JSON.stringify(result, null, 2));
} finally {
  await server.kill();
}
