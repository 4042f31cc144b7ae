// Several servers in one data folder: none takes what another is at for what a dead one has left.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { readIndexed } from './recording_file.mjs';
import { longCampaign as spec } from './small_campaign.mjs';
import { Server, command, eventually, isProblem, longPatience } from './support.mjs';

const recordings = '/api/v1/recordings';
const campaigns = '/api/v1/campaigns';

/** A folder for a test, and servers in it: {data, serve()}. */
function folder(t) {
  const data = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-shared-'));
  const servers = [];
  t.after(async () => {
    for (const server of servers) await server.kill();
    fs.rmSync(data, { recursive: true, force: true });
  });
  const serve = async (...args) => {
    const server = await Server.start('--data', data, ...args);
    servers.push(server);
    await server.pause();
    await server.post('/api/v1/simulation/reset');
    return server;
  };
  return { data, serve };
}

async function record(server, body = {}) {
  const answer = await server.post(recordings, body);
  assert.equal(answer.status, 201, answer.text);
  return answer.json.id;
}
const recording = async (server, id) => (await server.get(`${recordings}/${id}`)).json;
const stop = (server, id) => server.post(`${recordings}/${id}/stop`);
async function killed(server) {
  server.child.kill('SIGKILL');
  await server.ended;
}

test('what a server waits for or writes stays its own when another starts', async (t) => {
  const { data, serve } = folder(t);
  const first = await serve();
  const armed = await record(first, { when: 'push', before_s: 0.1, after_s: 0.2, note: 'armed' });
  const active = await record(first, { note: 'active' });
  await first.step(300);
  const second = await serve();
  for (const server of [first, second]) {
    assert.equal((await recording(server, armed)).state, 'armed');
    assert.equal((await recording(server, active)).state, 'recording');
  }
  for (const id of [armed, active]) {
    assert.ok(isProblem(await stop(second, id), 409), 'another server stops it');
    assert.ok(isProblem(await second.request('DELETE', `${recordings}/${id}`), 409));
  }
  await second.post('/api/v1/pushes', { impulse_ns: 2 }); // a push of its own world
  await second.step(500);
  assert.equal((await recording(first, armed)).state, 'armed');

  await first.post('/api/v1/pushes', { impulse_ns: 2 });
  await first.step(500);
  await eventually(async () => (await recording(second, armed)).state === 'done', 'the push');
  await second.request('PATCH', `${recordings}/${active}`, { body: { tags: ['by the other'] } });
  assert.equal((await stop(first, active)).json.ticks, 800);
  const info = await recording(second, active);
  assert.deepEqual([info.state, info.note, info.tags], ['done', 'active', ['by the other']]);
  for (const id of [armed, active]) {
    const file = path.join(data, 'recordings', `${id}.mcap`);
    const { topics } = await readIndexed(file);
    assert.equal(topics['/frame'].length, (await recording(second, id)).ticks);
    assert.equal((await command(['replay', file])).code, 0);
  }
});

test('what a killed server leaves is put in order, what living ones are at is not', async (t) => {
  const { data, serve } = folder(t);
  const dead = await serve();
  const living = await serve();
  const ids = {};
  for (const [name, server] of Object.entries({ dead, living })) {
    ids[name] = [await record(server, { when: 'push' }), await record(server, { note: name })];
    await server.step(300);
  }
  const written = (id) => async () => (await recording(living, id)).ticks === 300;
  await eventually(written(ids.dead[1]), 'the ticks in the file');
  await killed(dead);
  assert.ok(isProblem(await living.request('DELETE', `${recordings}/${ids.dead[1]}`), 409), 'not yet');

  const [next] = await Promise.all([serve(), serve(), serve()]); // one of them does it
  assert.ok(isProblem(await next.get(`${recordings}/${ids.dead[0]}`), 404), 'armed in vain');
  const { state, note, ticks } = await recording(next, ids.dead[1]);
  assert.deepEqual({ state, note, ticks }, { state: 'done', note: 'dead', ticks: 300 });
  await readIndexed(path.join(data, 'recordings', `${ids.dead[1]}.mcap`));
  assert.equal((await recording(next, ids.living[0])).state, 'armed');
  assert.equal((await recording(next, ids.living[1])).state, 'recording');
  assert.equal((await stop(living, ids.living[1])).json.ticks, 300);

  // Nobody has to start for it: a server that lives finishes it when asked to.
  const left = [await record(next, { when: 'push' }), await record(next)];
  await next.step(200);
  await eventually(async () => (await recording(living, left[1])).ticks === 200, 'the ticks');
  await killed(next);
  assert.equal((await stop(living, left[0])).status, 200);
  assert.ok(isProblem(await living.get(`${recordings}/${left[0]}`), 404));
  const finished = (await stop(living, left[1])).json;
  assert.deepEqual([finished.state, finished.ticks], ['done', 200]);
  assert.equal((await living.request('DELETE', `${recordings}/${left[1]}`)).status, 200);
});

