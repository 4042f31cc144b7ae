// The HTTP API against the real binary: every route, and each kind of error.
import assert from 'node:assert/strict';
import net from 'node:net';
import { after, before, test } from 'node:test';
import { Server, eventually, isProblem, within } from './support.mjs';

let server;
before(async () => (server = await Server.start()));
after(() => server.end());

const pointers = (answer) => answer.json.errors.map((error) => error.pointer).sort();
const refused = (answer, status) => assert.ok(isProblem(answer, status), JSON.stringify(answer));

test('health and readiness', async () => {
  assert.equal((await server.get('/health')).json.status, 'ok');
  await eventually(async () => (await server.get('/ready')).status === 200, 'ready');
});

test('the state tells all that is documented', async () => {
  const state = await server.state();
  const fields = `session_id robot plant seed state control_delay_ms tick time_s running walking_state walking fallen
    fall_reason strategies step_count worst_dcm_error_m real_time_factor late_ticks
    worst_lateness_ms stream state_hash version`;
  for (const field of fields.split(/\s+/)) assert.ok(field in state, field);
  assert.match(state.session_id, /^[0-9a-f]{16}$/);
  assert.match(state.state_hash, /^[0-9a-f]{16}$/);
  assert.equal(state.robot, 'kasaei');
  assert.equal(state.plant, 'lipm');
});

test('the simulation walks from the start', async () => {
  await eventually(async () => (await server.state()).step_count > 0, 'a step');
});

test('pause, step and resume answer with the tick that then shows', async () => {
  const pause = await server.pause();
  assert.equal(pause.status, 200);
  assert.equal((await server.state()).tick, pause.json.tick);
  const step = await server.step(250);
  assert.equal(step.json.tick, pause.json.tick + 250);
  assert.ok(Math.abs(step.json.time_s - step.json.tick * 0.001) < 1e-9);
  const state = await server.state();
  assert.equal(state.tick, step.json.tick);
  assert.equal(state.running, false);
  assert.equal((await server.post('/api/v1/simulation/step')).json.tick, step.json.tick + 1);
  const resume = await server.post('/api/v1/simulation/resume', {});
  assert.equal(resume.json.tick, step.json.tick + 1);
  await eventually(async () => (await server.state()).tick > resume.json.tick, 'ticks');
});

test('a step takes a pause', async () => {
  refused(await server.step(1), 409);
});

test('walk, stop and strategies', async () => {
  const walk = await server.post('/api/v1/walk', { vx: 0.1 });
  assert.equal(walk.status, 200);
  assert.ok(Number.isInteger(walk.json.tick));
  assert.deepEqual((await server.state()).walk, { vx: 0.1, vy: 0, wz: 0 });
  assert.equal((await server.post('/api/v1/stop')).status, 200);
  assert.equal((await server.post('/api/v1/walk')).status, 200);
  const patch = await server.request('PATCH', '/api/v1/strategies', { body: { step: false } });
  assert.deepEqual([patch.json.ankle, patch.json.step], [true, false]);
  assert.ok(Number.isInteger(patch.json.tick));
  assert.deepEqual((await server.get('/api/v1/strategies')).json, { ankle: true, hip: true, step: false, time: true });
  assert.deepEqual((await server.state()).strategies, { ankle: true, hip: true, step: false, time: true });
  await server.request('PATCH', '/api/v1/strategies', { body: { step: true } });
});

test('a push is a resource that ends as done, with the impulse that was asked for', async () => {
  const created = await server.post('/api/v1/pushes', { impulse_ns: 4, direction_deg: 90 });
  assert.equal(created.status, 201);
  assert.equal(created.headers.location, `/api/v1/pushes/${created.json.id}`);
  assert.equal(created.json.state, 'scheduled');
  assert.deepEqual(created.json.spec.direction, [0, 1, 0]);
  const done = await eventually(async () => {
    const { json } = await server.get(created.headers.location);
    return json.state === 'done' && json;
  }, 'done');
  assert.equal(done.start_tick, created.json.tick);
  assert.equal(done.end_tick - done.start_tick, 99);
  assert.ok(Math.abs(Math.hypot(...done.delivered_ns) - 4) < 1e-9);
  refused(await server.request('DELETE', created.headers.location), 409);
});

test('a push can be cancelled', async () => {
  const { json } = await server.post('/api/v1/pushes', { impulse_ns: 4, at_s: 1e6 });
  const cancelled = await server.request('DELETE', `/api/v1/pushes/${json.id}`);
  assert.equal(cancelled.status, 200);
  assert.equal(cancelled.json.state, 'cancelled');
  assert.deepEqual(cancelled.json.delivered_ns, [0, 0, 0]);
  assert.equal((await server.get(`/api/v1/pushes/${json.id}`)).json.state, 'cancelled');
});

