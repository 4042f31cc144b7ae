// Recordings over HTTP: what is recorded, how it is kept, and that it reads and replays as it was.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { Server, command, eventually, isProblem } from './support.mjs';
import { parseCsv, readIndexed, readStreaming } from './recording_file.mjs';

const base = '/api/v1/recordings';

/** A paused server, its data in a folder that goes with the test. */
async function paused(t, ...args) {
  const data = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-recording-'));
  const server = await Server.start('--data', data, ...args);
  server.data = data;
  t.after(async () => {
    await server.kill();
    fs.rmSync(data, { recursive: true, force: true });
  });
  await server.pause();
  await server.post('/api/v1/simulation/reset'); // tick 0
  return server;
}

async function start(server, body = {}) {
  const answer = await server.post(base, body);
  assert.equal(answer.status, 201, answer.text);
  assert.equal(answer.headers.location, `${base}/${answer.json.id}`);
  return answer.json;
}

const stop = async (server, id) => (await server.post(`${base}/${id}/stop`)).json;
const fileOf = (server, id) => path.join(server.data, 'recordings', `${id}.mcap`);
/** The data as a file: {file, headers}. */
async function download(server, id, query) {
  const answer = await fetch(`${server.url}${base}/${id}/data?${query}`);
  assert.equal(answer.status, 200);
  const file = path.join(server.data, 'download.mcap');
  fs.writeFileSync(file, Buffer.from(await answer.arrayBuffer()));
  return { file, headers: Object.fromEntries(answer.headers) };
}
const linesOf = ({ text }) => text.trimEnd().split('\n').map((line) => JSON.parse(line));
const push = (server, body) => server.post('/api/v1/pushes', { impulse_ns: 3, ...body });
const replayed = async (file) => {
  const { code, stdout, stderr } = await command(['replay', '--json', file]);
  return { code, stderr, ...(stdout ? JSON.parse(stdout) : {}) };
};

test('a recording holds every tick, and both readers find what the stream and the CSV said', async (t) => {
  const server = await paused(t);
  await server.post('/api/v1/simulation/reset', { seed: 4 });
  const stream = await server.stream();
  await stream.subscribe({ rate_hz: 1000, channels: ['com', 'push_force', 'preview'] });
  const { id, state } = await start(server, { note: 'two steps', tags: ['a', 'b'] });
  assert.equal(state, 'recording');
  assert.ok(isProblem(await server.request('DELETE', `${base}/${id}`), 409), 'delete an active one');
  await server.post('/api/v1/walk', { vx: 0.1 });
  await server.step(700);
  await push(server);
  await server.step(800);
  const info = await stop(server, id);
  assert.equal(info.state, 'done');
  assert.equal(info.ticks, 1500);
  assert.equal(info.lost_ticks, 0);
  assert.equal(info.pushes, 1);
  assert.deepEqual((await stop(server, id)).id, id, 'a second stop says the same');

  const { file, headers } = await download(server, id, 'format=mcap');
  assert.equal(headers['recording-finished'], 'true');
  assert.equal(Number(headers['content-length']), info.bytes);
  assert.ok(fs.readFileSync(file).equals(fs.readFileSync(fileOf(server, id))), 'not the file itself');
  const indexed = await readIndexed(fileOf(server, id));
  const streamed = readStreaming(fileOf(server, id));
  assert.ok(streamed.done);
  assert.deepEqual(indexed.topics, streamed.topics);
  assert.equal(Number(indexed.statistics.channelMessageCounts.get(3)), 1500);
  const frames = indexed.topics['/frame'];
  assert.equal(frames.length, 1500);
  assert.deepEqual(
    frames.map(({ value }) => Number(value.tick)),
    Array.from({ length: 1500 }, (_, i) => i),
  );
  assert.deepEqual(
    indexed.topics['/command'].map(({ value }) => [value.tick, Object.keys(value.command)[0]]),
    [
      [0, 'walk'],
      [700, 'push'],
    ],
  );
  assert.ok(indexed.topics['/event'].some(({ value }) => value.kind === 'push_done'));
  const hash = (await server.state()).state_hash;
  assert.equal(frames.at(-1).value.state_hash.toString(16).padStart(16, '0'), hash);
  const world = indexed.metadata.find(({ name }) => name === 'stagger.world').metadata;
  assert.equal(JSON.parse(world.get('world')).seed, 4);
  assert.match(world.get('robot_files'), /^[0-9a-f]{16}$/);

  // The last message of the stream, number by number.
  const last = await stream.first(({ op, tick }) => op === 'data' && tick === 1499);
  const { com, push_force, preview } = frames.at(-1).value;
  assert.deepEqual(last.v.com, [com.x, com.y, com.z]);
  assert.deepEqual(last.v.push_force, [push_force.x, push_force.y, push_force.z]);
  assert.deepEqual(last.v.preview, preview.flatMap(({ x, y, yaw, side }) => [x, y, yaw, side]));
  await stream.close();

  const csv = parseCsv((await server.get(`${base}/${id}/data?format=csv`)).text);
  assert.equal(csv.rows.length, 1500);
  assert.equal(csv.units['com.x'], 'm');
  assert.equal(csv.units['push_force.z'], 'N');
  assert.equal(csv.rows.at(-1).state_hash, hash);
  csv.rows.forEach((row, i) => {
    assert.equal(Number(row['com.x']), frames[i].value.com.x);
    assert.equal(Number(row.phase_time), frames[i].value.phase_time);
    assert.equal(row['preview[0].x'] ?? '', String(frames[i].value.preview[0]?.x ?? ''));
  });
});

