// Parameters, presets, events, speed, step lists and idempotent pushes against the real binary.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { Server, command, eventually, isProblem } from './support.mjs';

let server;
const data = mkdtempSync(path.join(os.tmpdir(), 'stagger-data-'));
before(async () => (server = await Server.start('--data', data)));
after(async () => {
  await server.end();
  rmSync(data, { recursive: true });
});

const patch = (body) => server.request('PATCH', '/api/v1/parameters', { body });
const put = (name, body) => server.request('PUT', `/api/v1/presets/${name}`, { body });
const pointers = (answer) => answer.json.errors.map((error) => error.pointer).sort();
const refused = (answer, status) => assert.ok(isProblem(answer, status), JSON.stringify(answer.json ?? answer.text));
const row = async (name) =>
  (await server.get('/api/v1/parameters')).json.items.find((item) => item.name === name);
const restart = (body = {}) => server.post('/api/v1/simulation/reset', { parameters: {}, ...body });

test('every parameter tells its unit, default, range and meaning', async () => {
  const { items } = (await server.get('/api/v1/parameters')).json;
  assert.ok(items.length > 30);
  for (const item of items) {
    assert.ok(item.meaning.length > 5 && typeof item.unit === 'string', item.name);
    assert.ok(['next_step', 'reset'].includes(item.takes_effect), item.name);
    if (item.type === 'boolean') continue;
    assert.ok(item.least <= item.default && item.default <= item.most, item.name);
  }
  assert.ok(!items.some((item) => item.name.startsWith('body.')), 'the pendulum has no body');
});

test('a change waits for its step, then acts, and the events say so', async () => {
  await restart();
  await server.post('/api/v1/walk');
  await eventually(async () => (await server.state()).step_count > 1, 'steps');
  await server.pause();
  const answer = await patch({ 'gait.t_ss': 0.5, 'lipm.noise': 0.0001 });
  assert.equal(answer.status, 200);
  assert.deepEqual(answer.json.parameters, { 'gait.t_ss': 0.5, 'lipm.noise': 0.0001 });
  assert.deepEqual(answer.json.waits_for, { next_step: ['gait.t_ss'], reset: ['lipm.noise'] });
  assert.equal((await row('gait.t_ss')).waits_for, 'next_step');
  await server.step(3000);
  const now = await row('gait.t_ss');
  assert.deepEqual([now.value, now.active, now.waits_for], [0.5, 0.5, null]);
  const noise = await row('lipm.noise');
  assert.deepEqual([noise.value, noise.active, noise.waits_for], [0.0001, 0, 'reset']);
  const { items } = (await server.get('/api/v1/events?kind=parameters')).json;
  assert.equal(items[0].values['gait.t_ss'], 0.5);
  assert.ok(items[0].tick > answer.json.tick);
  assert.deepEqual((await server.state()).parameters, { 'gait.t_ss': 0.5, 'lipm.noise': 0.0001 });
  // The next world has both, and null takes a value back.
  await server.post('/api/v1/simulation/reset');
  assert.equal((await row('lipm.noise')).active, 0.0001);
  assert.deepEqual((await patch({ 'lipm.noise': null, 'gait.t_ss': null })).json.parameters, {});
  await server.post('/api/v1/simulation/reset');
  assert.equal((await row('lipm.noise')).active, 0);
  await server.post('/api/v1/simulation/resume');
});

test('parameters are changed all or not at all', async () => {
  await restart();
  const wrong = await patch({
    'gait.t_ss': 0.5, 'gait.t_ds': 99, 'no.such': 1, 'hip.in_steps': 1, 'body.com_weight': 1000 });
  refused(wrong, 422);
  assert.deepEqual(pointers(wrong), ['/hip.in_steps', '/no.such']);
  const range = await patch({ 'gait.t_ss': 0.5, 'gait.t_ds': 99, 'body.com_weight': 1000 });
  refused(range, 422);
  assert.deepEqual(pointers(range), ['/body.com_weight', '/gait.t_ds']);
  assert.match(range.json.errors.find((error) => error.pointer === '/gait.t_ds').detail, /is 99; allowed: 0 to 2 s/);
  const together = await patch({ 'adjust.freeze': 0.9 });
  assert.deepEqual(pointers(together), ['/adjust.freeze']);
  refused(await patch([1]), 422);
  refused(await patch('{"gait.t_ss":'), 400);
  refused(await server.request('PATCH', '/api/v1/parameters', { body: '{}', headers: { 'content-type': 'text/plain' } }), 415);
  refused(await server.post('/api/v1/parameters', {}), 405);
  assert.deepEqual((await server.state()).parameters, {});
});

