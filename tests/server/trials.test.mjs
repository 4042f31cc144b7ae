// A trial over HTTP: the same to the bit as on the command line, beside a simulation that goes on.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Server, command } from './support.mjs';

let server;
before(async () => (server = await Server.start()));
after(() => server.end());

const spec = {
  robot: 'kasaei',
  plant: 'lipm',
  seed: 3,
  settle_s: 1,
  observe_s: 2,
  strategies: ['ankle', 'step'],
  push: { impulse_ns: 7, direction_deg: 90, trigger: { phase: 'single_support', leg: 'left', fraction: 0.3 } },
};
const post = (body) => server.post('/api/v1/trials', body);

test('gives what `stagger trial` gives, and leaves the simulation alone', async () => {
  await server.pause();
  const before = await server.state();
  const { status, json } = await post(spec);
  assert.equal(status, 200);
  const { stdout } = await command(['trial', '-'], JSON.stringify(spec));
  assert.deepEqual(json, JSON.parse(stdout));
  const { state_hash: hash, tick, session_id: session } = await server.state();
  assert.deepEqual([hash, tick, session], [before.state_hash, before.tick, before.session_id]);
});

test('names what is wrong with a specification, and what would take too long', async () => {
  for (const [change, pointer] of [
    [{ robot: 'nobody' }, '/robot'],
    [{ robot: undefined }, '/robot'],
    [{ push: { impulse_ns: 7, link: 'tail' } }, '/push/link'],
    [{ parameters: { 'gait.t_ss': 9 } }, '/parameters/gait.t_ss'],
    [{ settle_s: 31 }, '/settle_s'],
    [{ observe_s: 31 }, '/observe_s'],
    [{ push: { impulse_ns: 7, at_s: 31 } }, '/push/at_s'],
    [{ push: undefined, pushes: Array(11).fill({ impulse_ns: 1 }) }, '/pushes'],
    [{ push: undefined, pushes: [{ impulse_ns: 1, at_s: 40 }] }, '/pushes/0/at_s'],
    [{ whatever: 1 }, '/whatever'],
  ]) {
    const { status, json } = await post({ ...spec, ...change });
    assert.equal(status, 422, pointer);
    assert.deepEqual(json.errors.map((error) => error.pointer), [pointer]);
  }
});

test('one at a time: another one is told to come again', async () => {
  const long = { ...spec, plant: 'bullet', settle_s: 2 };
  const answers = await Promise.all([post(long), post(long), post(long)]);
  const statuses = answers.map(({ status }) => status).sort();
  assert.equal(statuses[0], 200);
  assert.ok(statuses.includes(503), statuses.join());
  for (const { status, headers } of answers) {
    if (status === 503) assert.equal(headers['retry-after'], '1');
  }
});
