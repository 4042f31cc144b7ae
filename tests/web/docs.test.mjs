// The page of the API's documentation: everything of /openapi.json is on it, and nothing comes from elsewhere.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Server, patience, root } from '../server/support.mjs';
import { launchBrowser } from './support.mjs';

let server;
let browser;
before(async () => {
  server = await Server.start('--web-dir', `${root}/web/public`);
  browser = await launchBrowser();
});
after(async () => {
  await browser?.close();
  await server?.end();
});

test('every route is on the page, with its fields, ranges and units', async () => {
  const page = await browser.newPage();
  page.setDefaultTimeout(patience);
  const wrong = [];
  page.on('console', (message) => message.type() === 'error' && wrong.push(message.text()));
  page.on('pageerror', (error) => wrong.push(String(error)));
  page.on('request', (request) => request.url().startsWith(server.url) || wrong.push(request.url()));
  await page.goto(`${server.url}/docs`);
  await page.waitForSelector('main[aria-busy="false"]');
  const { paths } = (await server.get('/openapi.json')).json;
  const operations = Object.values(paths).flatMap((item) => Object.values(item));
  const ids = operations.map(({ operationId }) => operationId).sort();
  const shown = await page.$$eval('main section', (list) => list.map(({ id }) => id));
  assert.deepEqual(shown.sort(), ids);
  const push = await page.$eval('#createPush', (section) => section.textContent);
  for (const text of ['impulse_ns', 'N s', 'more than 0 to 200', 'trigger.fraction', 'half_sine']) {
    assert.ok(push.includes(text), `${text}: ${push.slice(0, 500)}`);
  }
  assert.deepEqual(wrong, []);
});
