// The stream against the real binary.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import WebSocket from 'ws';
import { Server, eventually, within } from './support.mjs';

let server;
before(async () => (server = await Server.start()));
after(() => server.end());

const withoutGaps = (data) => data.every((message, i) => i === 0 || message.seq === data[i - 1].seq + 1);

test('the server speaks first, and says nothing more before it is asked', async () => {
  const stream = await server.stream();
  const hello = await stream.first((message) => message.op === 'hello');
  const state = await server.state();
  assert.equal(stream.messages[0], hello);
  assert.equal(hello.protocol, 1);
  assert.equal(hello.session_id, state.session_id);
  assert.equal(hello.robot, 'kasaei');
  assert.equal(hello.plant, 'lipm');
  assert.equal(hello.tick_s, 0.001);
  assert.deepEqual(hello.states, ['idle', 'initialize', 'single_support', 'double_support']);
  const heartbeat = await stream.first((message) => message.op === 'heartbeat');
  assert.equal(typeof heartbeat.running, 'boolean');
  assert.equal(heartbeat.dropped, 0);
  assert.deepEqual([...new Set(stream.messages.map((m) => m.op))].sort(), ['heartbeat', 'hello']);
  assert.equal((await stream.close()).code, 1005);
});

test('data comes at the rate that was asked for, in simulation time, without gaps', async () => {
  const stream = await server.stream();
  const answer = await stream.subscribe({ rate_hz: 100, channels: ['com', 'dcm'] });
  assert.deepEqual([answer.rate_hz, answer.channels], [100, ['com', 'dcm']]);
  await eventually(() => stream.all('data').length > 100, 'data');
  const data = stream.all('data');
  assert.ok(withoutGaps(data));
  // The first one shows the present, whichever tick that is.
  for (let i = 2; i < data.length; ++i) assert.equal(data[i].tick - data[i - 1].tick, 10);
  for (const { tick, t, v } of data) {
    assert.ok(Math.abs(t - tick * 0.001) < 1e-9);
    assert.deepEqual(Object.keys(v), ['com', 'dcm']);
    assert.deepEqual([v.com.length, v.dcm.length], [3, 2]);
  }
  await stream.close();
});

test('all channels come when none is named, as long as hello says', async () => {
  const stream = await server.stream();
  const hello = await stream.first((message) => message.op === 'hello');
  await stream.subscribe({ rate_hz: 20 });
  const { v } = await stream.first((message) => message.op === 'data');
  assert.deepEqual(Object.keys(v), hello.channels.map((channel) => channel.name));
  for (const { name, components, max_repeat } of hello.channels) {
    const count = components.length;
    assert.ok(v[name].length <= count * max_repeat, name);
    assert.ok(count === 0 || v[name].length % count === 0, name);
  }
  await stream.close();
});

test('two clients of one rate see the same', async () => {
  const streams = [await server.stream(), await server.stream()];
  for (const stream of streams) await stream.subscribe({ rate_hz: 50 });
  for (const stream of streams) await eventually(() => stream.all('data').length > 50, 'data');
  const [a, b] = streams.map((s) => new Map(s.all('data').slice(1).map((d) => [d.tick, d.v])));
  const common = [...a.keys()].filter((tick) => b.has(tick));
  assert.ok(common.length > 20);
  for (const tick of common) assert.deepEqual(a.get(tick), b.get(tick));
  for (const stream of streams) await stream.close();
});

test('commands, steps and pushes are told as events, with their source', async () => {
  const stream = await server.stream();
  await stream.subscribe({ rate_hz: 1000, channels: ['com'] });
  const headers = { 'x-stagger-client': 'a test' };
  const { json: push } = await server.post('/api/v1/pushes', { impulse_ns: 3 }, { headers });
  const command = await stream.first((m) => m.kind === 'command' && /^push/.test(m.text));
  assert.equal(command.source, 'a test');
  assert.equal(command.tick, push.tick);
  const started = await stream.first((m) => m.kind === 'push_started');
  assert.equal(started.tick, push.tick);
  const done = await stream.first((m) => m.kind === 'push_done');
  assert.ok(Math.abs(done.values.delivered_ns - 3) < 1e-9);
  await stream.first((m) => m.kind === 'step');
  await server.post('/api/v1/stop');
  assert.equal((await stream.first((m) => m.text === 'stop')).source, 'http');
  await server.post('/api/v1/walk');
  const late = await server.post('/api/v1/pushes', { impulse_ns: 3, at_s: 1e6 });
  await server.request('DELETE', `/api/v1/pushes/${late.json.id}`);
  await stream.first((m) => m.kind === 'push_cancelled');
  await stream.close();
  // Those of a tick come before its data.
  const told = stream.messages.filter(({ op }) => op === 'event' || op === 'data');
  const order = told.map(({ op, tick }) => 2 * tick + (op === 'data' ? 1 : 0));
  assert.deepEqual(order, [...order].sort((a, b) => a - b));
});

