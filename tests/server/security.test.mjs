// Keys, tickets, origins, limits and headers against the real binary.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import WebSocket from 'ws';
import { Server, command, isProblem, within } from './support.mjs';

const key = 'the-key-of-the-tests';
const readOnlyKey = 'the-key-that-only-looks';
const bearer = (text) => ({ headers: { authorization: `Bearer ${text}` } });

let folder;
before(() => (folder = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-'))));
after(() => fs.rmSync(folder, { recursive: true }));

function file(name, text, mode = 0o600) {
  const full = path.join(folder, name);
  fs.writeFileSync(full, text, { mode });
  return full;
}

/** The status of a refused handshake, or 101. */
function handshake(server, target, options) {
  const answer = new Promise((resolve) => {
    const socket = new WebSocket(`ws://127.0.0.1:${server.port}${target}`, options);
    socket.on('unexpected-response', (_, response) => resolve(response.statusCode));
    socket.on('open', () => {
      resolve(101);
      socket.terminate();
    });
    socket.on('error', () => {});
  });
  return within(answer, 'the handshake');
}

describe('with keys', () => {
  let server;
  before(async () => {
    server = await Server.startWith(
      { STAGGER_READ_ONLY_KEY: readOnlyKey },
      '--api-key-file', file('key', `${key}\n`),
    );
  });
  after(() => server.end());

  test('the API needs one, the page and the probes do not', async () => {
    for (const target of ['/api/v1/simulation', '/api/v1/robots', '/api/v1/nothing']) {
      const answer = await server.get(target);
      assert.ok(isProblem(answer, 401), target);
      assert.equal(answer.headers['www-authenticate'], 'Bearer');
    }
    for (const target of ['/', '/health']) assert.equal((await server.get(target)).status, 200);
    assert.equal((await server.get('/api/v1/simulation', bearer(key))).status, 200);
    const other = { headers: { 'x-api-key': key } };
    assert.equal((await server.get('/api/v1/simulation', other)).status, 200);
    assert.equal((await server.post('/api/v1/stop', {}, bearer(key))).status, 200);
  });

  test('a wrong key opens nothing, in a query neither', async () => {
    for (const text of ['', 'x', key.slice(1), `${key}x`, key.toUpperCase()]) {
      assert.equal((await server.get('/api/v1/simulation', bearer(text))).status, 401, text);
    }
    assert.equal((await server.get(`/api/v1/simulation?api_key=${key}`)).status, 401);
    const answer = await server.post('/api/v1/pushes', { impulse_ns: 1 }, bearer('x'));
    assert.ok(isProblem(answer, 401));
    assert.doesNotMatch(answer.text, new RegExp(key));
  });

  test('the read-only key looks and does not command', async () => {
    assert.equal((await server.get('/api/v1/simulation', bearer(readOnlyKey))).status, 200);
    const refused = await server.post('/api/v1/simulation/pause', {}, bearer(readOnlyKey));
    assert.ok(isProblem(refused, 403));
    assert.equal((await server.get('/api/v1/simulation', bearer(key))).json.running, true);
    assert.equal((await server.post('/api/v1/tickets', {}, bearer(readOnlyKey))).status, 201);
  });

  test('a ticket opens one stream, once', async () => {
    assert.equal(await handshake(server, '/api/v1/stream'), 401);
    assert.equal(await handshake(server, '/api/v1/stream?ticket=nonsense'), 401);
    assert.ok(isProblem(await server.post('/api/v1/tickets', {}), 401));
    const { status, json } = await server.post('/api/v1/tickets', {}, bearer(key));
    assert.equal(status, 201);
    assert.ok(json.expires_in_s > 0);
    const target = `/api/v1/stream?ticket=${json.ticket}`;
    assert.equal((await server.get(`/api/v1/simulation?ticket=${json.ticket}`)).status, 401);
    assert.equal(await handshake(server, target), 101);
    assert.equal(await handshake(server, target), 401);
  });

  test('a client that can send a header needs no ticket', async () => {
    const stream = await server.stream(bearer(readOnlyKey));
    await stream.first((message) => message.op === 'hello');
    await stream.close();
  });
});

describe('keys that cannot be', () => {
  const refused = async (args, variables) => {
    const all = ['serve', '--plant', 'lipm', '--port', '0', ...args];
    const result = await command(all, '', () => {}, variables);
    assert.equal(result.code, 2, result.stderr);
    return result.stderr;
  };

  test('are refused by name, without being told', async () => {
    assert.match(await refused(['--api-key-file', '/nonexistent']), /--api-key-file.*cannot be read/);
    assert.match(await refused(['--api-key-file', folder]), /cannot be read/);
    const short = file('short', 'tiny');
    assert.match(await refused(['--api-key-file', short]), /4 characters; allowed: 16 to 512/);
    const text = await refused([], { STAGGER_API_KEY: 'with blanks in the key' });
    assert.match(text, /^stagger: STAGGER_API_KEY/m);
    assert.doesNotMatch(text, /with blanks/);
    assert.match(await refused([], { STAGGER_READ_ONLY_KEY: readOnlyKey }), /stands alone/);
    const same = { STAGGER_API_KEY: key, STAGGER_READ_ONLY_KEY: key };
    assert.match(await refused([], same), /another one/);
  });

  test('a key is needed where others can reach the server', async () => {
    assert.match(await refused(['--host', '0.0.0.0']), /--api-key-file or STAGGER_API_KEY/);
  });

  test('a key file that others can read is told of', async () => {
    const args = ['serve', '--check-config', '--api-key-file', file('open', key, 0o644)];
    const { code, stderr } = await command(args);
    assert.equal(code, 0);
    assert.match(stderr, /chmod 600/);
  });
});

describe('lists, limits and headers', () => {
  let server;
  const origin = 'https://pages.example';
  before(async () => {
    server = await Server.start('--allow-host', 'robot.example', '--allow-origin', origin,
      '--command-rate', '5');
  });
  after(() => server.end());

  test('hosts on the list are let in', async () => {
    const get = (headers) => server.get('/health', { headers });
    assert.equal((await get({ host: 'robot.example' })).status, 200);
    assert.equal((await get({ host: 'robot.example', origin: 'https://robot.example' })).status, 200);
    assert.equal((await get({ host: 'other.example' })).status, 403);
  });

  test('origins on the list may use the API', async () => {
    const answer = await server.get('/api/v1/simulation', { headers: { origin } });
    assert.equal(answer.status, 200);
    assert.equal(answer.headers['access-control-allow-origin'], origin);
    assert.match(answer.headers.vary, /Origin/);
    const asked = { origin, 'access-control-request-method': 'POST' };
    const preflight = await server.request('OPTIONS', '/api/v1/pushes', { headers: asked });
    assert.equal(preflight.status, 204);
    assert.match(preflight.headers['access-control-allow-headers'], /Authorization/);
    const foreign = { ...asked, origin: 'https://evil.example' };
    assert.equal((await server.request('OPTIONS', '/health', { headers: foreign })).status, 403);
    const own = await server.get('/health', { headers: { origin: server.url } });
    assert.equal(own.headers['access-control-allow-origin'], undefined);
    const stream = await server.stream({ origin });
    await stream.close();
  });

  test('every answer carries the headers that bind a browser', async () => {
    for (const target of ['/', '/health', '/api/v1/simulation', '/api/v1/nothing']) {
      const { headers } = await server.get(target);
      assert.match(headers['content-security-policy'], /default-src 'self'/, target);
      assert.match(headers['content-security-policy'], /frame-ancestors 'none'/, target);
      assert.equal(headers['x-content-type-options'], 'nosniff', target);
      assert.equal(headers['x-frame-options'], 'DENY', target);
      assert.equal(headers['referrer-policy'], 'no-referrer', target);
      assert.doesNotMatch(headers['content-security-policy'], /unsafe/, target);
    }
    const evil = { host: "evil.example; script-src 'unsafe-inline'" };
    const { headers } = await server.get('/', { headers: evil });
    assert.doesNotMatch(headers['content-security-policy'], /unsafe|evil/);
  });

  test('who commands too often is told to wait; who looks is not', async () => {
    // At once, and fewer than may be under way: one after the other a slow machine would not be too often.
    const answers = await Promise.all(Array.from({ length: 30 }, () => server.post('/api/v1/walk', {})));
    const late = answers.filter(({ status }) => status === 429);
    assert.ok(late.length > 0);
    assert.ok(answers.filter(({ status }) => status === 200).length >= 10, 'the burst passes');
    assert.ok(isProblem(late[0], 429));
    assert.ok(Number(late[0].headers['retry-after']) >= 1);
    for (let i = 0; i < 40; ++i) assert.equal((await server.get('/health')).status, 200);
  });
});
