// The description of the API against the server that serves it: it is sound, it is complete, and every route answers
// as it says. A new route is tested by describing it, with an example; SETUPS is for what takes more than that.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import { after, before, describe, test } from 'node:test';
import { createConfig, lintFromString } from '@redocly/openapi-core';
import Ajv2020 from 'ajv/dist/2020.js';
import { Server, eventually, form, longPatience, root } from './support.mjs';

const METHODS = ['get', 'post', 'put', 'patch', 'delete'];
const BIPED = fs.readFileSync(`${root}/tests/data/robots/pitch_first.urdf`, 'utf8');

let server;
let description;
let operations;
before(async () => {
  server = await Server.start('--log-level', 'debug', '--web-dir', `${root}/web/public`);
  description = (await server.get('/openapi.json')).json;
  operations = Object.entries(description.paths).flatMap(([path, item]) =>
    METHODS.filter((method) => item[method]).map((method) => ({ path, method, ...item[method] })),
  );
});
after(() => server.end());

const resolve = (item) =>
  item?.$ref
    ? resolve(item.$ref.slice(2).split('/').reduce((at, key) => at[key.replace('~1', '/')], description))
    : item;

async function aPush() {
  return (await server.post('/api/v1/pushes', { impulse_ns: 1, at_s: 1e5 })).json.id;
}
async function aPreset() {
  await server.request('PUT', '/api/v1/presets/mine', { body: { parameters: { 'gait.t_ss': 0.4 } } });
  return { parameters: { name: 'mine' } };
}
async function aRecording() {
  return { parameters: { id: (await server.post('/api/v1/recordings', { after_s: 5 })).json.id } };
}
async function aDoneRecording() {
  const made = await aRecording();
  await server.post(`/api/v1/recordings/${made.parameters.id}/stop`);
  return made;
}
async function aCampaign(spec = {}) {
  const content = description.paths['/api/v1/campaigns'].post.requestBody.content;
  const body = { ...content['application/json'].example, ...spec };
  return { parameters: { id: (await server.post('/api/v1/campaigns', body)).json.id } };
}
async function aDoneCampaign() {
  // Those that are under way would be waited for.
  for (const { id } of (await server.get('/api/v1/campaigns')).json.items) {
    await server.post(`/api/v1/campaigns/${id}/cancel`);
  }
  const made = await aCampaign();
  const state = async () => (await server.get(`/api/v1/campaigns/${made.parameters.id}`)).json.state;
  await eventually(async () => (await state()) === 'done', 'the end of the campaign', longPatience);
  return made;
}
const aLongCampaign = () => aCampaign({ design: { kind: 'grid', repeats: 5000 } });
async function aCancelledCampaign() {
  const made = await aLongCampaign();
  const path = `/api/v1/campaigns/${made.parameters.id}`;
  await server.post(`${path}/cancel`);
  const state = async () => (await server.get(path)).json.state;
  await eventually(async () => (await state()) === 'cancelled', 'the end of the campaign', longPatience);
  return made;
}
async function aRobot() {
  const { body, headers } = form([['name', 'mine'], ['urdf', BIPED]]);
  await server.request('POST', '/api/v1/robots', { body, headers });
}

/** What a route needs to succeed, beyond its example: a state before, parameters, or a body that is no JSON. */
const SETUPS = {
  step: async () => void (await server.pause()),
  getPush: async () => ({ parameters: { id: await aPush() } }),
  cancelPush: async () => ({ parameters: { id: await aPush() } }),
  getPreset: aPreset,
  deletePreset: aPreset,
  applyPreset: aPreset,
  getRecording: aRecording,
  changeRecording: aRecording,
  stopRecording: aRecording,
  deleteRecording: aDoneRecording,
  getRecordingData: aDoneRecording,
  getCampaign: aCampaign,
  getCampaignResults: aDoneCampaign,
  deleteCampaign: aDoneCampaign,
  cancelCampaign: aLongCampaign,
  resumeCampaign: aCancelledCampaign,
  uploadRobot: async () => ({ query: '?check=true', ...form([['urdf', BIPED]]) }),
  deleteRobot: async () => {
    await aRobot();
    return { parameters: { name: 'mine' } };
  },
  ready: async () => {
    await server.post('/api/v1/simulation/resume');
    await eventually(async () => (await server.state()).tick > 0, 'a tick');
  },
};

function target(operation, parameters = {}) {
  const examples = (operation.parameters ?? []).map(resolve).filter((item) => item.in === 'path');
  return examples.reduce(
    (path, { name, example }) => path.replace(`{${name}}`, parameters[name] ?? example),
    operation.path,
  );
}

const jsonOf = (operation) => operation.requestBody?.content['application/json'];

