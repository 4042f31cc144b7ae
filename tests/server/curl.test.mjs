// docs/curl.md: its lines run as they stand, and no route of the API is missing there.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import { after, before, test } from 'node:test';
import { Server, eventually, longPatience, root, within } from './support.mjs';

let server;
before(async () => (server = await Server.start('--log-level', 'debug', '--web-dir', `${root}/web/public`)));
after(() => server.end());

async function shell(script) {
  const child = spawn('bash', ['-euo', 'pipefail', '-c', script], {
    cwd: root,
    env: { ...process.env, SERVER: server.url },
    stdio: ['ignore', 'pipe', 'pipe'],
  });
  let output = '';
  child.stdout.on('data', (data) => (output += data));
  child.stderr.on('data', (data) => (output += data));
  const ended = new Promise((resolve) => child.on('close', resolve));
  try {
    // They wait for a campaign.
    return { code: await within(ended, 'the lines of curl', longPatience), output };
  } finally {
    child.kill('SIGKILL');
  }
}

test('every line of docs/curl.md works, and they ask for every route', async () => {
  const text = fs.readFileSync(`${root}/docs/curl.md`, 'utf8');
  const blocks = [...text.matchAll(/```sh\n([\s\S]*?)```/g)].map(([, block]) => block);
  // The first error ends it, as an exit code; and nothing waits for ever.
  const strict = 'curl() { command curl --fail-with-body -sS --noproxy "*" --max-time 60 "$@" || { echo "FAILED: $*" >&2; exit 1; }; }\n';
  await eventually(async () => (await server.get('/ready')).status === 200, 'ready');
  const { code, output } = await shell(strict + blocks.join('\n'));
  assert.equal(code, 0, output.slice(-1000));

  const { paths } = (await server.get('/openapi.json')).json;
  const asked = server.stderr.match(/(GET|POST|PUT|PATCH|DELETE) \/\S* \d{3}$/gm);
  for (const [path, item] of Object.entries(paths)) {
    // A name may be a path: only robots' files are.
    const pattern = path.replace('{path}', '.+').replace(/\{\w+\}/g, '[^/]+');
    for (const [method, { operationId }] of Object.entries(item)) {
      if (operationId === 'stream') continue;
      const line = new RegExp(`^${method.toUpperCase()} ${pattern} 2\\d\\d$`);
      assert.ok(asked.some((found) => line.test(found)), `docs/curl.md does not show ${method} ${path}`);
    }
  }
});