test('pushes are listed newest first, in pages', async () => {
  for (let i = 0; i < 3; ++i) await server.post('/api/v1/pushes', { impulse_ns: 1, at_s: 1e6 });
  const ids = [];
  for (let cursor = ''; cursor !== null; ) {
    const { json } = await server.get(`/api/v1/pushes?limit=2${cursor && `&cursor=${cursor}`}`);
    assert.ok(json.items.length <= 2);
    ids.push(...json.items.map((push) => push.id));
    cursor = json.next_cursor;
  }
  assert.ok(ids.length >= 3);
  assert.deepEqual(ids, [...new Set(ids)].sort((a, b) => b - a));
  const all = (await server.get('/api/v1/pushes')).json;
  assert.deepEqual(all.items.map((push) => push.id), ids);
  assert.equal(all.next_cursor, null);
  refused(await server.get('/api/v1/pushes?limit=0'), 422);
  refused(await server.get('/api/v1/pushes?limit=1001'), 422);
  refused(await server.get('/api/v1/pushes?cursor=x'), 422);
  assert.deepEqual(pointers(await server.get('/api/v1/pushes?page=1')), ['/page']);
});

test('a resolved push can be sent again as it is', async () => {
  const asked = { force_n: 33, profile: 'half_sine', direction: [1, 2, 0], at_s: 1e6 };
  const first = await server.post('/api/v1/pushes', asked);
  const second = await server.post('/api/v1/pushes', first.json.spec);
  assert.equal(second.status, 201);
  assert.deepEqual(second.json.spec, first.json.spec);
});

test('wrong pushes are refused field by field', async () => {
  const wrong = { impulse_ns: -3, direction_deg: 'left', duration_s: 9, colour: 'red', link: 'tail' };
  const answer = await server.post('/api/v1/pushes', wrong);
  refused(answer, 422);
  assert.deepEqual(pointers(answer), [
    '/colour', '/direction_deg', '/duration_s', '/impulse_ns', '/link',
  ]);
  const impulse = answer.json.errors.find((error) => error.pointer === '/impulse_ns');
  assert.equal(impulse.detail, 'is -3; allowed: more than 0 to 200 N s');
  const unknown = answer.json.errors.find((error) => error.pointer === '/colour');
  assert.match(unknown.detail, /direction_deg/, 'the known fields are named');
  refused(await server.post('/api/v1/pushes', {}), 422);
  for (const text of ['1e999', 'NaN', 'Infinity', '-1e999']) {
    const answer = await server.post('/api/v1/pushes', `{"impulse_ns":${text}}`);
    assert.ok([400, 422].includes(answer.status), text);
  }
});

test('every command refuses fields that it does not know', async () => {
  const commands = ['pause', 'resume', 'step', 'reset'].map((name) => `/api/v1/simulation/${name}`);
  for (const target of [...commands, '/api/v1/walk', '/api/v1/stop', '/api/v1/pushes']) {
    const answer = await server.post(target, { impulse_ns: 1, what: 1 });
    refused(answer, 422);
    assert.ok(pointers(answer).includes('/what'), target);
  }
  const patch = await server.request('PATCH', '/api/v1/strategies', { body: { knee: true } });
  refused(patch, 422);
  assert.deepEqual(pointers(patch), ['/knee']);
});

test('values out of range are refused', async () => {
  for (const [target, body, pointer] of [
    ['/api/v1/walk', { vx: 0.51 }, '/vx'],
    ['/api/v1/walk', { vy: -0.31 }, '/vy'],
    ['/api/v1/walk', { wz: '0' }, '/wz'],
    ['/api/v1/simulation/step', { ticks: 0 }, '/ticks'],
    ['/api/v1/simulation/step', { ticks: 10001 }, '/ticks'],
    ['/api/v1/simulation/step', { ticks: 1.5 }, '/ticks'],
    ['/api/v1/simulation/reset', { plant: 'mujoco' }, '/plant'],
    ['/api/v1/simulation/reset', { robot: 'nobody' }, '/robot'],
    ['/api/v1/simulation/reset', { seed: -1 }, '/seed'],
    ['/api/v1/simulation/reset', { state: 'exact' }, '/state'],
    ['/api/v1/simulation/reset', { control_delay_ms: 11 }, '/control_delay_ms'],
    ['/api/v1/simulation/reset', { terrain: { kind: 'flat', friction: 2 } }, '/terrain/friction'],
  ]) {
    const answer = await server.post(target, body);
    refused(answer, 422);
    assert.deepEqual(pointers(answer), [pointer], target);
  }
  refused(await server.post('/api/v1/walk', []), 422);
});

