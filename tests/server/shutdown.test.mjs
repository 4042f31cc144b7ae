// Ends: SIGTERM and SIGINT with clients of every kind.
import assert from 'node:assert/strict';
import net from 'node:net';
import { test } from 'node:test';
import { Server, command, sleep, stalledClient, within } from './support.mjs';

async function withServer(run) {
  const server = await Server.start();
  try {
    await run(server);
  } finally {
    await server.kill();
  }
}

test('SIGTERM ends with 0', () =>
  withServer(async (server) => {
    const end = await server.stop();
    assert.deepEqual([end.code, end.signal], [0, null]);
    assert.ok(end.ms < 5000, `${end.ms} ms`);
  }));

test('SIGINT ends with 0', () =>
  withServer(async (server) => {
    server.child.kill('SIGINT');
    assert.equal((await within(server.ended, 'the end')).code, 0);
  }));

test('SIGTERM with open, silent and stalled clients ends with 0 within 5 s', () =>
  withServer(async (server) => {
    const open = [];
    for (let i = 0; i < 5; ++i) {
      const stream = await server.stream();
      await stream.subscribe({ rate_hz: 100 });
      open.push(stream);
    }
    const silent = await server.stream();
    const stalled = [await stalledClient(server), await stalledClient(server)];
    const idle = net.connect(server.port, '127.0.0.1');
    const half = net.connect(server.port, '127.0.0.1');
    for (const socket of [idle, half]) socket.on('error', () => {});
    half.write('POST /api/v1/walk HTTP/1.1\r\nHost: ');
    await server.pause();
    const step = server.step(10000).catch(() => 'cut off');
    await sleep(1500); // the stalled ones fill their buffers
    const end = await server.stop();
    assert.deepEqual([end.code, end.signal], [0, null], server.stderr);
    assert.ok(end.ms < 5000, `${end.ms} ms`);
    for (const stream of [...open, silent]) {
      assert.equal((await within(stream.closed, 'the close')).code, 1001);
    }
    await within(step, 'the step is answered');
    for (const socket of [...stalled, idle, half]) socket.destroy();
  }));

test('a port that is taken is refused with 3', () =>
  withServer(async (server) => {
    const second = await command(['serve', '--port', String(server.port), '--plant', 'lipm']);
    assert.equal(second.code, 3);
    assert.match(second.stderr, /cannot listen/);
  }));

test('an address that others can reach takes a key', async () => {
  const refused = await command(['serve', '--port', '0', '--host', '0.0.0.0']);
  assert.equal(refused.code, 2);
  assert.match(refused.stderr, /--api-key-file/);
});
