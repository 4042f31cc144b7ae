// /metrics: what happens is counted, in the text format of Prometheus.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Server, eventually } from './support.mjs';

let server;
before(async () => (server = await Server.start()));
after(() => server.end());

/** Name with labels -> value; every line must be one of the format. */
async function read() {
  const { status, headers, text } = await server.get('/metrics');
  assert.equal(status, 200);
  assert.match(headers['content-type'], /^text\/plain; version=0\.0\.4/);
  const values = {};
  const typed = new Set();
  for (const line of text.trimEnd().split('\n')) {
    const type = /^# TYPE (\w+) (counter|gauge|histogram)$/.exec(line);
    if (type) typed.add(type[1]);
    if (line.startsWith('#')) continue;
    const found = /^([a-z_]+)(\{.*\})? (\S+)$/.exec(line);
    assert.ok(found, line);
    assert.ok(typed.has(found[1]) || typed.has(found[1].replace(/_(bucket|sum|count)$/, '')), line);
    values[found[1] + (found[2] ?? '')] = Number(found[3]);
  }
  return values;
}

const requests = (values, method, route, status) =>
  values[`stagger_http_requests_total{method="${method}",route="${route}",status="${status}"}`] ?? 0;

test('ticks, clients, pushes, falls and sessions are counted', async () => {
  await server.pause();
  const before = await read();
  await server.post('/api/v1/simulation/reset', {});
  await server.post('/api/v1/walk', {});
  await server.step(2000);
  await server.post('/api/v1/pushes', { impulse_ns: 150, direction_deg: 90 });
  await server.step(3000);
  const stream = await server.stream();
  await stream.first(({ op }) => op === 'hello'); // the handshake alone counts nobody yet
  const after_ = await read();
  const grown = (name) => after_[name] - before[name];
  assert.equal(grown('stagger_ticks_total'), 5000);
  assert.equal(grown('stagger_pushes_total'), 1);
  assert.equal(grown('stagger_falls_total'), 1);
  assert.equal(grown('stagger_sessions_total'), 1);
  assert.ok(grown('stagger_steps_total') > 0);
  assert.deepEqual([after_.stagger_running, after_.stagger_fallen, after_.stagger_broken], [0, 1, 0]);
  assert.equal(after_.stagger_stream_clients, 1);
  assert.equal(after_.stagger_queue_depth, 0);
  assert.equal(after_.stagger_queue_capacity, 256);
  assert.ok(after_.process_resident_memory_bytes > 1e6);
  assert.ok(after_.process_cpu_seconds_total > 0);
  for (const name of ['stagger_late_ticks_total', 'stagger_real_time_factor', 'stagger_worst_lateness_seconds',
    'stagger_stream_dropped_clients_total', 'stagger_stream_dropped_messages_total']) {
    assert.ok(Number.isFinite(after_[name]), name);
  }
  await stream.close();
  await eventually(async () => (await read()).stagger_stream_clients === 0, 'no client');
});

test('requests are counted by route and status, and no client makes a series of its own', async () => {
  const before = await read();
  await server.get('/api/v1/pushes/1');
  await server.get('/api/v1/pushes/999');
  await server.get('/api/v1/pushes/998');
  await server.get('/api/v1/no_such_thing_1');
  await server.get('/api/v1/no_such_thing_2');
  await server.get('/health', { headers: { host: 'elsewhere.example' } });
  await server.post('/api/v1/walk', '{');
  const after_ = await read();
  const grown = (...key) => requests(after_, ...key) - requests(before, ...key);
  assert.equal(grown('GET', '/api/v1/pushes/{id}', 200), 1);
  assert.equal(grown('GET', '/api/v1/pushes/{id}', 404), 2);
  assert.equal(grown('GET', 'other', 404), 2);
  assert.equal(grown('GET', 'other', 403), 1);
  assert.equal(grown('POST', '/api/v1/walk', 400), 1);
  const count = 'stagger_http_request_duration_seconds_count{method="GET",route="/api/v1/pushes/{id}"}';
  assert.equal(after_[count] - (before[count] ?? 0), 3);
  assert.ok(!Object.keys(after_).some((name) => name.includes('no_such_thing')));
});