test('a body that is not JSON', async () => {
  refused(await server.post('/api/v1/walk', '{"vx":'), 400);
  refused(await server.post('/api/v1/pushes', ''), 400);
  refused(await server.post('/api/v1/pushes'), 400);
  refused(await server.post('/api/v1/walk', '{"vx":0.1,"vx":0.2}'), 400);
  refused(await server.post('/api/v1/walk', '['.repeat(100_000)), 400);
  for (const type of ['text/plain', 'application/x-www-form-urlencoded', 'multipart/form-data']) {
    const answer = await server.post('/api/v1/walk', '{}', { headers: { 'content-type': type } });
    // The library takes multipart bodies apart before we see them.
    refused(answer, type === 'multipart/form-data' ? 400 : 415);
  }
  const type = { 'content-type': 'application/json; charset=utf-8' };
  assert.equal((await server.post('/api/v1/walk', '{}', { headers: type })).status, 200);
});

test('unknown paths and wrong methods', async () => {
  refused(await server.get('/api/v1/nothing'), 404);
  refused(await server.post('/api/v1/nothing', {}), 404);
  refused(await server.get('/nothing.js'), 404);
  refused(await server.get('/api/v1/pushes/999999'), 404);
  refused(await server.get('/api/v1/pushes/x'), 404);
  refused(await server.request('DELETE', '/api/v1/pushes/999999'), 404);
  refused(await server.get('/api/v1/robots/nobody'), 404);
  const wrong = await server.get('/api/v1/walk');
  refused(wrong, 405);
  assert.equal(wrong.headers.allow, 'POST');
  const put = await server.request('PUT', '/api/v1/pushes', { body: {} });
  refused(put, 405);
  assert.equal(put.headers.allow, 'GET, HEAD, POST');
  refused(await server.request('OPTIONS', '/api/v1/walk'), 405);
  refused(await server.get('/api/v1/stream'), 426);
});

test('bodies over 1 MiB are refused', async () => {
  const megabytes = (n) => `{"vx":0${' '.repeat(n * 1024 * 1024)}}`;
  refused(await server.post('/api/v1/walk', megabytes(1)), 413);
  refused(await server.post('/api/v1/walk', megabytes(4)), 413);
  const expecting = { headers: { expect: '100-continue' } };
  assert.equal((await server.post('/api/v1/walk', megabytes(2), expecting)).status, 413);
});

test('foreign Hosts and Origins are refused', async () => {
  for (const host of ['evil.com', `evil.com:${server.port}`, '127.0.0.1', '127.0.0.1:1']) {
    refused(await server.get('/api/v1/simulation', { headers: { host } }), 403);
    refused(await server.get('/', { headers: { host } }), 403);
  }
  for (const origin of ['http://evil.com', 'null', `https://127.0.0.1:${server.port}`]) {
    refused(await server.post('/api/v1/stop', undefined, { headers: { origin } }), 403);
  }
  const own = { headers: { origin: server.url } };
  assert.equal((await server.post('/api/v1/stop', undefined, own)).status, 200);
  const local = { headers: { host: `localhost:${server.port}` } };
  assert.equal((await server.get('/health', local)).status, 200);
});

test('every answer carries the security headers', async () => {
  for (const target of ['/', '/health', '/api/v1/nothing']) {
    const { headers } = await server.get(target);
    assert.match(headers['content-security-policy'], /default-src 'self'/);
    assert.match(headers['content-security-policy'], /frame-ancestors 'none'/);
    assert.equal(headers['x-content-type-options'], 'nosniff');
    assert.equal(headers['referrer-policy'], 'no-referrer');
    assert.equal(headers['access-control-allow-origin'], undefined);
  }
});

test('robots and their files', async () => {
  const { json } = await server.get('/api/v1/robots');
  const robot = json.items.find((item) => item.name === 'kasaei');
  assert.ok(Math.abs(robot.mass_kg - 30) < 0.01);
  assert.equal(robot.joints.length, 12);
  assert.ok(robot.links.includes('torso'));
  assert.deepEqual((await server.get('/api/v1/robots/kasaei')).json, robot);
  const urdf = await server.get('/api/v1/robots/kasaei/files/robot.urdf');
  assert.equal(urdf.status, 200);
  assert.match(urdf.text, /<robot/);
  for (const path of ['../../../CMakeLists.txt', '..%2f..%2fCMakeLists.txt', 'robot.json', 'x.urdf',
    '%2fetc%2fpasswd', '']) {
    assert.equal((await server.get(`/api/v1/robots/kasaei/files/${path}`)).status, 404, path);
  }
});