test('two servers keep one quota: nothing protected goes, and the list is what there is', async (t) => {
  const { data, serve } = folder(t);
  // At the same time, in a folder that is not there yet.
  const servers = await Promise.all([1, 2].map(() => serve('--quota-gb', '0.002')));
  for (const server of servers) await server.post('/api/v1/walk', { vx: 0.2 });
  const one = async (server, body) => {
    const id = await record(server, body);
    await server.step(1000);
    assert.equal((await stop(server, id)).json.ticks, 1000);
    return id;
  };
  const kept = await one(servers[0]);
  await servers[1].request('PATCH', `${recordings}/${kept}`, { body: { protected: true } });
  for (let i = 0; i < 6; ++i) await Promise.all(servers.map((server) => one(server)));
  const { items, disk } = (await servers[1].get(recordings)).json;
  assert.ok(disk.used_bytes <= disk.quota_bytes, `${disk.used_bytes} bytes`);
  assert.ok(items.length < 13, 'nothing had to go');
  assert.ok(items.some(({ id }) => id === kept), 'the protected one has gone');
  const files = fs.readdirSync(path.join(data, 'recordings')).map((name) => path.parse(name).name);
  assert.deepEqual(items.map(({ id }) => id).sort(), files.sort());
});

const inState = (server, one, state) =>
  eventually(async () => {
    const item = (await server.get(one)).json;
    return item.state === state && item.done > 0 && item;
  }, `the campaign to be ${state}`, longPatience);

test('a campaign is of one server; the others see how far it is, and take over when it is gone', async (t) => {
  const { serve } = folder(t);
  const first = await serve();
  const before = (await first.post(campaigns, spec)).headers.location;
  await inState(first, before, 'running');
  const second = await serve();
  const after = (await first.post(campaigns, spec)).headers.location;
  const { done } = await inState(second, before, 'running');
  await eventually(async () => (await second.get(before)).json.done > done, 'progress');
  assert.equal((await second.get(after)).json.state, 'queued');
  for (const one of [before, after]) {
    for (const action of ['cancel', 'resume']) {
      const answer = await second.post(`${one}/${action}`);
      assert.ok(isProblem(answer, 409), answer.text);
      assert.match(answer.json.detail, /another server/);
    }
    assert.ok(isProblem(await second.request('DELETE', one), 409));
    const results = await second.get(`${one}/results`);
    assert.equal(results.headers['results-partial'], 'true', results.text);
  }
  assert.equal((await first.post(`${after}/cancel`)).status, 202);
  assert.equal((await second.get(after)).json.state, 'cancelled');
  assert.equal((await second.request('DELETE', after)).status, 204);
  assert.ok(isProblem(await first.get(after), 404));

  await killed(first);
  const left = await inState(second, before, 'interrupted');
  assert.equal((await second.get(`${before}/results`)).text.trim().split('\n').length, left.done + 1);
  assert.equal((await second.post(`${before}/resume`)).status, 202);
  const third = await serve();
  await inState(third, before, 'running');
  assert.ok(isProblem(await third.post(`${before}/resume`), 409));
  await second.post(`${before}/cancel`);
  const { done: kept } = await inState(third, before, 'cancelled');
  assert.ok(kept >= left.done, 'trials have been lost');

  // Of two that want to go on with it at the same time one does.
  const answers = await Promise.all([second, third].map((server) => server.post(`${before}/resume`)));
  assert.deepEqual(answers.map(({ status }) => status).sort(), [202, 409]);
  const winner = answers[0].status === 202 ? second : third;
  await inState(winner === second ? third : second, before, 'running');
  await winner.post(`${before}/cancel`);
  await inState(winner, before, 'cancelled');
});
