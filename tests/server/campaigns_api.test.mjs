// Campaigns over HTTP against the real server, on the pendulum.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { longCampaign as long, smallCampaign as spec } from './small_campaign.mjs';
import { Server, command, eventually, isProblem, longPatience } from './support.mjs';

const base = '/api/v1/campaigns';

let server;
before(async () => (server = await Server.start()));
after(() => server.end());

async function submit(body, at = server) {
  const answer = await at.post(base, body);
  assert.equal(answer.status, 202, answer.text);
  assert.equal(answer.headers.location, `${base}/${answer.json.id}`);
  return answer.headers.location;
}
const get = async (one, at = server) => (await at.get(one)).json;
const inState = (one, state, at = server) =>
  eventually(async () => {
    const item = await get(one, at);
    return item.state === state && item;
  }, `the campaign to be ${state}`, longPatience);
const under_way = (one, at = server) =>
  eventually(async () => {
    const item = await get(one, at);
    return item.state === 'running' && item.done > 0 && item;
  }, 'trials of the campaign', longPatience);
const reached = (one, done, at = server) =>
  eventually(async () => {
    const item = await get(one, at);
    return item.done >= done && item;
  }, `${done} trials of the campaign`, longPatience);
async function cancelled(one, at = server) {
  await at.post(`${one}/cancel`);
  return inState(one, 'cancelled', at);
}

