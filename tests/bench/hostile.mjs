// How a healthy client and the simulation fare while others misbehave: each attack in turn, with
// late ticks (more than 5 ms) and the healthy client's longest wait. Prints a JSON object; exit code 1
// when the healthy client was not answered. Not a test: the attackers share the machine.
//   node tests/bench/hostile.mjs [--seconds 10] [--count 400] [--quick 10000] [--plant bullet]
import { parseArgs } from 'node:util';
import * as attacks from '../server/attacks.mjs';
import { Server, sleep } from '../server/support.mjs';

const number = (fallback) => ({ type: 'string', default: String(fallback) });
const { values } = parseArgs({
  options: {
    seconds: number(10),
    count: number(400),
    quick: number(10_000),
    plant: { type: 'string', default: 'bullet' },
  },
});
const [seconds, count, quick] = ['seconds', 'count', 'quick'].map((name) => Number(values[name]));

const lasting = (attack) => async (server) => {
  const end = attack(server, count);
  await sleep(seconds * 1000);
  end();
};

const all = {
  nothing: () => sleep(seconds * 1000),
  slow_heads: lasting(attacks.slowHeads),
  slow_bodies: lasting(attacks.slowBodies),
  slow_long_bodies: lasting(attacks.slowLongBodies),
  slow_chunks: lasting(attacks.slowChunks),
  slow_readers: lasting(attacks.slowReaders),
  silent: lasting((server) => attacks.silent(server, 3 * count)),
  quick_connections: (server) => attacks.quickConnections(server, quick),
  bad_frames: async (server) => {
    for (const bytes of Object.values(attacks.badFrames)) {
      await Promise.all(Array.from({ length: 8 }, () => attacks.sendFrames(server, bytes, 500)));
    }
  },
};

const server = await Server.start('--plant', values.plant);
try {
  const result = {};
  for (const [name, attack] of Object.entries(all)) {
    const before = await server.state();
    const start = performance.now();
    const stop = attacks.healthyClient(server);
    await attack(server);
    const healthy = await stop();
    const after = await server.state();
    result[name] = {
      seconds: (performance.now() - start) / 1000,
      ticks: after.tick - before.tick,
      late_ticks: after.late_ticks - before.late_ticks,
      answered: healthy.answered,
      failed: healthy.failed,
      longest_ms: healthy.longest_ms,
    };
    if (healthy.failed.length > 0 || healthy.answered === 0) process.exitCode = 1;
    await sleep(1500); // what is left of one attack is no part of the next
  }
  const end = await server.stop();
  console.log(JSON.stringify({ ...result, exit_code: end.code, exit_ms: end.ms }, null, 2));
} finally {
  await server.kill();
}
