// Robots from strangers: what is taken, what is refused and why, and what they must not reach.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { Server, command, form, isProblem, root } from './support.mjs';

const text = (name) => fs.readFileSync(`${root}/tests/data/robots/${name}`, 'utf8');
const biped = text('pitch_first.urdf');

let server;
let data;
before(async () => {
  data = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-upload-'));
  server = await Server.start('--data', data);
});
after(async () => {
  await server.end();
  fs.rmSync(data, { recursive: true });
});

const upload = (parts, query = '') =>
  server.request('POST', `/api/v1/robots${query}`, form(parts));
const check = (urdf, ...more) => upload([['urdf', urdf], ...more], '?check=true');
function refused(answer, pointer, reason) {
  assert.ok(isProblem(answer, 422), answer.text);
  const error = answer.json.errors.find((item) => item.pointer === pointer);
  assert.match(error?.detail ?? answer.text, reason);
  assert.ok(!answer.text.includes(data), 'paths of this machine are nobody else\'s business');
}

test('a check tells what the robot is, and stores nothing', async () => {
  const { status, json } = await check(biped);
  assert.equal(status, 200);
  const { report } = json;
  const told = JSON.parse(
    (await command(['robots', 'check', `${root}/tests/data/robots/pitch_first.urdf`, '--json'])).stdout,
  );
  delete told.urdf;
  told.description.urdf = report.description.urdf;
  assert.deepEqual(report, told);
  assert.equal(report.walks, true);
  assert.ok(report.figures.mass_kg > 0 && report.figures.com_height_m > 0);
  assert.ok(report.legs.left.foot && report.legs.right.foot);
  assert.ok(!fs.existsSync(path.join(data, 'robots')));
  assert.deepEqual(fs.readdirSync(path.join(data, 'incoming')), []);
});

test('an uploaded robot is listed, served, simulated, and deleted', async () => {
  const stored = await upload([['name', 'mine'], ['urdf', biped]]);
  assert.equal(stored.status, 201, stored.text);
  assert.equal(stored.headers.location, '/api/v1/robots/mine');
  const { robot } = stored.json;
  assert.deepEqual([robot.name, robot.uploaded], ['mine', true]);
  assert.deepEqual((await server.get('/api/v1/robots/mine')).json, robot);
  const listed = (await server.get('/api/v1/robots')).json.items;
  assert.deepEqual(listed.find(({ name }) => name === 'mine'), robot);
  assert.equal(listed.find(({ name }) => name === 'kasaei').uploaded, false);
  assert.equal((await server.get('/api/v1/robots/mine/files/robot.urdf')).text, biped);
  assert.equal((await server.get('/api/v1/robots/mine/files/.stranger')).status, 404);
  assert.ok(isProblem(await upload([['name', 'mine'], ['urdf', biped]]), 409));

  const reset = await server.post('/api/v1/simulation/reset', { robot: 'mine', plant: 'lipm' });
  assert.equal(reset.status, 200, reset.text);
  assert.ok(isProblem(await server.request('DELETE', '/api/v1/robots/mine'), 409));
  await server.post('/api/v1/simulation/reset', { robot: 'kasaei' });
  assert.equal((await server.request('DELETE', '/api/v1/robots/mine')).status, 204);
  assert.equal((await server.get('/api/v1/robots/mine')).status, 404);
  assert.ok(isProblem(await server.request('DELETE', '/api/v1/robots/mine'), 404));
  assert.ok(!fs.existsSync(path.join(data, 'robots/mine')));
});

test('robots that come with the program stay', async () => {
  assert.ok(isProblem(await server.request('DELETE', '/api/v1/robots/kasaei'), 409));
  assert.ok(isProblem(await upload([['name', 'kasaei'], ['urdf', biped]]), 409));
  assert.equal((await server.get('/api/v1/robots/kasaei')).status, 200);
});

test('a description of one\'s own is taken, and checked against the URDF', async () => {
  const { report } = (await check(biped)).json;
  const own = { ...report.description, walk: { ...report.description.walk, swing_height_m: 0.031 } };
  const stored = await upload([['name', 'own'], ['urdf', biped], ['description', JSON.stringify(own)]]);
  assert.equal(stored.status, 201, stored.text);
  const kept = JSON.parse(fs.readFileSync(path.join(data, 'robots/own/robot.json')));
  assert.equal(kept.walk.swing_height_m, 0.031);
  assert.equal((await server.request('DELETE', '/api/v1/robots/own')).status, 204);
  const wrong = { ...own, torso: 'no_such_link' };
  refused(await check(biped, ['description', JSON.stringify(wrong)]), '/description', /no_such_link/);
  refused(await check(biped, ['description', '{"version":']), '/description', /not JSON/);
  refused(await check(biped, ['description', '[]']), '/description', /object/);
});

test('meshes come along, under the path that the URDF says', async () => {
  const urdf = text('waist_and_arms.urdf');
  const mesh = fs.readFileSync(`${root}/tests/data/robots/small_feet/meshes/foot.stl`);
  const place = 'small_feet/meshes/foot.stl';
  const parts = [['name', 'meshed'], ['urdf', urdf], ['mesh', mesh, place]];
  const stored = await upload(parts);
  assert.equal(stored.status, 201, stored.text);
  assert.ok(!stored.text.includes('there is no file for its mesh'));
  const file = await server.get(`/api/v1/robots/meshed/files/${place}`);
  assert.equal(file.status, 200);
  assert.ok(fs.readFileSync(path.join(data, 'robots/meshed', place)).equals(mesh));
  assert.equal((await server.request('DELETE', '/api/v1/robots/meshed')).status, 204);
  // The file is there on this machine, where `stagger robots check` finds it; for an upload it is not.
  refused(await check(urdf), '/urdf', /there is no file for its mesh/);
});

