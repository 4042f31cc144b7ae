// A client that stops reading costs nobody but itself.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Server, eventually, sleep, stalledClient } from './support.mjs';

let server;
before(async () => (server = await Server.start()));
after(() => server.end());

test('a stalled client is dropped and counted; the others have no gap', async () => {
  const good = [await server.stream(), await server.stream()];
  for (const stream of good) await stream.subscribe({ rate_hz: 100 });
  const before = await server.state();
  const stalled = await stalledClient(server);
  const dropped = await eventually(async () => {
    const { stream } = await server.state();
    return stream.dropped_clients === 1 && stream;
  }, 'the stalled client is dropped');
  assert.ok(dropped.dropped_messages > 0);
  await eventually(async () => (await server.state()).stream.clients === 2, 'it is gone');
  await sleep(1000);
  const after = await server.state();
  for (const stream of good) {
    const data = stream.all('data');
    assert.ok(data.length > 100);
    for (let i = 1; i < data.length; ++i) assert.equal(data[i].seq, data[i - 1].seq + 1);
    for (let i = 2; i < data.length; ++i) assert.equal(data[i].tick - data[i - 1].tick, 10);
    await stream.close();
  }
  // The simulation has not stopped for a moment: it never waits for anybody. (How late ticks are is
  // measured by tests/bench/load.mjs; here the machine may be busy with anything.)
  assert.ok(after.tick - before.tick > 1000);
  assert.equal(after.running, true);
  stalled.destroy();
});