test('a page is served', async () => {
  const page = await server.get('/');
  assert.equal(page.status, 200);
  assert.match(page.headers['content-type'], /^text\/html/);
  assert.equal(page.headers['cache-control'], 'no-cache');
  assert.equal((await server.get('/../../etc/passwd')).status, 404);
});

test('a reset chooses what control knows, and it stays so', async () => {
  await server.pause();
  const senses = async () => {
    const { state, control_delay_ms: delay } = await server.state();
    return [state, delay];
  };
  assert.deepEqual(await senses(), [null, null]); // the pendulum
  await server.post('/api/v1/simulation/reset',
    { plant: 'bullet', state: 'perfect', control_delay_ms: 4 });
  assert.deepEqual(await senses(), ['perfect', 4]);
  await server.post('/api/v1/simulation/reset', {});
  assert.deepEqual(await senses(), ['perfect', 4]);
  await server.post('/api/v1/simulation/reset', { state: 'estimated', control_delay_ms: 1 });
  assert.deepEqual(await senses(), ['estimated', 1]);
  await server.post('/api/v1/simulation/reset', { plant: 'lipm' });
});

test('a reset is a new session in which the robot stands', async () => {
  const old = await server.state();
  await server.pause();
  const reset = await server.post('/api/v1/simulation/reset', { seed: 7 });
  assert.equal(reset.status, 200);
  assert.equal(reset.json.tick, 0);
  const state = await server.state();
  assert.notEqual(state.session_id, old.session_id);
  assert.equal(state.session_id, reset.json.session_id);
  assert.deepEqual([state.seed, state.plant, state.tick, state.running], [7, 'lipm', 0, false]);
  await server.step(2000);
  assert.equal((await server.state()).walking_state, 'idle');
  assert.deepEqual((await server.get('/api/v1/pushes')).json.items, []);
});

test('the same commands at the same ticks give the same world to the bit', async () => {
  const hashes = [];
  for (let run = 0; run < 2; ++run) {
    await server.pause();
    await server.post('/api/v1/simulation/reset', { seed: 3 });
    await server.post('/api/v1/walk', { vx: 0.1 });
    await server.step(3000);
    await server.post('/api/v1/pushes', { impulse_ns: 6, direction_deg: 60 });
    await server.step(3000);
    hashes.push((await server.state()).state_hash);
  }
  assert.equal(hashes[0], hashes[1]);
});

test('commands are answered while a long step is under way', async () => {
  await server.pause();
  const { tick } = await server.state();
  const step = server.step(10000);
  const walk = await server.post('/api/v1/walk', {});
  assert.equal(walk.status, 200);
  assert.equal((await step).json.tick, tick + 10000);
});

test('garbage on the socket harms nobody', async () => {
  for (const garbage of ['\r\n\r\n', 'GET\r\n\r\n', 'FOO / HTTP/1.1\r\n\r\n', '\0'.repeat(4096),
    'GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n', `GET /${'x'.repeat(20000)} HTTP/1.1\r\n\r\n`]) {
    const socket = net.connect(server.port, '127.0.0.1');
    const closed = new Promise((resolve) => socket.on('close', resolve));
    socket.on('error', () => {});
    socket.resume();
    socket.end(garbage);
    await within(closed, 'the close');
  }
  assert.equal((await server.get('/health')).status, 200);
});

test('many requests at once are all answered', async () => {
  // 32 commands may be under way at once; questions have places of their own.
  const answers = await Promise.all(
    Array.from({ length: 100 }, (_, i) =>
      i % 4 ? server.get('/api/v1/simulation') : server.post('/api/v1/walk', {}),
    ),
  );
  for (const answer of answers) assert.equal(answer.status, 200);
});

test('commands beyond those that may be under way are told to come again', async () => {
  const commands = await Promise.all(Array.from({ length: 200 }, () => server.post('/api/v1/walk', {})));
  const taken = commands.filter(({ status }) => status === 200);
  assert.ok(taken.length >= 32, `${taken.length} taken`);
  for (const command of commands.filter((answer) => !taken.includes(answer))) {
    refused(command, 503);
    assert.equal(command.headers['retry-after'], '1');
  }
  assert.equal((await server.post('/api/v1/walk', {})).status, 200);
});