async function succeed(operation) {
  const { parameters, query = '', body, headers } = (await SETUPS[operation.operationId]?.()) ?? {};
  const example = body ?? jsonOf(operation)?.example;
  return server.request(operation.method.toUpperCase(), target(operation, parameters) + query, {
    body: example,
    headers,
  });
}

let ajv;
function assertDescribed(operation, answer) {
  const what = `${operation.operationId}: ${answer.status} ${answer.text.slice(0, 500)}`;
  const response = resolve(operation.responses[answer.status]);
  assert.ok(response, `not described: ${what}`);
  const type = (answer.headers['content-type'] ?? '').split(';')[0];
  const types = Object.keys(response.content ?? {});
  if (types.length === 0) return assert.equal(answer.text, '', what);
  assert.ok(types.includes(type) || types.includes('*/*'), `${what} is ${type}`);
  for (const [header, { required }] of Object.entries(response.headers ?? {})) {
    if (required === false) continue;
    assert.ok(answer.headers[header.toLowerCase()], `${what} has no ${header}`);
  }
  if (!/json/.test(type)) return undefined;
  if (!ajv) {
    ajv = new Ajv2020({ strict: false, allErrors: true });
    ajv.addSchema(description, 'api');
  }
  // The schema where it stands, so that its references hold.
  const pointer = (part) => encodeURIComponent(String(part).replaceAll('~', '~0').replaceAll('/', '~1'));
  const raw = operation.responses[answer.status];
  const place = raw.$ref ?? `#/paths/${pointer(operation.path)}/${operation.method}/responses/${answer.status}`;
  const key = `api${place}/content/${pointer(type)}/schema`;
  const fits = ajv.getSchema(key);
  assert.ok(fits(answer.json), `${what}: ${ajv.errorsText(fits.errors)}`);
  return undefined;
}

/** Every number of a body, with the body that has another one in its place. */
function* numbers(schema, example, pointer = '') {
  for (const [name, raw] of Object.entries(schema.properties ?? {})) {
    const field = resolve(raw);
    const at = `${pointer}/${name}`;
    const put = (value) => ({ ...example, [name]: value });
    const number = [field, ...(field.oneOf ?? [])].find(({ type }) => type === 'number' || type === 'integer');
    if (number) yield { at, field: number, put };
    const inner = field.oneOf
      ? field.oneOf.map(resolve).map((variant) => [variant, variant.examples?.[0]])
      : [[field, field.required?.reduce((made, key) => {
          const needed = resolve(field.properties[key]);
          return { ...made, [key]: needed.enum?.[0] ?? needed.minimum ?? needed.const };
        }, {})]];
    for (const [variant, start] of inner) {
      if (!variant.properties) continue;
      for (const found of numbers(variant, start ?? {}, at)) {
        yield { ...found, put: (value) => put(found.put(value)) };
      }
    }
  }
}

/** Numbers just outside the range of a field, and the ends that are in it. */
function edges(field) {
  const outside = [];
  const inside = [];
  const beyond = (value) => (field.type === 'integer' ? 1 : Math.max(1e-9, Math.abs(value) * 1e-9));
  if ('minimum' in field) {
    outside.push(field.minimum - beyond(field.minimum));
    inside.push(field.minimum);
  }
  if ('maximum' in field && field.maximum < Number.MAX_SAFE_INTEGER) {
    outside.push(field.maximum + beyond(field.maximum));
    inside.push(field.maximum);
  }
  if ('exclusiveMinimum' in field) outside.push(field.exclusiveMinimum);
  if ('exclusiveMaximum' in field) outside.push(field.exclusiveMaximum);
  return { outside, inside };
}

test('the description is sound OpenAPI 3.1', async () => {
  assert.match(description.openapi, /^3\.1\./);
  const config = await createConfig({
    extends: ['recommended'],
    rules: { 'operation-2xx-response': 'off' }, // a WebSocket answers 101
  });
  const problems = await lintFromString({ source: JSON.stringify(description), config });
  const told = problems.map(({ ruleId, message, location }) => `${ruleId}: ${message} ${location[0]?.pointer}`);
  assert.deepEqual(told, []);
});

test("every route of the router's table is described, and no other", async () => {
  const lines = await eventually(() => server.stderr.match(/route [A-Z]+ \/\S*/g), 'the table of routes');
  const table = lines.map((line) => line.slice('route '.length).replace('...}', '}')).sort();
  const described = operations.map(({ method, path }) => `${method.toUpperCase()} ${path}`).sort();
  assert.deepEqual(described, table);
});

test('every number says its unit, or has none; every field of a request is limited', () => {
  for (const operation of operations) {
    const json = jsonOf(operation);
    if (!json) continue;
    assert.notEqual(json.example, undefined, `${operation.operationId} has no example`);
    for (const { at, field } of numbers(resolve(json.schema), json.example)) {
      const { outside } = edges(field);
      assert.ok(outside.length > 0 || field.maximum, `${operation.operationId} ${at} has no range`);
    }
  }
});