test('a campaign gives what `stagger campaign run` gives', async () => {
  const one = await submit({ ...spec, thresholds: ['falls == 2'] });
  const item = await inState(one, 'done');
  assert.deepEqual(
    [item.name, item.done, item.total, item.fell, item.recovered, item.passed, item.error, item.eta_s],
    ['small', 4, 4, 2, 2, true, null, null]);

  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-campaigns-'));
  try {
    const file = path.join(folder, 'spec.json');
    fs.writeFileSync(file, JSON.stringify({ ...spec, thresholds: ['falls == 2'] }));
    const out = path.join(folder, 'out');
    assert.equal((await command(['campaign', 'run', file, '--out', out, '--quiet'])).code, 0);
    for (const [format, name] of [['csv', 'trials.csv'], ['ndjson', 'trials.ndjson'], ['junit', 'junit.xml']]) {
      const { status, text, headers } = await server.get(`${one}/results?format=${format}`);
      assert.equal(status, 200);
      assert.equal(text, fs.readFileSync(path.join(out, name), 'utf8'));
      assert.match(headers['content-disposition'], new RegExp(`attachment; .*${name}`));
    }
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
  const html = await server.get(`${one}/results`, { headers: { accept: 'text/html' } });
  assert.match(html.headers['content-type'], /^text\/html/);
  assert.match(html.text, /<title>small: push campaign<\/title>/);
  const summary = await server.get(`${one}/results?format=json`);
  assert.equal(summary.json.state, 'complete');
  assert.match((await server.get(`${one}/results`)).headers['content-type'], /^text\/csv/);
});

test('a threshold that is not met shows', async () => {
  const item = await inState(await submit({ ...spec, thresholds: ['falls == 0'] }), 'done');
  assert.equal(item.passed, false);
});

test('progress can be asked for, and comes as events while the live simulation goes on', async () => {
  const stream = await server.stream();
  await stream.subscribe({ channels: [], rate_hz: 1 });
  const one = await submit(long);
  const item = await under_way(one);
  assert.ok(item.eta_s > 0 && item.total === 10000 && item.done < item.total);
  const event = await stream.first(
    (m) => m.op === 'event' && m.kind === 'campaign' && /is running: [1-9]/.test(m.text), 'progress');
  assert.equal(event.values.total, 10000);
  const { tick } = await server.state();
  await eventually(async () => (await server.state()).tick > tick + 100, 'the live simulation');

  const answer = await server.post(`${one}/cancel`);
  assert.equal(answer.status, 202);
  const end = await inState(one, 'cancelled');
  assert.ok(end.done > 0 && end.done < end.total);
  await stream.first((m) => m.kind === 'campaign' && /is cancelled/.test(m.text), 'the end');
  const kept = await server.get(`${one}/results`);
  assert.equal(kept.text.trim().split('\n').length, end.done + 1);
  assert.equal(kept.headers['results-partial'], 'true');
  await stream.close();
});

test('results of one that runs are those of its end, as far as it is', async () => {
  const one = await submit({ ...long, name: 'growing', design: { kind: 'grid', repeats: 100 } });
  const parts = { csv: [], ndjson: [] };
  const partial = async (format) => {
    const answer = await server.get(`${one}/results?format=${format}`);
    assert.equal(answer.status, 200, answer.text);
    assert.equal(answer.headers['results-partial'], 'true');
    return answer;
  };
  for (const least of [1, 40, 80]) {
    const { done } = await reached(one, least);
    for (const format of ['csv', 'ndjson']) {
      const lines = (await partial(format)).text.trim().split('\n');
      const heading = format === 'csv' ? 1 : 0;
      assert.ok(lines.length - heading >= done, `${lines.length} lines of ${format}, ${done} done`);
      parts[format].push(lines);
    }
  }
  const { done } = await get(one);
  const { json } = await partial('json');
  assert.equal(json.state, 'incomplete');
  assert.ok(json.trials >= done && json.trials < 400);
  assert.equal(json.recovered + json.fell, json.trials);
  assert.equal(json.groups.find(({ path }) => path === 'push.direction_deg').path, 'push.direction_deg');
  assert.match((await partial('html')).text, /This campaign is not complete/);
  assert.match((await partial('junit')).text, /all trials have been run"><failure/);
  assert.equal((await get(one)).state, 'running');

  assert.equal((await inState(one, 'done')).done, 400);
  for (const [format, seen] of Object.entries(parts)) {
    const { text, headers } = await server.get(`${one}/results?format=${format}`);
    assert.equal(headers['results-partial'], undefined);
    const all = text.trim().split('\n');
    assert.equal(all.length, format === 'csv' ? 401 : 400);
    for (const lines of seen) {
      const known = new Set(lines);
      // As they stand and in their order.
      assert.deepEqual(all.filter((line) => known.has(line)), lines);
    }
    assert.ok(seen[0].length < all.length && seen[2].length > seen[0].length);
  }
  assert.equal((await server.get(`${one}/results?format=json`)).json.state, 'complete');
});

test('campaigns wait for their turn, one by one', async () => {
  const first = await submit(long);
  const second = await submit(spec);
  await under_way(first);
  assert.equal((await get(second)).state, 'queued');
  const nothing = await server.get(`${second}/results?format=ndjson`);
  assert.deepEqual([nothing.status, nothing.text], [200, '']);
  assert.equal(nothing.headers['results-partial'], 'true');
  assert.match((await server.get(`${second}/results`)).text, /^number,id,[^\n]*\n$/);
  const { state, trials, fall_rate } = (await server.get(`${second}/results?format=json`)).json;
  assert.deepEqual([state, trials, fall_rate], ['incomplete', 0, null]);
  for (const format of ['html', 'junit']) {
    assert.equal((await server.get(`${second}/results?format=${format}`)).status, 200);
  }
  const queued = (await server.get(`${base}?state=queued`)).json;
  assert.deepEqual(queued.items.map((item) => `${base}/${item.id}`), [second]);
  await cancelled(first);
  await inState(second, 'done');
});

test('lists come in pages, newest first', async () => {
  const ids = [];
  for (let i = 0; i < 3; ++i) ids.unshift((await submit(spec)).split('/').at(-1));
  const page = (await server.get(`${base}?limit=2`)).json;
  assert.deepEqual(page.items.map(({ id }) => id), ids.slice(0, 2));
  const next = (await server.get(`${base}?limit=1&cursor=${page.next_cursor}`)).json;
  assert.equal(next.items[0].id, ids[2]);
});

test('the same request sent again is no second campaign', async () => {
  const options = { headers: { 'idempotency-key': 'once' } };
  const first = await server.post(base, spec, options);
  const again = await server.post(base, spec, options);
  assert.equal(again.json.id, first.json.id);
  assert.equal(again.headers['idempotency-replayed'], 'true');
  assert.ok(isProblem(await server.post(base, long, options), 422));
});

describe('what is wrong is told', () => {
  test('in the specification, field by field', async () => {
    const refused = async (change, pointer, detail) => {
      const answer = await server.post(base, { ...spec, ...change });
      assert.ok(isProblem(answer, 422), answer.text);
      const error = answer.json.errors.find((each) => each.pointer === pointer);
      assert.ok(error, answer.text);
      assert.match(error.detail, detail);
    };
    await refused({ version: 2 }, '/version', /2/);
    await refused({ unknown: 1 }, '/unknown', /no field here/);
    await refused({ base: { ...spec.base, robot: 'nobody' } }, '/base/robot', /robots here: .*kasaei/);
    await refused({ factors: { 'push.impulse_ns': [-1] } }, '/factors/push.impulse_ns/0', /-1/);
    await refused({ design: { kind: 'grid', repeats: 30000 }, limits: { max_trials: 1e6 } }, '/design',
      /120000 trials; allowed here: 1 to 100000/);
  });
  test('in the body', async () => {
    assert.ok(isProblem(await server.post(base, '{'), 400));
    assert.ok(isProblem(await server.post(base, '{}', { headers: { 'content-type': 'text/plain' } }), 415));
    assert.ok(isProblem(await server.post(base, JSON.stringify({ x: 'x'.repeat(1 << 20) })), 413));
  });
  test('in the address', async () => {
    for (const method of ['GET', 'DELETE']) {
      assert.ok(isProblem(await server.request(method, `${base}/1`), 404));
      assert.ok(isProblem(await server.request(method, `${base}/../1`), 404));
    }
    for (const action of ['cancel', 'resume']) {
      assert.ok(isProblem(await server.post(`${base}/1/${action}`), 404));
    }
    assert.ok(isProblem(await server.get(`${base}/1/results`), 404));
    const one = await submit(spec);
    await inState(one, 'done');
    assert.ok(isProblem(await server.get(`${one}/results?format=xls`), 422));
    assert.ok(isProblem(await server.get(`${base}?state=odd`), 422));
    assert.ok(isProblem(await server.get(`${base}?limit=0`), 422));
  });
  test('in its state', async () => {
    const one = await submit(long);
    await under_way(one);
    assert.ok(isProblem(await server.request('DELETE', one), 409));
    assert.ok(isProblem(await server.post(`${one}/resume`), 409));
    await cancelled(one);
    assert.ok(isProblem(await server.post(`${one}/cancel`), 409));
    assert.equal((await server.request('DELETE', one)).status, 204);
    assert.ok(isProblem(await server.get(one), 404));
  });
  test('while `stagger campaign` has it', async () => {
    const one = await submit(long);
    await cancelled(one);
    const folder = path.join(server.data, 'campaigns', path.basename(one));
    const shell = command(['campaign', 'resume', folder, '--threads', '1'], '', (child) =>
      child.stderr.once('data', async () => {
        const answer = await server.post(`${one}/resume`);
        child.kill('SIGINT');
        assert.ok(isProblem(answer, 409), answer.text);
        assert.match(answer.json.detail, /another process runs this campaign/);
      }),
    );
    assert.equal((await shell).code, 130);
    assert.equal((await get(one)).state, 'cancelled');
    assert.equal((await server.post(`${one}/resume`)).status, 202);
    await cancelled(one);
  });
  test('when too many wait', async () => {
    const waiting = [];
    let answer;
    for (let i = 0; i < 17; ++i) {
      answer = await server.post(base, long);
      if (answer.status !== 202) break;
      waiting.push(answer.headers.location);
    }
    assert.ok(isProblem(answer, 503), answer.text);
    assert.ok(answer.headers['retry-after']);
    for (const one of waiting.reverse()) await cancelled(one);
  });
});

test('the end of the server interrupts a campaign; the next server goes on with it', async () => {
  const data = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-campaigns-'));
  const start = () => Server.startWith({ STAGGER_DATA: data });
  const small = { ...long, design: { kind: 'grid', repeats: 40 } };
  let now;
  try {
    now = await start();
    const one = await submit(small, now);
    await under_way(one, now);
    assert.equal((await now.stop()).code, 0);
    await now.kill();

    now = await start();
    const stopped = await get(one, now);
    assert.equal(stopped.state, 'interrupted');
    assert.ok(stopped.done > 0 && stopped.done < 160);
    // What has been run can be had.
    assert.equal((await now.get(`${one}/results`)).text.trim().split('\n').length, stopped.done + 1);
    assert.equal((await now.post(`${one}/resume`)).status, 202);
    await reached(one, stopped.done + 1, now);
    now.child.kill('SIGKILL');
    await now.ended;

    now = await start();
    const killed = await get(one, now);
    assert.equal(killed.state, 'interrupted');
    assert.ok(killed.done > stopped.done);
    assert.equal((await now.get(`${one}/results`)).text.trim().split('\n').length, killed.done + 1);
    await now.post(`${one}/resume`);
    assert.equal((await inState(one, 'done', now)).done, 160);
    const csv = (await now.get(`${one}/results`)).text;
    const whole = await submit(small, now);
    await inState(whole, 'done', now);
    assert.equal((await now.get(`${whole}/results`)).text, csv);
    await now.end();
  } finally {
    await now?.kill();
    fs.rmSync(data, { recursive: true, force: true });
  }
});