test('channels come at rates and with fields of their own', async () => {
  const stream = await server.stream();
  const channels = [
    { name: 'com', rate_hz: 100, fields: ['z', 'x'] },
    { name: 'dcm', rate_hz: 20 },
    { name: 'zmp', rate_hz: 100, fields: ['y'] },
  ];
  const answer = await stream.subscribe({ channels });
  assert.deepEqual(answer.rates_hz, [100, 20]);
  assert.deepEqual(answer.layout.map(({ name, rate }) => [name, rate]),
    [['com', 0], ['dcm', 1], ['zmp', 0]]);
  assert.deepEqual(answer.layout[0].fields, ['x', 'z']);
  await eventually(() => stream.all('data').length > 50, 'data');
  const data = stream.all('data').slice(1);
  assert.ok(withoutGaps(data));
  for (const { tick, v } of data) {
    assert.equal(tick % 10, 0);
    assert.deepEqual(Object.keys(v), tick % 50 === 0 ? ['com', 'dcm', 'zmp'] : ['com', 'zmp']);
    assert.deepEqual([v.com.length, v.zmp.length], [2, 1]);
  }
  await stream.close();
});

test('binary messages hold what the text holds, to the bit or to single precision', async () => {
  const formats = ['json', 'float64', 'float32'];
  const streams = await Promise.all(formats.map(() => server.stream()));
  const channels = [
    { name: 'com', rate_hz: 50 },
    { name: 'left_foot', rate_hz: 10, fields: ['yaw', 'x'] },
    { name: 'preview', rate_hz: 50, fields: ['x', 'side'] },
    { name: 'support_polygon', rate_hz: 50 },
    { name: 'joint_position', rate_hz: 50 },
  ];
  for (const [i, stream] of streams.entries()) {
    assert.equal((await stream.subscribe({ format: formats[i], channels })).format, formats[i]);
  }
  for (const stream of streams) await eventually(() => stream.all('data').length > 60, 'data');
  const [text, double, single] = streams.map(
    (stream) => new Map(stream.all('data').slice(1).map((message) => [message.tick, message])),
  );
  const common = [...text.keys()].filter((tick) => double.has(tick) && single.has(tick));
  assert.ok(common.length > 20);
  for (const tick of common) {
    assert.equal(double.get(tick).t, text.get(tick).t);
    assert.deepEqual(double.get(tick).v, text.get(tick).v);
    const rounded = Object.entries(text.get(tick).v).map(([name, values]) => [
      name,
      values.map((value) => (value === null ? null : Math.fround(value))),
    ]);
    assert.deepEqual(single.get(tick).v, Object.fromEntries(rounded));
  }
  for (const stream of streams) {
    assert.ok(withoutGaps(stream.all('data')));
    await stream.close();
  }
});

test('events can be left out', async () => {
  const stream = await server.stream();
  await stream.subscribe({ rate_hz: 10, channels: [], events: false });
  await server.post('/api/v1/walk');
  await server.post('/api/v1/walk');
  await eventually(() => stream.all('data').length > 5, 'data');
  assert.equal(stream.all('event').length, 0);
  await stream.close();
});

test('a pause and a step each show the frame that they end with', async () => {
  const stream = await server.stream();
  await stream.subscribe({ rate_hz: 1, channels: ['com'] });
  const { json: pause } = await server.pause();
  await stream.first((m) => m.op === 'data' && m.tick === pause.tick - 1, 'the frame at the pause');
  const { json: step } = await server.step(7);
  await stream.first((m) => m.op === 'data' && m.tick === step.tick - 1, 'the frame after the step');
  const beat = await stream.first((m) => m.op === 'heartbeat' && !m.running, 'a paused heartbeat');
  assert.ok(beat.tick >= pause.tick - 1);
  // Who comes now sees the same.
  const late = await server.stream();
  await late.subscribe({ rate_hz: 1, channels: ['com'] });
  const shown = await late.first((m) => m.op === 'data');
  assert.equal(shown.tick, step.tick - 1);
  assert.ok(withoutGaps(stream.all('data')));
  for (const each of [stream, late]) await each.close();
  await server.post('/api/v1/simulation/resume');
});

