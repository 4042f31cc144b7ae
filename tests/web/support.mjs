// What the browser tests share: the real server, a real browser, and looking until something is so.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { chromium } from 'playwright-core';
import WebSocket from 'ws';

export const top = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
const binary = path.resolve(top, process.env.STAGGER_BIN ?? 'build/bin/stagger');
const browser = process.env.CHROMIUM ?? '/usr/bin/chromium';

/** Looks until `probe` answers something true, and returns it; else fails with `what`. */
export async function until(probe, what, patienceMs = 30000) {
  const end = Date.now() + patienceMs;
  let last;
  for (;;) {
    try {
      last = await probe();
      if (last) return last;
    } catch (error) {
      last = error;
    }
    if (Date.now() > end) {
      throw new Error(`waited ${patienceMs / 1000} s in vain for: ${what}`, {
        cause: last instanceof Error ? last : undefined,
      });
    }
    await new Promise((resolve) => setTimeout(resolve, 25));
  }
}

/** A `stagger serve` of its own. */
export class Server {
  static async start({ port = 0, plant = 'bullet' } = {}) {
    const child = spawn(binary, ['serve', '--port', String(port), '--plant', plant], {
      cwd: top,
      stdio: ['ignore', 'pipe', 'pipe'],
    });
    const output = { text: '' };
    child.stdout.on('data', (chunk) => (output.text += chunk));
    child.stderr.on('data', (chunk) => (output.text += chunk));
    const failed = new Promise((_, reject) => {
      child.once('error', reject);
      child.once('exit', (code) => reject(new Error(`stagger ended with ${code}: ${output.text}`)));
    });
    failed.catch(() => {});
    const said = until(
      () => /stagger is serving on (http:\/\/[^\s]+)/.exec(output.text)?.[1],
      'the address that stagger serves on',
    );
    return new Server(child, await Promise.race([said, failed]));
  }

  constructor(child, url) {
    this.child = child;
    this.url = url;
    this.port = Number(new URL(url).port);
  }

  async stop(signal = 'SIGTERM') {
    if (this.child.exitCode !== null || this.child.signalCode !== null) return;
    const ended = once(this.child, 'exit');
    this.child.kill(signal);
    const hard = setTimeout(() => this.child.kill('SIGKILL'), 15000);
    await ended;
    clearTimeout(hard);
  }

  async call(method, route, body) {
    const response = await fetch(`${this.url}/api/v1${route}`, {
      method,
      ...(body === undefined
        ? {}
        : { headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(body) }),
    });
    const text = await response.text();
    if (!response.ok) throw new Error(`${method} ${route}: ${response.status} ${text}`);
    return JSON.parse(text);
  }

  simulation() {
    return this.call('GET', '/simulation');
  }

  async pushes() {
    return (await this.call('GET', '/pushes')).items;
  }

  /** The newest frame as the stream tells it to a client of our own; call it while paused. */
  async frame() {
    const socket = new WebSocket(`${this.url.replace('http', 'ws')}/api/v1/stream`);
    try {
      return await new Promise((resolve, reject) => {
        let hello;
        socket.on('error', reject);
        socket.on('close', () => reject(new Error('the stream closed without a frame')));
        socket.on('message', (text) => {
          const message = JSON.parse(text);
          if (message.op === 'hello') {
            hello = message;
            socket.send('{"op":"subscribe","rate_hz":1000}');
          } else if (message.op === 'data') {
            resolve({ hello, ...message });
          }
        });
      });
    } finally {
      socket.removeAllListeners('close');
      socket.terminate();
    }
  }
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
    await dashboard.until((s) => s.condition === 'live' && s.scene?.figure && s.tick !== null, 'a live page');
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
    return until(async () => {
      const state = await this.state();
      return wanted(state) && state;
    }, what);
  }

  text(selector) {
    return this.page.locator(selector).innerText();
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