test('what cannot walk is refused with the reason', async () => {
  refused(await check(text('four_joints.urdf')), '/urdf', /joint/);
  refused(await check(text('point_feet.urdf')), '/urdf', /point|line|sole/);
  refused(await check('this is no XML'), '/urdf', /URDF/);
  refused(await check('<robot name="a"><link name="b"/></robot>'), '/urdf', /./);
});

test('hostile documents are refused, in bounded time and memory', async () => {
  const bomb = `<?xml version="1.0"?><!DOCTYPE robot [<!ENTITY a "${'x'.repeat(1000)}">${Array.from(
    { length: 9 }, (_, i) => `<!ENTITY a${i} "${`&a${i ? i - 1 : ''};`.repeat(10)}">`).join('')}]>
    <robot name="&a8;"><link name="base"/></robot>`;
  const links = Array.from({ length: 600 }, (_, i) => `<link name="l${i}"/>` + (i
    ? `<joint name="j${i}" type="fixed"><parent link="l${i - 1}"/><child link="l${i}"/></joint>` : ''));
  const hostile = {
    bomb,
    nested: `<robot name="a">${'<link name="x">'.repeat(100000)}`,
    many: `<robot name="a">${links.join('')}</robot>`,
    nan: biped.replace(/<mass value="[^"]*"/, '<mass value="nan"'),
    infinite: biped.replace(/<mass value="[^"]*"/, '<mass value="1e999"'),
    nul: `${biped.slice(0, 500)}\0${biped.slice(500)}`,
  };
  for (const [what, urdf] of Object.entries(hostile)) {
    const answer = await check(urdf);
    assert.ok(isProblem(answer, 422), `${what}: ${answer.status} ${answer.text.slice(0, 300)}`);
  }
  const huge = await check(biped.replaceAll(/<mass value="[^"]*"/g, '<mass value="1e300"'));
  assert.ok([200, 422].includes(huge.status), huge.text);
  const garbage = await check(biped, ['mesh', 'solid x\nfacet normal nan nan nan\n', 'a/b.stl']);
  assert.ok([200, 422].includes(garbage.status), garbage.text);
  assert.equal((await server.get('/health')).status, 200);
});

test('nothing outside of the upload is read', async () => {
  // The foot's shape becomes a mesh: one that is there, elsewhere on this machine.
  const mesh = `${root}/tests/data/robots/small_feet/meshes/foot.stl`;
  const original = text('waist_and_arms.urdf');
  for (const uri of [mesh, `file://${mesh}`, `../../../../../../../..${mesh}`,
    `package://../../../../../../..${mesh}`]) {
    const answer = await check(original.replaceAll(/filename="[^"]+"/g, `filename="${uri}"`));
    assert.ok(answer.status === 422 || answer.text.includes('there is no file for its mesh'), answer.text);
    assert.ok(/there is no file for its mesh|geometry/.test(answer.text), answer.text);
  }
  for (const place of ['../a.stl', '/etc/a.stl', 'a/../../b.stl', '.stranger', 'a.urdf', 'robot.json', '',
    'a\\..\\b.stl', 'a/.b/c.stl', 'x'.repeat(300) + '.stl']) {
    refused(await check(biped, ['mesh', 'x', place]), '/mesh', /file name/);
  }
});

test('names, parts and parameters are told when they are wrong', async () => {
  for (const name of ['', '..', 'a/b', 'A', '-a', '.a', 'a'.repeat(65)]) {
    refused(await upload([['name', name], ['urdf', biped]]), '/name', /a-z/);
  }
  refused(await upload([['name', 'a']]), '/urdf', /missing/);
  refused(await check(biped, ['colour', 'red']), '/colour', /unknown/);
  refused(await check(biped, ['urdf', biped]), '/urdf', /twice/);
  refused(await check(biped, ['mesh', 'a', 'a.stl'], ['mesh', 'b', 'a.stl']), '/mesh', /twice/);
  refused(await upload([['urdf', biped]], '?check=perhaps'), '/check', /true, false/);
  refused(await upload([['urdf', biped]], '?dry=true'), '/dry', /unknown/);
  assert.ok(isProblem(await server.post('/api/v1/robots', { urdf: biped }), 415));
  const broken = { body: 'no parts', headers: { 'content-type': 'multipart/form-data; boundary=x' } };
  const answer = await server.request('POST', '/api/v1/robots', broken);
  assert.ok([400, 415].includes(answer.status), answer.text);
});

test('uploads have a greater limit than other bodies, and a limit', async () => {
  const big = await check(biped, ['mesh', 'x'.repeat(3 << 20), 'a.png']);
  assert.equal(big.status, 200, big.text.slice(0, 300));
  const walk = await server.request('POST', '/api/v1/walk', form([['vx', 'x'.repeat(3 << 20)]]));
  assert.ok(isProblem(walk, 413), walk.text);
  let outcome;
  try {
    outcome = (await check(biped, ['mesh', 'x'.repeat(33 << 20), 'a.png'])).status;
  } catch (error) {
    outcome = error.code; // cut off while it was still sending
  }
  assert.ok([413, 'EPIPE', 'ECONNRESET'].includes(outcome), String(outcome));
  assert.equal((await server.get('/health')).status, 200);
});
