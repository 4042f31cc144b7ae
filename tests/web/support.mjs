// What the browser tests share beyond tests/server/support.mjs: the page and the server's side.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { chromium } from 'playwright-core';
import { binary, eventually, root, within } from '../server/support.mjs';

const browser = process.env.CHROMIUM ?? '/usr/bin/chromium';

/** One request that must work; the JSON of its answer. */
export async function call(server, method, route, body) {
  const answer = await server.request(method, `/api/v1${route}`, { body });
  assert.ok(answer.status < 300, `${method} ${route}: ${answer.status} ${answer.text}`);
  return answer.json;
}

export async function pushes(server) {
  return (await call(server, 'GET', '/pushes')).items;
}

/** The newest frame as a client of our own is told it, with the hello; for a paused simulation. */
export async function newestFrame(server) {
  const stream = await server.stream();
  try {
    await stream.subscribe({ rate_hz: 1000 });
    const hello = await stream.first(({ op }) => op === 'hello', 'hello');
    return { hello, ...(await stream.first(({ op }) => op === 'data', 'a frame')) };
  } finally {
    await stream.close();
  }
}

/** A server on a port that has been free a moment ago; returns what ends it. */
export async function serveOnPort(port) {
  const child = spawn(binary, ['serve', '--port', String(port), '--plant', 'lipm'], {
    env: { STAGGER_ROBOTS: `${root}/robots`, ...process.env },
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  await within(once(child.stdout, 'data'), `the server on port ${port}`);
  return async () => {
    const ended = once(child, 'exit');
    child.kill('SIGKILL');
    await ended;
  };
}

export function launchBrowser() {
  return chromium.launch({
    executablePath: browser,
    args: [
      '--headless',
      '--no-sandbox',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--ignore-gpu-blocklist',
      '--disable-quic',
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
    ],
  });
}

/** The dashboard in a page of its own, with everything that went wrong or elsewhere on record. */
export class Dashboard {
  static async open(browser, url, { width = 1440, height = 900 } = {}) {
    const context = await browser.newContext({ viewport: { width, height }, colorScheme: 'light' });
    const page = await context.newPage();
    const dashboard = new Dashboard(context, page);
    await page.addInitScript(() => {
      window.violations = [];
      document.addEventListener('securitypolicyviolation', (event) =>
        window.violations.push(`${event.violatedDirective} ${event.blockedURI}`),
      );
    });
    await page.goto(url);
    await dashboard.until(
      (s) => s.condition === 'live' && s.scene?.figure && s.tick !== null,
      'a live page',
    );
    return dashboard;
  }

  constructor(context, page) {
    this.context = context;
    this.page = page;
    this.errors = [];
    this.hosts = new Set();
    page.on('console', (message) => {
      if (message.type() === 'error') this.errors.push(message.text());
    });
    page.on('pageerror', (error) => this.errors.push(String(error)));
    const seen = (url) => {
      if (!url.startsWith('blob:')) this.hosts.add(new URL(url).host);
    };
    page.on('request', (request) => seen(request.url()));
    page.on('websocket', (socket) => seen(socket.url()));
  }

  close() {
    return this.context.close();
  }

  state() {
    return this.page.evaluate(() => window.stagger.scene_state());
  }

  violations() {
    return this.page.evaluate(() => window.violations);
  }

  /** Looks until the drawn state is as wanted, and returns it. */
  until(wanted, what) {
    return eventually(async () => {
      const state = await this.state();
      return wanted(state) && state;
    }, what);
  }

  text(selector) {
    return this.page.locator(selector).innerText();
  }

  /** Looks until an element's text is as wanted: the page writes it with the next frame. */
  shows(selector, wanted) {
    return eventually(
      async () => wanted.test(await this.text(selector)),
      `${selector} to show ${wanted}`,
    );
  }

  click(selector) {
    return this.page.click(selector);
  }

  fill(selector, value) {
    return this.page.fill(selector, String(value));
  }

  /** Pauses by the page's own button; all views have then drawn the last frame. */
  async pause() {
    if ((await this.text('#pause')) === 'Pause') await this.click('#pause');
    return this.until(
      (s) =>
        s.condition === 'paused' &&
        s.scene.tick === s.tick &&
        s.top_view.tick === s.tick &&
        s.plots.drawn_tick === s.tick,
      'a paused page with everything drawn',
    );
  }

  async resume() {
    if ((await this.text('#pause')) === 'Resume') await this.click('#pause');
    return this.until((s) => s.condition === 'live', 'a running simulation');
  }

  /** Advances a paused simulation by the page's own button. */
  async step(ticks) {
    const { tick } = await this.state();
    await this.fill('#step-ticks', ticks);
    await this.click('#step');
    return this.until(
      (s) =>
        s.tick === tick + ticks &&
        s.scene.tick === s.tick &&
        s.top_view.tick === s.tick &&
        s.plots.drawn_tick === s.tick,
      `${ticks} ticks after ${tick}`,
    );
  }

  /** How many colours a picture of an element has: an empty canvas has one. */
  async colours(selector) {
    const png = (await this.page.locator(selector).screenshot()).toString('base64');
    const blank = await this.context.newPage();
    try {
      return await blank.evaluate(async (base64) => {
        const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
        const canvas = new OffscreenCanvas(image.width, image.height);
        const context = canvas.getContext('2d');
        context.drawImage(image, 0, 0);
        const { data } = context.getImageData(0, 0, image.width, image.height);
        return new Set(new Uint32Array(data.buffer)).size;
      }, png);
    } finally {
      await blank.close();
    }
  }
}
