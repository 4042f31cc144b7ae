// The Python client and its examples against the real binary, with Python's standard library alone.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import { after, before, test } from 'node:test';
import { Server, root, within } from './support.mjs';

let server;
before(async () => (server = await Server.start()));
after(() => server.end());

/** Without site packages (-S), so that nothing that happens to be installed helps. */
async function python(...args) {
  const child = spawn('python3', ['-B', '-S', ...args], {
    cwd: root,
    env: { PATH: process.env.PATH, PYTHONPATH: `${root}/docs/python`, LC_ALL: 'C.UTF-8' },
    stdio: ['ignore', 'pipe', 'pipe'],
  });
  const result = { stdout: '', stderr: '' };
  child.stdout.on('data', (data) => (result.stdout += data));
  child.stderr.on('data', (data) => (result.stderr += data));
  const ended = new Promise((resolve) => child.on('close', resolve));
  try {
    return { code: await within(ended, `python3 ${args.join(' ')}`), ...result };
  } finally {
    child.kill('SIGKILL');
  }
}

/** Runs statements that print JSON; what they printed. */
async function script(text) {
  const { code, stdout, stderr } = await python(
    '-c',
    `import json\nfrom stagger_client import *\nrobot = Stagger(${JSON.stringify(server.url)}, name='tester')\n${text}`,
  );
  assert.equal(code, 0, stderr);
  return JSON.parse(stdout);
}

test('the client commands the simulation and reads it', async () => {
  const told = await script(`
robot.pause()
robot.reset(seed=5)
robot.walk(vx=0.1)
before = robot.step(12000)
push = robot.push(direction_deg=90, impulse_ns=2, duration_s=0.05)
robot.step(100)
done = robot.find_push(push["id"])
late = robot.push(impulse_ns=1, at_s=1e5)
cancelled = robot.cancel_push(late["id"])
state = robot.state()
print(json.dumps({"before": before, "done": done, "cancelled": cancelled, "state": state,
  "pushes": [p["id"] for p in robot.pushes()], "hip": robot.strategies(hip=False)["hip"],
  "robots": [r["name"] for r in robot.robots()]}))
robot.strategies(hip=True)
robot.stop()
robot.resume()`);
  assert.equal(told.before.tick, 12000);
  assert.equal(told.state.tick, 12100);
  assert.equal(told.state.seed, 5);
  assert.equal(told.done.state, 'done');
  assert.ok(Math.abs(Math.hypot(...told.done.delivered_ns) - 2) < 1e-6);
  assert.equal(told.cancelled.state, 'cancelled');
  assert.deepEqual(told.pushes, [2, 1]);
  assert.equal(told.hip, false);
  assert.ok(told.robots.includes('kasaei'));
});

test('what the server refuses is an error with status, reason and fields', async () => {
  const told = await script(`
try:
    robot.push(impulse_ns=-3)
except StaggerError as error:
    print(json.dumps([error.status, error.errors[0]["pointer"], str(error)]))`);
  assert.deepEqual(told.slice(0, 2), [422, '/impulse_ns']);
  assert.match(told[2], /more than 0 to 200/);
});

test('the client uploads a robot and deletes it', async () => {
  const urdf = `${root}/tests/data/robots/waist_and_arms.urdf`;
  const mesh = `${root}/tests/data/robots/small_feet/meshes/foot.stl`;
  const told = await script(`
urdf = open(${JSON.stringify(urdf)}).read()
meshes = {"small_feet/meshes/foot.stl": open(${JSON.stringify(mesh)}, "rb").read()}
checked = robot.upload_robot("", urdf, meshes=meshes, check=True)
stored = robot.upload_robot("from_python", urdf, meshes=meshes)
print(json.dumps([checked["report"]["walks"], stored["robot"]["uploaded"], robot.delete_robot("from_python")]))`);
  assert.deepEqual(told, [true, true, null]);
});

test('the client follows the stream and answers its pings', async () => {
  const told = await script(`
ops, ticks, events = set(), [], []
for message in robot.stream(["com", "dcm"], rate_hz=50):
    ops.add(message["op"])
    if message["op"] == "data":
        ticks.append(message["tick"])
        if len(ticks) == 10: robot.push(impulse_ns=1)
    if message["op"] == "event" and message["kind"] == "command": events.append(message["source"])
    if len(ticks) >= 20 and events and "heartbeat" in ops: break
print(json.dumps([sorted(ops), ticks, events]))`);
  const [ops, ticks, events] = told;
  assert.deepEqual(ops, ['data', 'event', 'heartbeat', 'hello', 'subscribed']);
  assert.ok(ticks.every((tick, i) => i === 0 || tick > ticks[i - 1]), String(ticks));
  assert.ok(events.includes('tester'));
});

test('the sweep tells which pushes a robot takes, the same each time', async () => {
  const args = ['docs/python/push_sweep.py', '--url', server.url, '--impulses', '1,150', '--directions', '90',
    '--settle', '2', '--observe', '2'];
  const [first, second] = [await python(...args), await python(...args)];
  assert.equal(first.code, 0, first.stderr);
  assert.equal(first.stdout, second.stdout);
  const rows = first.stdout.trim().split(/\r?\n/).map((line) => line.split(','));
  assert.deepEqual(rows[0], ['direction [deg]', 'impulse [N s]', 'delivered [N s]', 'fell', 'steps']);
  assert.deepEqual(rows.slice(1).map((row) => row[3]), ['0', '1']);
  assert.equal(Number(rows[1][2]), 1);
});

test('the logger writes the stream as CSV', async () => {
  await server.post('/api/v1/simulation/reset', {});
  await server.post('/api/v1/simulation/resume');
  const { code, stdout, stderr } = await python('docs/python/csv_logger.py', '--url', server.url,
    '--channels', 'com,dcm', '--rate', '100', '--seconds', '0.5');
  assert.equal(code, 0, stderr);
  const [header, ...rows] = stdout.trim().split(/\r?\n/).map((line) => line.split(','));
  assert.deepEqual(header, ['session_id', 'tick', 't [s]', 'com_x [m]', 'com_y [m]', 'com_z [m]',
    'dcm_x [m]', 'dcm_y [m]']);
  assert.ok(rows.length >= 40, `${rows.length} rows`);
  for (const row of rows) {
    assert.equal(row.length, header.length);
    assert.ok(row.slice(1).every((value) => Number.isFinite(Number(value))), String(row));
  }
  const unknown = await python('docs/python/csv_logger.py', '--url', server.url, '--channels', 'nothing');
  assert.equal(unknown.code, 1);
  assert.match(unknown.stderr, /nothing/);
});

test('the client and its examples import nothing but the standard library', () => {
  const own = /^(stagger_client)$/;
  for (const file of fs.readdirSync(`${root}/docs/python`).filter((name) => name.endsWith('.py'))) {
    const text = fs.readFileSync(`${root}/docs/python/${file}`, 'utf8');
    const modules = [...text.matchAll(/^(?:import|from) (\w+)/gm)].map(([, name]) => name);
    const standard = ['argparse', 'base64', 'csv', 'hashlib', 'json', 'os', 'socket', 'struct', 'sys',
      'time', 'urllib', 'uuid'];
    for (const name of modules) assert.ok(standard.includes(name) || own.test(name), `${file}: ${name}`);
  }
});