test('a reset takes parameters, keeps them, and leaves them with the robot', async () => {
  assert.equal((await restart({ parameters: { 'gait.t_ss': 0.6, 'lipm.delay': 0.003 } })).status, 200);
  assert.equal((await row('lipm.delay')).active, 0.003);
  await server.post('/api/v1/simulation/reset');
  assert.equal((await row('gait.t_ss')).active, 0.6);
  const wrong = await restart({ parameters: { 'gait.t_ss': 60 } });
  refused(wrong, 422);
  assert.deepEqual(pointers(wrong), ['/parameters/gait.t_ss']);
  await server.post('/api/v1/simulation/reset', { robot: 'op3' });
  assert.deepEqual((await server.state()).parameters, {});
  await restart({ robot: 'kasaei' });
});

test('presets are kept, listed, applied and deleted', async () => {
  const slow = { note: 'slow', parameters: { 'gait.t_ss': 0.6 }, strategies: { time: false } };
  const made = await put('slow-1', slow);
  assert.equal(made.status, 201);
  assert.deepEqual(made.json, { name: 'slow-1', ...slow });
  assert.equal((await put('slow-1', slow)).status, 200);
  await put('wild', { parameters: { 'gait.t_ss': 50 } });
  assert.deepEqual((await server.get('/api/v1/presets')).json.items.map((item) => item.name), ['slow-1', 'wild']);
  assert.deepEqual((await server.get('/api/v1/presets/slow-1')).json, { name: 'slow-1', ...slow });

  await restart();
  const applied = await server.post('/api/v1/presets/slow-1/apply');
  assert.equal(applied.status, 200);
  const state = await server.state();
  assert.deepEqual(state.parameters, { 'gait.t_ss': 0.6 });
  assert.equal(state.strategies.time, false);
  const wild = await server.post('/api/v1/presets/wild/apply');
  refused(wild, 422);
  assert.deepEqual(pointers(wild), ['/parameters/gait.t_ss']);
  assert.deepEqual((await server.state()).parameters, { 'gait.t_ss': 0.6 });
  await server.request('PATCH', '/api/v1/strategies', { body: { time: true } });
  await restart();

  refused(await put('Bad%20Name', slow), 422);
  refused(await put('%2e%2e%2fescape', slow), 404);
  refused(await put('x', { parameters: { 'no.such': 1 }, colour: 'red' }), 422);
  refused(await put('x', '{'), 400);
  refused(await server.post('/api/v1/presets/slow-1/apply', { a: 1 }), 422);
  assert.equal((await server.request('DELETE', '/api/v1/presets/wild')).json.deleted, true);
  for (const [method, target] of [['DELETE', 'wild'], ['GET', 'wild'], ['POST', 'wild/apply']]) {
    refused(await server.request(method, `/api/v1/presets/${target}`), 404);
  }
  refused(await server.post('/api/v1/presets', {}), 405);
});

test('presets outlive the server', async () => {
  await put('kept', { parameters: { 'gait.t_ds': 0.1 } });
  await server.end();
  server = await Server.start('--data', data);
  assert.deepEqual((await server.get('/api/v1/presets/kept')).json.parameters, { 'gait.t_ds': 0.1 });
});

test('events are listed by kind, tick and page', async () => {
  await restart();
  await server.post('/api/v1/walk', {}, { headers: { 'x-stagger-client': 'me' } });
  await server.post('/api/v1/pushes', {
    impulse_ns: 12, direction_deg: 90, trigger: { phase: 'single_support', fraction: 0.3 } });
  await eventually(
    async () => (await server.get('/api/v1/events?kind=adjustment')).json.items.length > 0, 'an adjustment');
  const { items } = (await server.get('/api/v1/events?kind=command')).json;
  const walk = items.find((item) => item.text === 'walk');
  assert.equal(walk.source, 'me');
  const adjustment = (await server.get('/api/v1/events?kind=adjustment&limit=1')).json.items[0];
  for (const name of ['planned_x', 'adjusted_x', 'planned_t_ss', 't_ss', 'moved_m', 'x']) {
    assert.equal(typeof adjustment.values[name], 'number', name);
  }
  const ids = [];
  let cursor = '';
  for (let i = 0; i < 100 && cursor !== null; ++i) {
    const page = (await server.get(`/api/v1/events?limit=3${cursor && `&cursor=${cursor}`}`)).json;
    assert.ok(page.items.length <= 3);
    ids.push(...page.items.map((item) => item.id));
    cursor = page.next_cursor;
  }
  assert.deepEqual(ids, [...new Set(ids)].sort((a, b) => b - a));
  const since = (await server.get(`/api/v1/events?since_tick=${adjustment.tick}`)).json;
  assert.ok(since.items.every((item) => item.tick >= adjustment.tick));
  for (const query of ['kind=noise', 'limit=0', 'limit=1001', 'cursor=x', 'since_tick=-1', 'colour=red', 'limit=1&limit=2']) {
    refused(await server.get(`/api/v1/events?${query}`), 422);
  }
});

