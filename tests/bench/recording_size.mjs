// How large recordings are, what packing saves, and what the recorder costs beside the simulation.
//   node tests/bench/recording_size.mjs [SECONDS]
import fs from 'node:fs';
import { Server } from '../server/support.mjs';
import { readIndexed } from '../server/recording_file.mjs';

const seconds = Number(process.argv[2] ?? 10);
const ms_per_cpu_tick = 10;

/** CPU time of every thread so far [ms]. */
function threads(server) {
  const folder = `/proc/${server.child.pid}/task`;
  const times = fs.readdirSync(folder).map((thread) => {
    const fields = fs.readFileSync(`${folder}/${thread}/stat`, 'utf8').split(') ')[1].split(' ');
    return [thread, ms_per_cpu_tick * (Number(fields[11]) + Number(fields[12]))];
  });
  return new Map(times);
}

for (const [robot, plant] of [
  ['kasaei', 'bullet'],
  ['g1', 'bullet'],
  ['kasaei', 'lipm'],
]) {
  const server = await Server.start('--plant', plant, '--robot', robot);
  try {
    await server.pause();
    const { id } = (await server.post('/api/v1/recordings')).json;
    await server.post('/api/v1/walk', { vx: 0.1 });
    const before = threads(server);
    for (let i = 0; i < seconds; ++i) await server.step(1000);
    const used = [...threads(server)].map(([thread, ms]) => ms - (before.get(thread) ?? 0));
    const [simulation, recorder] = used.sort((a, b) => b - a);
    const info = (await server.post(`/api/v1/recordings/${id}/stop`)).json;
    const { chunks } = await readIndexed(`${server.data}/recordings/${id}.mcap`);
    const sum = (field) => chunks.reduce((total, chunk) => total + Number(chunk[field]), 0);
    const mb_per_s = (1e-6 * info.bytes) / info.duration_s;
    console.log(
      `${robot} on ${plant}: ${mb_per_s.toFixed(2)} MB a simulated second, ` +
        `${(sum('uncompressedSize') / sum('compressedSize')).toFixed(2)} times less than unpacked; ` +
        `busiest threads ${simulation} and ${recorder} ms of CPU for ${seconds} s; ` +
        `${info.lost_ticks} ticks lost`,
    );
  } finally {
    await server.end();
  }
}
