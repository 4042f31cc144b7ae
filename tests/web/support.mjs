// What the browser tests share beyond tests/server/support.mjs: the page and the server's side.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import fs from 'node:fs';
import os from 'node:os';
import { createRequire } from 'node:module';
import path from 'node:path';
import { after, afterEach, before, beforeEach } from 'node:test';
import { chromium } from 'playwright-core';
import { Server, binary, eventually, patience, root, within } from '../server/support.mjs';

const axeSource = fs.readFileSync(
  createRequire(import.meta.url).resolve('axe-core/axe.min.js'),
  'utf8',
);
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
  const data = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-data-'));
  const args = ['serve', '--port', String(port), '--plant', 'lipm', '--data', data];
  const child = spawn(binary, args, {
    env: { STAGGER_ROBOTS: `${root}/robots`, ...process.env },
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  await within(once(child.stdout, 'data'), `the server on port ${port}`);
  return async () => {
    const ended = once(child, 'exit');
    child.kill('SIGKILL');
    await ended;
    fs.rmSync(data, { recursive: true, force: true });
  };
}

export function launchBrowser() {
  return chromium.launch({
    executablePath: browser,
    args: [
      '--headless',
      '--no-sandbox',
      // As Chromium does by itself where there is no graphics card: 3D in software, the rest of the page as ever.
      // Asked for with --use-angle, all of the page would be drawn in 3D, four times as slowly.
      '--enable-unsafe-swiftshader',
      '--disable-quic',
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
    ],
  });
}

/**
 * The set-up of a file of tests: one browser and one server of the pendulum for all of them; `open` makes the
 * world of a test of them, and its page. After each test every page that is still open is closed and checked.
 */
export function onPages(open) {
  let browser;
  let server;
  before(async () => {
    browser = await launchBrowser();
    server = await Server.start('--plant', 'lipm');
  });
  after(async () => {
    await browser?.close();
    await server?.kill();
  });
  beforeEach(() => open(browser, server));
  afterEach(() => Dashboard.closeAll());
}

/** Between two drawings of the page [ms]: pictures made without a graphics card take all cores. */
const seldom = 100;

/**
 * The dashboard in a page of its own, with everything that went wrong or elsewhere on record. It is
 * drawn seldom, unless `period` says otherwise, and with a quarter of the pixels, unless it is to be
 * looked at, `sharp`: then as a graphics card draws it.
 */
export class Dashboard {
  static #open = new Set();

  static async open(
    browser,
    url,
    {
      width = 1440,
      height = 900,
      colorScheme = 'light',
      live = true,
      sharp = false,
      scale = sharp ? 1 : 0.5,
      period = seldom,
    } = {},
  ) {
    const viewport = { width, height };
    const context = await browser.newContext({ viewport, colorScheme, deviceScaleFactor: scale });
    const page = await context.newPage();
    const dashboard = new Dashboard(context, page, new URL(url).host);
    Dashboard.#open.add(dashboard);
    await page.addInitScript(({ period, sharp }) => {
      if (sharp) {
        // As with a graphics card: smooth edges and shadows.
        const { getParameter } = WebGL2RenderingContext.prototype;
        const unmaskedRenderer = 0x9246;
        WebGL2RenderingContext.prototype.getParameter = function (name) {
          return name === unmaskedRenderer ? 'a graphics card' : getParameter.call(this, name);
        };
      }
      const nextFrame = window.requestAnimationFrame.bind(window);
      if (period > 0) {
        window.requestAnimationFrame = (draw) => setTimeout(() => nextFrame(draw), period);
      }
      window.violations = [];
      document.addEventListener('securitypolicyviolation', (event) =>
        window.violations.push(`${event.violatedDirective} ${event.blockedURI}`),
      );
    }, { period, sharp });
    // A loaded machine takes its time; nothing here is about speed.
    page.setDefaultTimeout(patience);
    await page.goto(url);
    // The list of robots comes last of what the page asks for at its start, and fills its forms.
    await dashboard.until(
      (s) =>
        (!live || s.condition === 'live') && s.scene?.figure && s.tick !== null && s.robots.listed.length > 0,
      'a live page',
    );
    return dashboard;
  }

  /** What is still open, with its checks. */
  static async closeAll() {
    const ends = await Promise.allSettled([...Dashboard.#open].map((dashboard) => dashboard.close()));
    for (const { reason } of ends) if (reason) throw reason;
  }

  constructor(context, page, host) {
    this.context = context;
    this.page = page;
    this.host = host;
    this.errors = [];
    /** Console errors that the test brings about on purpose. */
    this.expected = [];
    this.hosts = new Set();
    page.on('console', (message) => {
      if (message.type() !== 'error') return;
      this.errors.push(`${message.text()} ${message.location().url}`);
    });
    page.on('pageerror', (error) => this.errors.push(String(error)));
    const seen = (url) => {
      if (!url.startsWith('blob:')) this.hosts.add(new URL(url).host);
    };
    page.on('request', (request) => seen(request.url()));
    page.on('websocket', (socket) => seen(socket.url()));
  }

  /** Nothing may have gone wrong on the page but what was expected, nor gone to another server. */
  async close() {
    Dashboard.#open.delete(this);
    const violations = await this.violations();
    await this.context.close();
    const errors = this.errors.filter((text) => !this.expected.some((known) => known.test(text)));
    assert.deepEqual(errors, [], 'no error on the console');
    assert.deepEqual(violations, [], 'nothing against the Content-Security-Policy');
    assert.deepEqual([...this.hosts], [this.host], 'no host but the server');
  }

  state() {
    return this.page.evaluate(() => window.stagger.scene_state());
  }

  violations() {
    return this.page.evaluate(() => window.violations);
  }

  /** Looks until the drawn state is as wanted, and returns it. */
  async until(wanted, what, ms = patience) {
    let state;
    const look = async () => {
      state = await this.state();
      return wanted(state) && state;
    };
    try {
      return await eventually(look, what, ms);
    } catch (error) {
      const { condition, tick, scene, plots } = state ?? {};
      const { figure, tick: drawn } = scene ?? {};
      const seen = { condition, tick, drawn, figure: figure?.kind, plotted: plots?.drawn_tick };
      error.message += `; at last the page was ${JSON.stringify(seen)}`;
      throw error;
    }
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

  /** Shows one of the panels on the left: push, walk, world. */
  tab(name) {
    return this.click(`#tab-${name}`);
  }

  /** Opens or closes a part of the page that can be folded. */
  async fold(selector, open) {
    const folded = () => this.page.locator(selector).evaluate((details) => !details.open);
    if ((await folded()) === open) await this.click(`${selector} > summary`);
  }

  /** Where the robot's centre of mass is on the page [px]. */
  async robotOnPage() {
    const [x, y] = (await this.state()).scene.com_px;
    const box = await this.page.locator('#scene').boundingBox();
    return { x: box.x + x, y: box.y + y };
  }

  /** What axe-core finds wrong with the page while it has its stream: nothing, or what and where. */
  async axe() {
    await this.page.evaluate(axeSource);
    const dimmed = ['lost', 'connecting'];
    for (;;) {
      await this.until((s) => !dimmed.includes(s.condition), 'the stream');
      // On a busy machine the page may be so long without reading that it loses the stream: then
      // what it shows is dimmed on purpose.
      const { violations, wasDimmed } = await this.page.evaluate(async (dimmed) => {
        const isDimmed = () => dimmed.includes(document.body.dataset.condition);
        let wasDimmed = isDimmed();
        const observer = new MutationObserver(() => (wasDimmed ||= isDimmed()));
        observer.observe(document.body, { attributes: true });
        const { violations } = await window.axe.run();
        observer.disconnect();
        return { violations, wasDimmed: wasDimmed || isDimmed() };
      }, dimmed);
      if (wasDimmed) continue;
      return violations.map(({ id, nodes }) => `${id}: ${nodes.map((n) => n.html).join(' | ')}`);
    }
  }

  /**
   * A click of the mouse in the middle of what can be seen and pressed there. Playwright's own waits
   * for several drawings of the page.
   */
  async click(selector) {
    await eventually(async () => {
      const place = await this.page.evaluate((wanted) => {
        const element = document.querySelector(wanted);
        if (element === null || element.disabled) return null;
        element.scrollIntoView({ block: 'nearest', inline: 'nearest' });
        const { left, top, width, height } = element.getBoundingClientRect();
        const [x, y] = [left + width / 2, top + height / 2];
        if (!element.contains(document.elementFromPoint(x, y))) return null;
        // A list that is made anew, or moves, before the button is let go takes the click away: then there is none, or
        // one on something else. A mouse button that has been let go has made its click, if any, by the next task.
        let landed = false;
        const see = (event) => {
          landed = event.composedPath().some((node) => node instanceof Element && node.matches(wanted));
        };
        document.addEventListener('click', see, { capture: true, once: true });
        window.clicked = new Promise((resolve) => {
          const letGo = () =>
            setTimeout(() => {
              document.removeEventListener('click', see, { capture: true });
              resolve(landed);
            });
          document.addEventListener('mouseup', letGo, { capture: true, once: true });
        });
        return { x, y };
      }, selector);
      if (place === null) return false;
      await this.page.mouse.click(place.x, place.y);
      return this.page.evaluate(() => window.clicked);
    }, `${selector} to be clicked on`);
  }

  fill(selector, value) {
    return this.page.fill(selector, String(value));
  }

  /** What the server says of the simulation: the page may not know it yet. */
  simulation() {
    return this.page.evaluate(async () => (await fetch('api/v1/simulation')).json());
  }

  /**
   * Looks until the page has read what the server says of a running simulation from now on. It asks one question at a
   * time, so that no answer of before is still to come then.
   */
  async informed() {
    const { tick, session_id: session } = await this.simulation();
    await eventually(async () => {
      const facts = await this.page.locator('#facts dd').allTextContents();
      return Number(facts[0]) > tick && facts.at(-1) === session;
    }, `the page to have read a state after tick ${tick}`);
  }

  /** Looks until the page is laid out in that width [px] and nothing sticks out at the side. */
  fits(width) {
    return eventually(
      () => this.page.evaluate((wanted) => document.documentElement.scrollWidth === wanted, width),
      `nothing to stick out of ${width} px`,
    );
  }

  /** The tick of the server's newest frame. */
  async newestTick() {
    return (await this.simulation()).tick - 1; // that is the one to come
  }

  /** Looks until the page is paused and all views have drawn that tick. */
  drawn(tick) {
    return this.until(
      (s) =>
        s.condition === 'paused' &&
        s.tick === tick &&
        s.scene.tick === tick &&
        s.top_view.tick === tick &&
        s.plots.drawn_tick === tick,
      `a paused page that has drawn tick ${tick}`,
    );
  }

  /** Pauses by the page's own button; all views have then drawn the last frame. */
  async pause() {
    if ((await this.simulation()).running) {
      await this.shows('#pause', /^Pause$/);
      await this.click('#pause');
    }
    await this.until((s) => s.condition === 'paused', 'a paused page');
    return this.drawn(await this.newestTick());
  }

  async resume() {
    if (!(await this.simulation()).running) {
      await this.shows('#pause', /^Resume$/);
      await this.click('#pause');
    }
    return this.until((s) => s.condition === 'live', 'a running simulation');
  }

  /** Advances a paused simulation by the page's own button. */
  async step(ticks) {
    const tick = await this.newestTick();
    await this.fill('#step-ticks', ticks);
    await this.click('#step');
    return this.drawn(tick + ticks);
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