test('fields, times and steps are chosen; what cannot be chosen is refused by name', async (t) => {
  const server = await paused(t);
  const { id } = await start(server);
  await server.step(1000);
  await stop(server, id);
  const data = (query, options) => server.get(`${base}/${id}/data?${query}`, options);

  const csv = parseCsv((await data('format=csv&fields=com.x,zmp&from=0.2&to=0.4&every=50')).text);
  assert.deepEqual(Object.keys(csv.units), [
    'elapsed', 'world', 'tick', 'time', 'com.x', 'zmp.x', 'zmp.y',
  ]);
  assert.deepEqual(csv.rows.map((row) => Number(row.elapsed)), [0.2, 0.25, 0.3, 0.35, 0.4]);

  const ndjson = await data('fields=state_hash,dcm', { headers: { accept: 'application/x-ndjson' } });
  assert.match(ndjson.headers['content-type'], /ndjson/);
  const lines = linesOf(ndjson);
  assert.equal(lines[0].op, 'world');
  const ticks = lines.filter(({ op }) => op === 'data');
  assert.equal(ticks.length, 1000);
  assert.deepEqual(Object.keys(ticks[0].v), ['dcm.x', 'dcm.y']);
  assert.match(ticks[0].state_hash, /^[0-9a-f]{16}$/);

  for (const [query, pointer] of [
    ['format=xml', '/format'],
    ['format=csv&fields=comm', '/fields'],
    ['format=csv&from=-1', '/from'],
    ['format=csv&to=nan', '/to'],
    ['format=csv&every=0', '/every'],
    ['format=mcap&fields=com,comm', '/fields'],
    ['format=mcap&every=no', '/every'],
    ['format=csv&colour=red', '/colour'],
  ]) {
    const answer = await data(query);
    assert.ok(isProblem(answer, 422), `${query}: ${answer.status}`);
    assert.equal(answer.json.errors[0].pointer, pointer);
  }
});