test('every route answers as it is described', async () => {
  for (const operation of operations) {
    const answer = await succeed(operation);
    const expected = operation.operationId === 'stream' ? answer.status === 426 : answer.status < 300;
    assert.ok(expected, `${operation.operationId}: ${answer.status} ${answer.text.slice(0, 500)}`);
    assertDescribed(operation, answer);
    await server.post('/api/v1/simulation/resume');
  }
});

describe('each class of errors', () => {
  const send = (operation, options) =>
    server.request(operation.method.toUpperCase(), target(operation), options);
  const withStatus = (status) => operations.filter(({ responses }) => responses[status]);

  test('403: a foreign Host', async () => {
    for (const operation of withStatus(403)) {
      const answer = await send(operation, { headers: { host: 'elsewhere.example' } });
      assert.equal(answer.status, 403, operation.operationId);
      assertDescribed(operation, answer);
    }
  });

  test('404: what is not there', async () => {
    for (const operation of withStatus(404)) {
      const names = (operation.parameters ?? []).map(resolve).filter((item) => item.in === 'path');
      const parameters = Object.fromEntries(names.map(({ name }) => [name, '987654321']));
      const answer = await server.request(operation.method.toUpperCase(), target(operation, parameters), {
        body: jsonOf(operation)?.example,
      });
      assert.equal(answer.status, 404, operation.operationId);
      assertDescribed(operation, answer);
    }
  });

  test('405: every other method, with those that are possible', async () => {
    for (const [path, item] of Object.entries(description.paths)) {
      const known = METHODS.filter((method) => item[method]);
      const operation = { path, ...item[known[0]] };
      for (const method of METHODS.filter((name) => !known.includes(name))) {
        const answer = await server.request(method.toUpperCase(), target(operation), { body: '{}' });
        assert.equal(answer.status, 405, `${method} ${path}`);
        const allowed = answer.headers.allow.split(', ').filter((name) => name !== 'HEAD');
        assert.deepEqual(allowed.sort(), known.map((name) => name.toUpperCase()).sort());
      }
    }
  });

  test('400, 413, 415: bodies that are no JSON, too long, of another type', async () => {
    for (const operation of operations.filter(jsonOf)) {
      const json = { 'content-type': 'application/json' };
      const cases = [
        [400, '{"a":', json],
        [400, '{"a":1,"a":1}', json],
        [413, JSON.stringify({ a: 'x'.repeat(1 << 20) }), json],
        [415, 'a: 1', { 'content-type': 'application/yaml' }],
      ];
      for (const [status, body, headers] of cases) {
        const answer = await send(operation, { body, headers });
        assert.equal(answer.status, status, `${operation.operationId} ${answer.text}`);
        assertDescribed(operation, answer);
      }
    }
  });

  test('422: unknown fields, and parameters', async () => {
    for (const operation of withStatus(422)) {
      const example = jsonOf(operation)?.example;
      const { parameters } = operation.operationId === 'getRecordingData' ? await aDoneRecording() : {};
      const answer = example
        ? await send(operation, { body: { ...example, no_such_field: 1 } })
        : await server.request(operation.method.toUpperCase(), `${target(operation, parameters)}?no_such_field=1`,
          operation.operationId === 'uploadRobot' ? form([['urdf', BIPED]]) : {});
      assert.equal(answer.status, 422, `${operation.operationId} ${answer.text}`);
      assertDescribed(operation, answer);
      assert.ok(answer.json.errors.some(({ pointer }) => pointer === '/no_such_field'), answer.text);
    }
  });

  test('422: every number just outside its range; its ends are inside', async () => {
    let tried = 0;
    for (const operation of operations.filter(jsonOf)) {
      const { schema, example } = jsonOf(operation);
      for (const { at, field, put } of numbers(resolve(schema), example)) {
        const { outside, inside } = edges(field);
        for (const value of [...outside, 'text']) {
          const answer = await send(operation, { body: put(value) });
          const named = answer.json.errors?.some(({ pointer }) => pointer === at);
          assert.ok(answer.status === 422 && named, `${operation.operationId} ${at}=${value}: ${answer.text}`);
          ++tried;
        }
        for (const value of inside) {
          const answer = await send(operation, { body: put(value) });
          const named = answer.json.errors?.find(({ pointer }) => pointer === at);
          // Two fields may exclude one another, or be too much together; a range is told otherwise.
          const range = named && !/together|both|in place of|cannot/.test(named.detail);
          assert.ok(!range, `${operation.operationId} ${at}=${value}: ${answer.text}`);
          ++tried;
        }
      }
    }
    assert.ok(tried > 50, `${tried} numbers tried`);
    await server.post('/api/v1/simulation/reset', { plant: 'lipm', terrain: { kind: 'flat' } });
  });
});
