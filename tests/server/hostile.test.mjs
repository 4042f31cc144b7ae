// Hostile clients against the real binary: a healthy one is answered throughout, and the simulation
// goes on. How quickly is measured by tests/bench/hostile.mjs; nothing here looks at the clock.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import * as attacks from './attacks.mjs';
import { Server, eventually, sleep } from './support.mjs';

let server;
before(async () => (server = await Server.start()));
after(() => server.end());

/** While the attack goes on, and after it, all is as it should be. */
async function survives(attack) {
  const before = await server.state();
  const healthy = attacks.healthyClient(server);
  let end;
  let seen;
  try {
    end = await attack();
    await eventually(async () => (await server.state()).tick > before.tick + 500, 'ticks');
  } finally {
    end?.();
    seen = await healthy();
  }
  assert.deepEqual(seen.failed, []);
  assert.ok(seen.answered > 0);
  const after = await server.state();
  assert.equal(after.session_id, before.session_id);
  assert.ok(after.running && after.error === null);
}

// More than there are threads.
const many = 150;
const slow = ['slowHeads', 'slowBodies', 'slowLongBodies', 'slowChunks', 'slowReaders', 'silent'];
for (const name of slow) {
  test(`${name}: more of them than there are threads`, () =>
    survives(async () => {
      const end = attacks[name](server, many);
      await sleep(2500); // until all have come in and would hold their threads
      return end;
    }));
}

test('more silent connections than there is room for', () =>
  survives(async () => {
    const end = attacks.silent(server, 2300);
    await sleep(4000);
    return end;
  }));

test('connections that come and go', () => survives(() => attacks.quickConnections(server, 1000)));

for (const [name, bytes] of Object.entries(attacks.badFrames)) {
  test(`frames: ${name}`, () =>
    survives(async () => {
      await attacks.sendFrames(server, bytes, 300);
    }));
}

test('half-open streams leave their places', async () => {
  const half = await Promise.all(
    Array.from({ length: 10 }, () => attacks.sendFrames(server, Buffer.from([0x81]), 50)),
  );
  assert.equal(half.length, 10);
  await eventually(async () => (await server.state()).stream.clients === 0, 'they are gone');
});

test('a wrong Host or Origin is refused', async () => {
  const get = (headers) => server.get('/api/v1/simulation', { headers });
  const port = server.port;
  for (const host of ['evil.com', `evil.com:${port}`, `127.0.0.1.evil.com:${port}`, 'a b']) {
    assert.equal((await get({ host })).status, 403, host);
  }
  for (const origin of ['http://evil.com', 'null', `https://127.0.0.1:${port}`, 'file://']) {
    assert.equal((await get({ origin })).status, 403, origin);
  }
  const own = attacks.host(server);
  const two = `GET /health HTTP/1.1\r\n${own}Host: evil.com\r\nConnection: close\r\n\r\n`;
  assert.equal(attacks.status(await attacks.raw(server, two)), 400);
  const none = await attacks.raw(server, 'GET /health HTTP/1.1\r\nConnection: close\r\n\r\n');
  assert.equal(attacks.status(none), 403);
});

test('no path leads out of the folders that are served', async () => {
  const up = ['../'.repeat(8), '..%2f'.repeat(8), '%2e%2e/'.repeat(8), '%2e%2e%2f'.repeat(8),
    '..\\'.repeat(8), '....//'.repeat(8), '.%00./'.repeat(3), '/'];
  for (const base of ['/', '/assets/', '/api/v1/robots/kasaei/files/', '/api/v1/robots/']) {
    for (const way of up) {
      const target = `${base}${way}etc/passwd`;
      const head = `GET ${target} HTTP/1.1\r\n${attacks.host(server)}Connection: close\r\n\r\n`;
      const text = await attacks.raw(server, head);
      assert.ok([400, 403, 404].includes(attacks.status(text)), `${target}: ${text.slice(0, 80)}`);
      assert.doesNotMatch(text, /root:/);
    }
  }
});

test('what is not HTTP is refused, and nothing of the inside is told', async () => {
  const own = attacks.host(server);
  const post = `POST /api/v1/pushes HTTP/1.1\r\n${own}Content-Type: application/json\r\n`;
  const bad = {
    'no request': 'nonsense\r\n\r\n',
    'TLS': Buffer.from('16030100a5010000a10303'.padEnd(400, '0'), 'hex'),
    'an endless line': `GET /${'a'.repeat(20_000)} HTTP/1.1\r\n${own}\r\n`,
    'an endless header': `GET / HTTP/1.1\r\n${own}X: ${'a'.repeat(20_000)}\r\n\r\n`,
    'endless headers': `GET / HTTP/1.1\r\n${own}${'X: y\r\n'.repeat(500)}\r\n`,
    'two lengths': `${post}Content-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n{}`,
    'a negative length': `${post}Content-Length: -1\r\n\r\n{}`,
    'an endless length': `${post}Content-Length: 99999999999999999999\r\n\r\n{}`,
    'a bad chunk': `${post}Transfer-Encoding: chunked\r\n\r\nzz\r\n{}\r\n`,
    'a huge chunk': `${post}Transfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n{}\r\n`,
    'many ranges': `GET / HTTP/1.1\r\n${own}Range: bytes=${'0-1,'.repeat(1500)}0-1\r\n\r\n`,
  };
  for (const [name, bytes] of Object.entries(bad)) {
    const text = await attacks.raw(server, bytes, 1000);
    const code = attacks.status(text);
    assert.ok(code === 0 || (code >= 400 && code < 500), `${name}: ${text.slice(0, 100)}`);
    assert.doesNotMatch(text, /\.cpp|std::|\/tmp\/|what\(\)/, name);
  }
  assert.equal((await server.get('/health')).status, 200);
});