test('a part of a recording is an mcap of its own, with the numbers that ndjson has, and replays', async (t) => {
  const server = await paused(t);
  await server.post('/api/v1/walk', { vx: 0.1 });
  const { id } = await start(server);
  await server.step(600);
  await push(server);
  await server.step(400);
  await server.post('/api/v1/simulation/reset', { seed: 5 });
  await server.post('/api/v1/walk', { vx: 0.1 });
  await server.step(400);
  await stop(server, id);
  const whole = readStreaming(fileOf(server, id));

  /** Reads the part by both readers, and compares it with the ndjson of the same selection. */
  const check = async (query, expected) => {
    const { file, headers } = await download(server, id, `format=mcap&${query}`);
    assert.match(headers['content-disposition'], /-cut\.mcap"/);
    const indexed = await readIndexed(file);
    const streamed = readStreaming(file);
    assert.ok(streamed.done);
    assert.deepEqual(indexed.topics, streamed.topics);
    assert.equal(indexed.chunks.length, indexed.statistics.chunkCount);
    const named = (records, name) =>
      records.metadata.filter((each) => each.name === name).map((each) => Object.fromEntries(each.metadata));
    for (const name of ['stagger.recording', 'stagger.world']) {
      assert.deepEqual(named(indexed, name), named(whole, name));
    }
    assert.deepEqual(named(indexed, 'stagger.selection'), [Object.fromEntries(new URLSearchParams(query))]);

    const lines = linesOf(await server.get(`${base}/${id}/data?format=ndjson&${query}`));
    const of = (op) => lines.filter((line) => line.op === op);
    const frames = indexed.topics['/frame'];
    assert.equal(frames.length, expected);
    assert.deepEqual(frames.map(({ value }) => Number(value.tick)), of('data').map(({ tick }) => tick));
    of('data').forEach(({ t: time, v }, i) => {
      assert.equal(frames[i].value.time, time);
      for (const [label, number] of Object.entries(v)) {
        const [, channel, item, component] = /^(\w+)(\[\d+\])?(?:\.(\w+))?$/.exec(label);
        const one = frames[i].value[`${channel}${(item ?? '').replace(/\W/g, '_')}`];
        const found = one !== undefined ? one : frames[i].value[channel][item.slice(1, -1)];
        assert.equal(component ? found[component] : found, number, `${label} at ${time}`);
      }
    });
    assert.deepEqual((indexed.topics['/event'] ?? []).map(({ value }) => value), of('event'));
    assert.deepEqual(
      indexed.topics['/command'].map(({ value }) => value), of('command').map(({ op, ...rest }) => rest));
    const from = Math.trunc(Number(new URLSearchParams(query).get('from')) * 1e9);
    const begin = whole.topics['/frame'][0].time + BigInt(from);
    assert.ok(indexed.topics['/command'].every(({ time }) => time >= begin), 'begins before it should');
    return { file, frames, indexed };
  };

  // By time alone: whole frames, every tick, in both worlds. A world's log time begins at the wall's.
  const second = linesOf(await server.get(`${base}/${id}/data?format=ndjson&fields=com`))
    .find(({ op, world }) => op === 'data' && world === 1).elapsed;
  const { file, frames } = await check(`from=0.5&to=${Number((second + 0.2005).toFixed(4))}`, 701);
  const same = whole.topics['/frame'].filter(({ time }) => frames[0].time <= time && time <= frames.at(-1).time);
  assert.deepEqual(frames, same);
  const result = await replayed(file);
  assert.equal(result.code, 0, result.stderr);
  assert.deepEqual(result.worlds.map(({ ticks, equal }) => [ticks, equal]), [[500, true], [201, true]]);

  const some = await check('fields=com.x,zmp,phase_time,preview[0].x,preview[0].side&from=0.2&every=20', 60);
  const [schema] = [...some.indexed.schemas.values()].filter(({ name }) => name === 'stagger/Frame');
  assert.deepEqual(
    new TextDecoder().decode(schema.data).match(/^float64 \w+ +# \[.*?\]/gm),
    ['float64 time  # [s]', 'float64 phase_time  # [s]', 'float64 x  # [m]', 'float64 x  # [m]',
      'float64 y  # [m]', 'float64 x  # [m]', 'float64 side  # [1]']);
  assert.equal((await replayed(some.file)).code, 0);
  await check('every=100&fields=preview,state_hash', 14);

  // What has nothing to compare is not called equal: neither a world nor a file.
  const later = await replayed((await check(`from=${Number((second + 0.1005).toFixed(4))}`, 299)).file);
  assert.deepEqual([later.code, later.worlds.map(({ equal }) => equal)], [0, [null, true]]);
  const { file: empty } = await download(server, id, 'format=mcap&from=1000000');
  assert.equal((await readIndexed(empty)).topics['/command'].length, whole.topics['/command'].length);
  const nothing = await replayed(empty);
  assert.equal(nothing.code, 2);
  assert.match(nothing.stderr, /no tick to compare/);
});

test('of one that is still recorded comes what is written so far', async (t) => {
  const server = await paused(t);
  const { id } = await start(server);
  await server.step(500);
  await eventually(async () => (await server.get(`${base}/${id}`)).json.ticks === 500, 'the ticks');
  const csv = await server.get(`${base}/${id}/data?format=csv&fields=com`);
  assert.equal(csv.headers['recording-finished'], 'false');
  assert.equal(parseCsv(csv.text).rows.length, 500);
  const ticks = linesOf(await server.get(`${base}/${id}/data?format=ndjson`)).filter(({ op }) => op === 'data');
  assert.equal(ticks.length, 500);
  for (const [query, count] of [['format=mcap', 500], ['format=mcap&every=50', 10]]) {
    const { file, headers } = await download(server, id, query);
    assert.equal(headers['recording-finished'], 'false');
    assert.equal((await readIndexed(file)).topics['/frame'].length, count);
    assert.ok(readStreaming(file).done);
    assert.equal((await replayed(file)).code, 0);
  }
  await server.step(100);
  const info = await stop(server, id);
  assert.equal(info.ticks, 600, 'looking at it has changed it');
  assert.equal((await readIndexed(fileOf(server, id))).topics['/frame'].length, 600);

  const armed = await start(server, { when: 'push' });
  const answer = await server.get(`${base}/${armed.id}/data?format=csv`);
  assert.ok(isProblem(answer, 409), 'nothing is written of one that waits');
  assert.match(answer.json.detail, /waits for its push/);
});

test('recordings are listed, noted, protected and deleted', async (t) => {
  const server = await paused(t);
  const ids = [];
  for (const tag of ['odd', 'even', 'odd']) {
    const { id } = await start(server, { tags: [tag] });
    await server.step(20);
    await stop(server, id);
    ids.unshift(id);
  }
  const all = (await server.get(base)).json;
  assert.deepEqual(all.items.map(({ id }) => id), ids);
  assert.equal(all.disk.used_bytes, all.items.reduce((sum, { bytes }) => sum + bytes, 0));
  assert.equal(all.disk.warning, null);
  const page = (await server.get(`${base}?limit=2`)).json;
  assert.deepEqual(page.items.map(({ id }) => id), ids.slice(0, 2));
  const rest = (await server.get(`${base}?limit=2&cursor=${page.next_cursor}`)).json;
  assert.deepEqual(rest.items.map(({ id }) => id), ids.slice(2));
  assert.equal(rest.next_cursor, null);
  assert.equal((await server.get(`${base}?tag=odd`)).json.items.length, 2);
  assert.equal((await server.get(`${base}?state=armed`)).json.items.length, 0);
  assert.ok(isProblem(await server.get(`${base}?limit=0`), 422));
  assert.ok(isProblem(await server.get(`${base}?reason=x`), 422));

  const one = `${base}/${ids[0]}`;
  const patched = await server.request('PATCH', one, { body: { note: 'keep', tags: [], protected: true } });
  assert.equal(patched.json.note, 'keep');
  assert.deepEqual((await server.get(one)).json, patched.json);
  assert.ok(isProblem(await server.request('DELETE', one), 409), 'protected');
  await server.request('PATCH', one, { body: { protected: false, note: '' } });
  assert.equal((await server.request('DELETE', one)).status, 200);
  assert.equal(fs.existsSync(fileOf(server, ids[0])), false);
  for (const id of [ids[0], '..%2F..%2Fetc%2Fpasswd', '%2e%2e', "' OR 1=1"]) {
    assert.ok(isProblem(await server.get(`${base}/${encodeURI(id)}`), 404), id);
    assert.ok(isProblem(await server.get(`${base}/${encodeURI(id)}/data`), 404), id);
  }
  assert.ok(isProblem(await server.post(base, { before_s: 61 }), 422));
  assert.ok(isProblem(await server.post(base, { when: 'later' }), 422));
  assert.ok(isProblem(await server.request('PATCH', `${base}/${ids[1]}`, { body: { bytes: 1 } }), 422));
});

test('an armed recording takes the time before and after the next push', async (t) => {
  const server = await paused(t);
  await server.step(3000);
  const { id, state } = await start(server, { when: 'push', before_s: 1, after_s: 0.5 });
  assert.equal(state, 'armed');
  const idle = await start(server, { when: 'push' });
  assert.equal((await stop(server, idle.id)).ticks, 0);
  assert.ok(isProblem(await server.get(`${base}/${idle.id}`), 404), 'armed in vain');
  await server.step(100);
  await push(server);
  await server.step(2000);
  const info = await eventually(async () => {
    const answer = (await server.get(`${base}/${id}`)).json;
    return answer.state === 'done' && answer;
  }, 'the end of the recording');
  assert.equal(info.reason, 'push');
  assert.equal(info.pushes, 1);
  const ticks = readStreaming(fileOf(server, id)).topics['/frame'].map(({ value }) => Number(value.tick));
  assert.ok(ticks[0] <= 2100, `begins at ${ticks[0]}`);
  assert.equal(ticks.at(-1), 3600);
  assert.equal((await replayed(fileOf(server, id))).code, 0);
});

test('a fall saves itself, and replays though it begins in mid-world', async (t) => {
  const server = await paused(t);
  await server.post('/api/v1/walk', { vx: 0.1 });
  await server.step(2000);
  await server.request('PATCH', '/api/v1/strategies', { body: { step: false, time: false } });
  await push(server, { impulse_ns: 150, direction_deg: 90 });
  await server.step(6000);
  const saved = await eventually(async () => {
    const { items } = (await server.get(`${base}?reason=fall&state=done`)).json;
    return items[0];
  }, 'the recording of the fall');
  assert.equal(saved.falls, 1);
  const result = await replayed(fileOf(server, saved.id));
  assert.equal(result.code, 0, result.stderr);
  assert.ok(result.worlds[0].fell);
});

test('pushes, strategies, a reset and a fall replay to the bit', async (t) => {
  const server = await paused(t);
  await server.step(500);
  const { id } = await start(server);
  await server.post('/api/v1/walk', { vx: 0.2, wz: 0.1 });
  await server.step(1500);
  await push(server, { trigger: { phase: 'single_support', fraction: 0.3 }, direction_deg: 33 });
  await push(server, { at_s: 3, profile: 'half_sine', force_n: 50 });
  const cancelled = (await push(server, { at_s: 100 })).json.id;
  await server.step(1000);
  await server.request('DELETE', `/api/v1/pushes/${cancelled}`);
  await server.request('PATCH', '/api/v1/strategies', { body: { time: false } });
  await server.step(1000);
  await server.post('/api/v1/stop');
  await server.step(500);
  await server.post('/api/v1/simulation/reset', { seed: 9 });
  await server.post('/api/v1/walk');
  await server.step(1000);
  await push(server, { impulse_ns: 200, direction_deg: 90 });
  await server.step(5000);
  const info = await stop(server, id);
  assert.equal(info.worlds, 2);
  const result = await replayed(fileOf(server, id));
  assert.equal(result.code, 0, result.stderr);
  assert.deepEqual(result.worlds.map(({ equal }) => equal), [true, true]);
  assert.deepEqual(result.worlds.map(({ ticks }) => ticks), [4000, 6000]);
  assert.equal(result.worlds[1].fell, true);

  assert.equal((await replayed('/nowhere.mcap')).code, 2);
  const junk = path.join(server.data, 'junk.mcap');
  fs.writeFileSync(junk, 'no recording at all');
  assert.equal((await replayed(junk)).code, 2);
});

test('the full body replays to the bit', async (t) => {
  const server = await paused(t, '--plant', 'bullet');
  const { id } = await start(server);
  await server.step(300);
  await push(server, { impulse_ns: 2 });
  await server.step(200);
  await stop(server, id);
  const result = await replayed(fileOf(server, id));
  assert.equal(result.code, 0, result.stderr);
  assert.ok(result.worlds[0].ticks >= 500);
});

test('a fall whose past is more than the quota has room for is kept with the newest of it', async (t) => {
  const server = await paused(t, '--quota-gb', '0.001');
  const { id: earlier } = await start(server);
  await server.step(100);
  await stop(server, earlier);
  for (let i = 0; i < 3; ++i) await server.step(10000);
  await push(server, { impulse_ns: 150, direction_deg: 90 });
  await server.step(4000);
  const [fall, before] = await eventually(async () => {
    const { items } = (await server.get(base)).json;
    return items[0].reason === 'fall' && items[0].state === 'done' && items;
  }, 'the end of the recording');
  assert.equal(before.id, earlier, 'what was recorded before is still there');
  assert.deepEqual([fall.reason, fall.falls, fall.error], ['fall', 1, null]);
  const { size } = fs.statSync(fileOf(server, fall.id));
  assert.ok(size > 250_000 && size < 900_000, `${size} bytes of a million`);
  assert.ok(fall.ticks > 5000 && fall.ticks < 25000, `${fall.ticks} ticks`);
  assert.equal((await replayed(fileOf(server, fall.id))).code, 0);
});

test('within the quota: the oldest go first, protected ones stay', async (t) => {
  const server = await paused(t, '--quota-gb', '0.001');
  await server.post('/api/v1/walk', { vx: 0.2 });
  const record = async (body) => {
    const { id } = await start(server, body);
    await server.step(1000);
    return stop(server, id);
  };
  const kept = await record({ protected: true });
  let last;
  const warnings = [];
  for (let i = 0; i < 12; ++i) {
    last = await record();
    warnings.push((await server.get(base)).json.disk.warning);
  }
  assert.equal(warnings[0], null);
  assert.ok(warnings.some((text) => /quota/.test(text)), 'nobody was warned');
  const { items, disk } = (await server.get(base)).json;
  assert.ok(disk.used_bytes <= disk.quota_bytes, `${disk.used_bytes} bytes`);
  assert.ok(items.length < 13, 'nothing had to go');
  assert.ok(items.some(({ id }) => id === kept.id), 'the protected one has gone');
  assert.ok(items.some(({ id }) => id === last.id), 'the newest one has gone');
});
