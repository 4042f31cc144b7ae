// One kill -9 in the middle of recording, and what is left of it.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { Server, command, sleep } from './support.mjs';
import { readIndexed, readStreaming } from './recording_file.mjs';

const base = '/api/v1/recordings';
const ticksOf = ({ topics }) => (topics['/frame'] ?? []).map(({ value }) => Number(value.tick));

/**
 * Records for so long, kills the server, and reads the file: as it was left, and after the next start.
 * lost_ms: simulated time that the server had shown before the kill and the file lacks.
 */
export async function killWhileRecording(ms) {
  const data = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-crash-'));
  try {
    const server = await Server.start('--data', data);
    const { id } = (await server.post(base, { note: 'cut', tags: ['crash'], protected: true })).json;
    await server.post('/api/v1/pushes', { impulse_ns: 2 });
    await sleep(ms);
    const { tick } = await server.state();
    await server.kill();

    const file = path.join(data, 'recordings', `${id}.mcap`);
    const cut = ticksOf(readStreaming(file));
    const again = await Server.start('--data', data);
    try {
      const info = (await again.get(`${base}/${id}`)).json;
      assert.equal(info.state, 'done');
      assert.equal(info.note, 'cut');
      assert.deepEqual(info.tags, ['crash']);
      assert.equal(info.protected, true);
      const indexed = await readIndexed(file);
      const ticks = ticksOf(indexed);
      assert.equal(info.ticks, ticks.length);
      assert.equal(info.bytes, fs.statSync(file).size);
      assert.deepEqual(indexed.topics, readStreaming(file).topics);
      ticks.forEach((value, i) => assert.equal(value, ticks[0] + i, 'a tick is missing'));
      const files = fs.readdirSync(path.dirname(file)).map((name) => path.parse(name).name);
      const { items } = (await again.get(`${base}?limit=1000`)).json;
      assert.deepEqual(items.map((item) => item.id).sort(), files.sort());
      return {
        cut_ticks: cut.length,
        ticks: ticks.length,
        lost_ms: Math.max(0, tick - 1 - (ticks.at(-1) ?? 0)),
        // Killed before its first chunk, it holds nothing to replay.
        replay: ticks.length > 0 ? (await command(['replay', file])).code : 0,
      };
    } finally {
      await again.end();
    }
  } finally {
    fs.rmSync(data, { recursive: true, force: true });
  }
}