test('a reset says hello again, with the new session', async () => {
  const stream = await server.stream();
  await stream.subscribe({ rate_hz: 50 });
  await stream.first((m) => m.op === 'data');
  const { json } = await server.post('/api/v1/simulation/reset', { seed: 2 });
  const again = await stream.first((m) => m.op === 'hello' && m.session_id === json.session_id);
  const behind = () => stream.messages.slice(stream.messages.indexOf(again));
  await eventually(() => behind().filter((m) => m.op === 'data').length > 10, 'data');
  const data = behind().filter((m) => m.op === 'data');
  assert.equal(data[0].tick, 0);
  assert.ok(data.every((m, i) => i === 0 || m.tick >= data[i - 1].tick));
  assert.ok(withoutGaps(stream.all('data')), 'seq goes on');
  await stream.close();
  await server.post('/api/v1/walk');
});

test('a new subscription replaces the old one', async () => {
  const stream = await server.stream();
  await stream.subscribe({ rate_hz: 100, channels: ['com'] });
  await eventually(() => stream.all('data').length > 5, 'data');
  await stream.subscribe({ rate_hz: 50, channels: ['dcm'] });
  await stream.first((m) => m.op === 'data' && m.v.dcm);
  const answered = stream.messages.findLastIndex((m) => m.op === 'subscribed');
  const behind = stream.messages.slice(answered).filter((m) => m.op === 'data');
  assert.ok(behind.every((m) => !m.v.com));
  assert.ok(withoutGaps(stream.all('data')));
  await stream.close();
});

test('what is not understood is answered, and the connection stays', async () => {
  const stream = await server.stream();
  const wrong = ['nonsense', '[]', '{"op":"fly"}', '{"op":"subscribe","rate_hz":0}',
    '{"op":"subscribe","channels":["nope"]}', '{"op":"subscribe","speed":1}', ' '.repeat(66_000),
    '{"op":"subscribe","channels":[{"name":"com","fields":["w"]}]}'];
  for (const [i, text] of wrong.entries()) {
    stream.send(text);
    await eventually(() => stream.all('error').length === i + 1, text.slice(0, 40));
  }
  assert.match(stream.all('error')[4].detail, /nope/);
  assert.match(stream.all('error')[5].detail, /speed/);
  assert.match(stream.all('error')[6].detail, /64 KiB/);
  assert.equal((await stream.subscribe({ rate_hz: 10 })).rate_hz, 10);
  await stream.close();
});

test('who is not understood repeatedly is sent away with 1008', async () => {
  const stream = await server.stream();
  for (let i = 0; i < 20; ++i) stream.send('nonsense');
  assert.equal((await within(stream.closed, 'the close')).code, 1008);
});

test('a message of many megabytes ends the connection, not the server', async () => {
  const stream = await server.stream();
  stream.socket.on('error', () => {});
  stream.send('x'.repeat(8 << 20));
  await within(stream.closed, 'the close');
  assert.equal((await server.get('/health')).status, 200);
});

test('pings are answered', async () => {
  const stream = await server.stream();
  const pong = new Promise((resolve) => stream.socket.on('pong', (data) => resolve(String(data))));
  stream.socket.ping('are you there');
  assert.equal(await within(pong, 'pong'), 'are you there');
  await stream.close();
});

const refusedWith = (options) =>
  within(
    new Promise((resolve, reject) => {
      const socket = new WebSocket(`ws://127.0.0.1:${server.port}/api/v1/stream`, options);
      socket.on('unexpected-response', (_, response) => resolve(response.statusCode));
      socket.on('open', () => reject(new Error('it opened')));
      socket.on('error', () => {});
    }),
    'the refusal',
  );

test('foreign pages cannot open a stream', async () => {
  assert.equal(await refusedWith({ origin: 'http://evil.com' }), 403);
  assert.equal(await refusedWith({ headers: { host: 'evil.com' } }), 403);
  const own = await server.stream({ origin: server.url });
  await own.close();
});

test('clients are counted, and one too many is refused', async () => {
  await eventually(async () => (await server.state()).stream.clients === 0, 'all have left');
  const streams = [];
  for (let i = 0; i < 64; ++i) streams.push(await server.stream());
  for (const stream of streams) await stream.first((m) => m.op === 'hello');
  assert.equal((await server.state()).stream.clients, 64);
  assert.equal(await refusedWith({}), 503);
  assert.equal((await server.get('/health')).status, 200, 'requests still have their threads');
  await Promise.all(streams.map((stream) => stream.close()));
  await eventually(async () => (await server.state()).stream.clients === 0, 'all have left');
  const next = await server.stream();
  await next.close();
});

test('clients that come and go leave nothing behind', async () => {
  for (let i = 0; i < 30; ++i) {
    const stream = await server.stream();
    if (i % 3 === 0) await stream.subscribe({ rate_hz: 1000 });
    i % 2 ? stream.socket.terminate() : await stream.close();
  }
  await eventually(async () => (await server.state()).stream.clients === 0, 'all have left');
  assert.equal((await server.state()).stream.dropped_clients, 0);
});
