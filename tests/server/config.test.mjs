// Settings from the command line, the environment and a file.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { Server, command } from './support.mjs';

let folder;
before(() => (folder = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-'))));
after(() => fs.rmSync(folder, { recursive: true }));

function file(content) {
  const full = path.join(folder, 'stagger.json');
  fs.writeFileSync(full, typeof content === 'string' ? content : JSON.stringify(content));
  return full;
}

function check(content, args = [], variables = {}) {
  const config = content === null ? [] : ['--config', file(content)];
  return command(['serve', '--check-config', ...config, ...args], '', () => {}, variables);
}

async function settings(...all) {
  const { code, stdout, stderr } = await check(...all);
  assert.equal(code, 0, stderr);
  return JSON.parse(stdout);
}

test('the command line goes before the environment, that before the file', async () => {
  const content = { port: 1001, seed: 11, stream_clients: 21 };
  const variables = { STAGGER_PORT: '1002', STAGGER_SEED: '12' };
  const result = await settings(content, ['--port', '1003'], variables);
  assert.deepEqual([result.port, result.seed, result.stream_clients], [1003, 12, 21]);
  assert.equal(result.robot, 'kasaei', 'the rest is as ever');
});

test('all kinds of settings', async () => {
  const content = {
    robot: 'op3',
    plant: 'bullet',
    stand: true,
    command_rate: 12.5,
    allow_host: ['a.example', 'b.example:80'],
    terrain: { kind: 'slope', angle_deg: 2 },
  };
  const result = await settings(content);
  for (const name of ['robot', 'plant', 'stand', 'command_rate', 'allow_host']) {
    assert.deepEqual(result[name], content[name], name);
  }
  assert.deepEqual(JSON.parse(result.terrain), content.terrain);
  const variables = { STAGGER_ALLOW_HOST: 'a.example,b.example:80', STAGGER_STAND: 'true' };
  const other = await settings(null, [], variables);
  assert.deepEqual([other.allow_host, other.stand], [content.allow_host, true]);
  assert.equal((await settings({ stand: false })).stand, false);
});

test('what it prints can be read again, and says the same', async () => {
  const first = await settings({ port: 1001, allow_origin: ['https://a.example'] });
  assert.deepEqual(await settings(first), first);
});

test('errors name the file, the field, the value and what is allowed', async () => {
  const cases = [
    [{ port: 70000 }, /stagger\.json: field "port" is 70000; allowed: .*0.*65535/],
    [{ port: '80' }, /field "port" is "80"; allowed/],
    [{ plant: 'moon' }, /field "plant" is "moon"; allowed: .*bullet,lipm/],
    [{ stand: 1 }, /field "stand" is 1; allowed: true or false/],
    [{ allow_host: 'a.example' }, /field "allow_host" is "a\.example"; allowed: a list/],
    [{ allow_host: ['a/b'] }, /field "allow_host" is \["a\/b"\]/],
    [{ command_rate: 0 }, /field "command_rate" is 0; allowed: .*1.*100000/],
    [{ prot: 80 }, /field "prot" is unknown; known: .*port/],
    [{ config: 'x' }, /field "config" is unknown/],
    ['{"port":', /stagger\.json: line 1, column/],
    ['{"port":1,"port":2}', /stagger\.json: line 1/],
    ['[]', /is not a JSON object/],
  ];
  for (const [content, message] of cases) {
    const { code, stdout, stderr } = await check(content);
    assert.equal(code, 2, JSON.stringify(content));
    assert.match(stderr, message);
    assert.equal(stdout, '');
  }
  const { stderr } = await check({ port: 70000, plant: 'moon' });
  assert.ok(/plant/.test(stderr) && /port/.test(stderr), 'all at once');
});

test('errors name the variable', async () => {
  const { code, stderr } = await check(null, [], { STAGGER_PORT: 'eighty' });
  assert.equal(code, 2);
  assert.match(stderr, /STAGGER_PORT is "eighty"; allowed: .*65535/);
});

test('a file that is not there, and a robot that is not there', async () => {
  const missing = await command(['serve', '--check-config', '--config', '/nonexistent']);
  assert.equal(missing.code, 2);
  assert.match(missing.stderr, /\/nonexistent: cannot be read/);
  const robot = await check({ robot: 'nobody' });
  assert.equal(robot.code, 2);
  assert.match(robot.stderr, /nobody/);
});

test('the server runs with the file', async () => {
  const server = await Server.start('--config', file({ seed: 77, stand: true }));
  try {
    const state = await server.state();
    assert.deepEqual([state.seed, state.walking], [77, false]);
  } finally {
    await server.end();
  }
});