test('speed goes from a hundredth to as fast as it goes, and the server answers all the while', async () => {
  await restart();
  const speed = (factor) => server.post('/api/v1/simulation/speed', { factor });
  assert.equal((await speed('max')).json.speed, 'max');
  assert.equal((await server.state()).speed, 'max');
  const { tick } = await server.state();
  await eventually(async () => (await server.state()).tick > tick + 5000, 'ticks');
  assert.equal((await server.state()).late_ticks >= 0, true);
  assert.equal((await speed(0.01)).status, 200);
  for (let i = 0; i < 5; ++i) assert.equal((await server.post('/api/v1/stop')).status, 200);
  const slow = (await server.state()).tick;
  await eventually(async () => (await server.state()).tick > slow, 'a tick');
  for (const factor of [0, 0.009, 1001, -1, 'fast', null]) {
    const wrong = await speed(factor);
    refused(wrong, 422);
    assert.deepEqual(pointers(wrong), ['/factor']);
  }
  refused(await server.post('/api/v1/simulation/speed', {}), 422);
  assert.equal((await server.state()).speed, 0.01);
  assert.equal((await speed(1)).json.speed, 1);
});

test('a list of steps is walked, and what cannot be walked is named', async () => {
  const steps = (side, ...xs) =>
    xs.map((x, i) => ((i % 2 === 0) === (side === 'left') ? { side: 'left', x, y: 0.1 } : { side: 'right', x, y: -0.1 }));
  const robot = await Server.start('--stand');
  try {
    const walk = (body) => robot.post('/api/v1/walk', body);
    const far = await walk({ frame: 'robot', steps: steps('right', 0.1, 3, 3.1) });
    refused(far, 422);
    assert.deepEqual(pointers(far), ['/steps/1']);
    assert.match(far.json.errors[0].detail, /reach/);
    const side = await walk({ frame: 'robot', steps: [steps('right', 0.1)[0], steps('right', 0.2)[0]] });
    assert.deepEqual(pointers(side), ['/steps/1']);
    for (const [body, pointer] of [
      [{ steps: [] }, '/steps'],
      [{ steps: [{ side: 'left', x: 0 }] }, '/steps/0/y'],
      [{ steps: [{ side: 'both', x: 0, y: 0 }] }, '/steps/0/side'],
      [{ steps: steps('right', 0.1), vx: 0.1 }, '/vx'],
      [{ steps: steps('right', 0.1), frame: 'moon' }, '/frame'],
      [{ steps: Array(65).fill(steps('right', 0.1)[0]) }, '/steps'],
    ]) {
      const wrong = await walk(body);
      refused(wrong, 422);
      assert.deepEqual(pointers(wrong), [pointer]);
    }
    const taken = await walk({ frame: 'robot', steps: steps('right', 0.15, 0.3, 0.3) });
    assert.equal(taken.status, 200);
    assert.equal(taken.json.steps, 3);
    await eventually(async () => {
      const state = await robot.state();
      return state.step_count === 3 && state.walking_state === 'idle';
    }, 'the end of the list');
    await walk({});
    await eventually(async () => (await robot.state()).walking, 'walking');
    refused(await walk({ steps: steps('left', 0.4) }), 409);
  } finally {
    await robot.end();
  }
});

test('a recording with parameters, presets and steps replays to the bit', async () => {
  const robot = await Server.start('--stand', '--data', path.join(data, 'replay'));
  try {
    await robot.pause();
    await robot.post('/api/v1/simulation/reset', { parameters: { 'lipm.noise': 0.0002 } });
    const { json: recording } = await robot.post('/api/v1/recordings', {});
    await robot.request('PUT', '/api/v1/presets/quick', { body: { parameters: { 'gait.t_ss': 0.5, 'lipm.noise': 0.0002 }, strategies: { time: false } } });
    await robot.step(800);
    assert.equal((await robot.post('/api/v1/presets/quick/apply')).status, 200);
    await robot.step(100);
    const steps = [{ side: 'left', x: 0.1, y: 0.1, yaw_deg: 7 }, { side: 'right', x: 0.2, y: -0.1 }];
    assert.equal((await robot.post('/api/v1/walk', { frame: 'robot', steps })).status, 200);
    await robot.step(4000);
    await robot.post('/api/v1/walk', { vx: 0.1 });
    await robot.step(1500);
    assert.equal((await robot.request('PATCH', '/api/v1/parameters', { body: { 'gait.t_ss': null } })).status, 200);
    await robot.step(2000);
    await robot.post(`/api/v1/recordings/${recording.id}/stop`);
    const file = path.join(data, 'replay', 'recordings', `${recording.id}.mcap`);
    const replay = await command(['replay', '--json', file]);
    assert.equal(replay.code, 0, replay.stdout + replay.stderr);
    const [world] = JSON.parse(replay.stdout).worlds;
    assert.equal(world.ticks, 8400);
    assert.ok(world.commands >= 4);
  } finally {
    await robot.end();
  }
});

test('a push with a key is carried out once', async () => {
  await restart();
  const send = (key, body) => server.post('/api/v1/pushes', body, { headers: { 'idempotency-key': key } });
  const first = await send('one', { impulse_ns: 1 });
  const again = await send('one', { impulse_ns: 1 });
  assert.equal(first.status, 201);
  assert.deepEqual(again.json, first.json);
  assert.equal(again.headers.location, first.headers.location);
  assert.equal(again.headers['idempotency-replayed'], 'true');
  refused(await send('one', { impulse_ns: 2 }), 422);
  refused(await send('two words', { impulse_ns: 2 }), 422);
  refused(await send('k'.repeat(129), { impulse_ns: 2 }), 422);
  refused(await send('two', { impulse_ns: -2 }), 422);
  assert.equal((await send('two', { impulse_ns: 2 })).status, 201);
  assert.equal((await server.get('/api/v1/pushes')).json.items.length, 2);
});

test('trials take lists of pushes and parameters', async () => {
  const spec = {
    robot: 'kasaei', plant: 'lipm', settle_s: 1, observe_s: 2, parameters: { 'gait.t_ss': 0.5 },
    pushes: [{ impulse_ns: 6 }, { impulse_ns: 4, trigger: { phase: 'single_support', fraction: 0.5 } }, { impulse_ns: 2, at_s: 5 }],
  };
  const run = (changed) => command(['trial', '-'], JSON.stringify({ ...spec, ...changed }));
  const { code, stdout } = await run({});
  assert.equal(code, 0);
  const result = JSON.parse(stdout);
  assert.equal(result.outcome, 'recovered');
  assert.ok(result.pushes.every((push) => ['recovered', 'not_back'].includes(push.outcome)));
  assert.equal(result.pushes[2].outcome, 'recovered');
  assert.equal(result.pushes[2].start_tick, 5000);
  assert.deepEqual(result.spec.parameters, spec.parameters);
  const again = JSON.parse((await command(['trial', '-'], JSON.stringify(result.spec))).stdout);
  assert.deepEqual(again, result);

  for (const [changed, pointer] of [
    [{ push: { impulse_ns: 1 } }, '/pushes'],
    [{ pushes: [] }, '/pushes'],
    [{ pushes: [{ impulse_ns: 1 }, { impulse_ns: 0 }] }, '/pushes/1/impulse_ns'],
    [{ pushes: [{ impulse_ns: 1, link: 'tail' }] }, '/pushes/0/link'],
    [{ parameters: { 'gait.t_ss': 50 } }, '/parameters/gait.t_ss'],
    [{ parameters: { 'no.such': 1 } }, '/parameters/no.such'],
  ]) {
    const wrong = await run(changed);
    assert.equal(wrong.code, 2);
    assert.match(wrong.stderr, RegExp(`${pointer} `));
  }
});

test('the command line takes and lists parameters', async () => {
  const run = (...more) => command(['run', '--robot', 'kasaei', '--plant', 'lipm', '--seconds', '2', '--json', ...more]);
  const own = JSON.parse((await run()).stdout);
  const other = JSON.parse((await run('--parameter', 'gait.t_ss=0.5', '--parameter', 'gait.t_ds=0.1')).stdout);
  assert.deepEqual(other.parameters, { 'gait.t_ds': 0.1, 'gait.t_ss': 0.5 });
  assert.notEqual(other.state_hash, own.state_hash);
  for (const text of ['gait.t_ss=50', 'no.such=1', 'gait.t_ss', 'adjust.freeze=0.9']) {
    const wrong = await run('--parameter', text);
    assert.equal(wrong.code, 2);
    assert.match(wrong.stderr, /--parameter/);
  }
  const listed = await command(['parameters', '--robot', 'kasaei', '--json']);
  assert.ok(JSON.parse(listed.stdout).items.some((item) => item.name === 'body.com_weight'));
  assert.match((await command(['parameters'])).stdout, /gait\.t_ss +0\.36 s/);
});
