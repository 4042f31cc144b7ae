// Tier 5: the built dashboard in a real browser on the real server.
//   npm ci && node --test web/      in tests/, with web/ and the server built
// STAGGER_BIN, CHROMIUM: other programs than build/bin/stagger and /usr/bin/chromium.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { gzipSync } from 'node:zlib';
import { after, afterEach, before, beforeEach, describe, test } from 'node:test';
import { Server, eventually, patience, root } from '../server/support.mjs';
import { Dashboard, call, launchBrowser, newestFrame, pushes, serveOnPort } from './support.mjs';

let browser;

before(async () => {
  browser = await launchBrowser();
});

after(() => browser?.close());

function assertNear(actual, expected, tolerance, what) {
  assert.equal(actual.length, expected.length, what);
  actual.forEach((value, i) => {
    assert.ok(
      Math.abs(value - expected[i]) <= tolerance,
      `${what}[${i}] is ${value}, expected ${expected[i]} within ${tolerance}`,
    );
  });
}

/** Numbers of a channel by component, e.g. joint angles by joint. */
function byComponent(frame, name) {
  const channel = frame.hello.channels.find((candidate) => candidate.name === name);
  return Object.fromEntries(channel.components.map(({ name: key }, i) => [key, frame.v[name][i]]));
}

test('all of the page together is at most 350 kB, compressed', () => {
  const dist = path.join(root, 'web', 'dist');
  const names = fs.readdirSync(dist, { recursive: true }).map((name) => path.join(dist, name));
  const files = names.filter((name) => fs.statSync(name).isFile());
  const bytes = files.map((file) => gzipSync(fs.readFileSync(file)).length);
  const sum = bytes.reduce((total, one) => total + one, 0);
  assert.ok(files.length > 3 && sum <= 350_000, `${sum} bytes in ${files.length} files`);
});

describe('dashboard', () => {
  let server;
  let page;

  before(async () => {
    server = await Server.start('--plant', 'bullet');
  });

  after(() => server?.kill());

  beforeEach(async () => {
    await call(server, 'POST', '/simulation/reset', { plant: 'bullet' });
    await call(server, 'PATCH', '/strategies', { ankle: true, step: true, time: true });
    await call(server, 'POST', '/simulation/resume', {});
    await call(server, 'POST', '/walk', { vx: 0, vy: 0, wz: 0 });
    page = await Dashboard.open(browser, server.url);
  });

  afterEach(() => Dashboard.closeAll());

  test('loads, says that it is live and whom it shows', async () => {
    await page.shows('#condition-text', /^Live$/);
    await page.shows('#bar-robot', /^kasaei, full body$/);
    await page.shows('#bar-speed', /×$/);
    assert.equal(await page.page.title(), 'Live · stagger');
    const robot = await call(server, 'GET', '/robots/kasaei');
    const links = await page.page.locator('#link option').allTextContents();
    assert.deepEqual(links, robot.links);
    assert.equal(await page.page.locator('#link').inputValue(), 'torso');
  });

  test('poses the robot exactly as the stream says, and goes on doing so', async () => {
    const postures = [];
    for (let i = 0; i < 2; i += 1) {
      const state = await page.pause();
      const frame = await newestFrame(server);
      assert.equal(state.scene.tick, frame.tick, 'the drawn frame is the newest one');
      const { figure } = state.scene;
      assert.equal(figure.kind, 'urdf');
      assert.ok(figure.meshes >= 14, `${figure.meshes} meshes for 14 links`);
      assert.deepEqual(figure.joints, byComponent(frame, 'joint_position'));
      assertNear(figure.base_position, frame.v.base_position, 1e-9, 'base position');
      assertNear(figure.base_orientation, frame.v.base_orientation, 1e-6, 'base orientation');
      // The feet come out of base and joints alone: they stand where the plant says they stand.
      const { left_foot: left, right_foot: right } = figure.links;
      assertNear(left.slice(0, 2), frame.v.left_foot.slice(0, 2), 0.03, 'left foot');
      assertNear(right.slice(0, 2), frame.v.right_foot.slice(0, 2), 0.03, 'right foot');
      postures.push(figure.joints.left_knee);
      await page.resume();
      const { t } = await page.state();
      await page.until((s) => s.t > t + 0.3, '0.3 s more');
    }
    assert.notEqual(postures[0], postures[1], 'the robot moves');
    assert.ok((await page.colours('#scene')) > 50, 'the 3D view shows something');
  });

  test('top view, plots and table show the numbers of the stream', async () => {
    await page.until((s) => s.plots.points > 100 && s.top_view.adjusted_step, 'a second of data');
    const state = await page.pause();
    const frame = await newestFrame(server);
    const { top_view: view, plots } = state;
    for (const [name, mark] of Object.entries(view.marks)) {
      assert.deepEqual([mark.x, mark.y], frame.v[name].slice(0, 2), name);
    }
    const { left, right } = view.feet;
    const flat = ([x, y, , yaw]) => [x, y, yaw];
    assert.deepEqual([left.x, left.y, left.yaw], flat(frame.v.left_foot));
    assert.deepEqual([right.x, right.y, right.yaw], flat(frame.v.right_foot));
    const { adjusted_step: step } = view;
    assert.deepEqual([step.x, step.y, step.yaw, step.side], frame.v.adjusted_step);
    assert.deepEqual(
      view.support_polygon.flatMap(({ x, y }) => [x, y]),
      frame.v.support_polygon,
    );
    // World x goes up the canvas and y to the left.
    const { dcm } = view.marks;
    const px = view.marks_px.dcm;
    assert.ok(
      Math.abs(px.x - (view.width / 2 - (dcm.y - view.centre.y) * view.pixels_per_metre)) < 1e-6,
    );
    assert.ok(
      Math.abs(px.y - (view.height / 2 - (dcm.x - view.centre.x) * view.pixels_per_metre)) < 1e-6,
    );

    assert.equal(plots.last.dcm_x, frame.v.dcm[0]);
    assert.equal(plots.last.dcm_reference_y, frame.v.dcm_reference[1]);
    assert.equal(plots.last.zmp_y, frame.v.zmp[1]);
    assert.equal(plots.last.com_x, frame.v.com[0]);
    const [dx, dy] = [0, 1].map((i) => frame.v.dcm[i] - frame.v.dcm_reference[i]);
    assert.ok(Math.abs(plots.last.dcm_error - Math.hypot(dx, dy)) < 1e-15);
    assert.ok(plots.points <= plots.capacity);

    const row = page.page.locator('#values tr', { hasText: 'DCM' });
    const shown = (value) =>
      value
        .toFixed(3)
        .replace(/^-0\.000$/, '0.000')
        .replace('-', '−');
    await eventually(
      async () =>
        (await row.innerText()).split(/\s+/).slice(1).join() ===
        [...frame.v.dcm, ...frame.v.dcm_reference].map(shown).join(),
      'the DCM in the value table',
    );
    assert.ok((await page.colours('#top-view')) > 20, 'the view from above shows something');
    assert.ok((await page.colours('.plot-dcm_y')) > 10, 'the plot shows something');
  });

  test('a push by button is the push that was chosen, and moves the DCM', async () => {
    await page.until((s) => s.top_view.adjusted_step, 'the robot to step');
    await page.pause();
    await page.fill('#impulse', 6.5);
    await page.fold('#push-details', true);
    await page.fill('#duration', 0.05);
    await page.shows('#push-equals', /^130 N peak\s+·\s+Δv 0\.22 m\/s$/);
    await page.click('.pad-forward');
    const [push] = await eventually(async () => {
      const asked = await pushes(server);
      return asked.length === 1 && asked;
    }, 'the push on the server');
    assert.equal(push.spec.impulse_ns, 6.5);
    assert.equal(push.spec.duration_s, 0.05);
    assert.equal(push.spec.link, 'torso');
    assert.deepEqual(push.spec.direction, [1, 0, 0]);
    assert.equal(push.start_tick, null, 'a paused simulation has not pushed yet');
    await page.until((s) => s.pushes.listed[0]?.state === 'scheduled', 'the push on the list');

    // All at once, so that nothing but the push has had time to move the DCM.
    const before = await newestFrame(server);
    const during = await page.step(25);
    assert.equal(during.top_view.push_arrow, true);
    assert.ok(Math.hypot(...during.scene.push_arrow.force_n) > 100, 'the arrow shows the force');
    await page.shows('#push-label', /^130 N$/);
    const state = await page.step(35);
    const shift = state.top_view.marks.dcm.x - before.v.dcm[0];
    assert.ok(shift > 0.03, `the DCM went forward by ${shift} m`);
    assert.equal(state.scene.push_arrow, null, 'no arrow without a force');
    assert.ok(state.plots.markers > 0, 'the plots mark the push');

    const done = await call(server, 'GET', `/pushes/${push.id}`);
    assert.equal(done.state, 'done');
    assert.ok(Math.abs(Math.hypot(...done.delivered_ns) - 6.5) < 1e-6);
    await page.shows('#pushes', /6\.5 N s forward\s+done\s+6\.50 N s/);
    await page.shows('#events', /push 1/);
  });

  test('an arrow key pushes, but not while typing', async () => {
    await page.pause();
    await page.fill('#impulse', 4);
    await page.page.press('#impulse', 'ArrowUp');
    assert.equal(await page.page.inputValue('#impulse'), '5', 'the arrow changed the number');
    await page.page.locator('#impulse').blur();
    await page.page.keyboard.press('ArrowLeft');
    const first = await eventually(async () => (await pushes(server))[0], 'a push by arrow key');
    assert.deepEqual(first.spec.direction, [0, 1, 0]);
    assert.equal(first.spec.impulse_ns, 5);
    await page.page.uncheck('#arrow-keys');
    await page.page.keyboard.press('ArrowDown');
    await page.page.check('#arrow-keys');
    await page.page.keyboard.press('ArrowRight');
    const asked = await eventually(async () => {
      const now = await pushes(server);
      return now.length > 1 && now;
    }, 'a second push');
    assert.deepEqual(
      asked.map((push) => push.spec.direction),
      [
        [0, -1, 0],
        [0, 1, 0],
      ],
      'no push while typing, none while switched off',
    );
  });

  test('a push can wait for its phase and be cancelled', async () => {
    await page.pause();
    await page.fold('#push-details', true);
    await page.page.selectOption('#trigger', 'single_support left');
    await page.fill('#fraction', 0.25);
    await page.page.selectOption('#profile', 'half_sine');
    await page.fill('#angle', 30);
    await page.click('#push-angle');
    const push = await eventually(async () => (await pushes(server))[0], 'the push on the server');
    assert.deepEqual(push.spec.trigger, { phase: 'single_support', leg: 'left', fraction: 0.25 });
    assert.equal(push.spec.profile, 'half_sine');
    assertNear(push.spec.direction, [Math.cos(Math.PI / 6), 0.5, 0], 1e-12, 'direction');
    await page.click('#pushes button');
    await eventually(
      async () => (await pushes(server))[0].state === 'cancelled',
      'the push to be cancelled',
    );
    await page.shows('#pushes', /cancelled/);
  });

  test('says what is wrong with a push that is out of range', async () => {
    page.expected.push(/status of 422/);
    await page.fill('#impulse', 999);
    await page.click('.pad-backward');
    await page.shows('#push-error', /impulse_ns.*999.*200 N s/s);
    assert.deepEqual(await pushes(server), []);
    await page.fill('#impulse', '');
    await page.click('.pad-backward');
    await page.shows('#push-error', /impulse is not a number/);
    await page.fill('#impulse', 1);
    await page.click('.pad-backward');
    // The words of what went wrong go at the press, before the server has been asked.
    await page.shows('#push-answer', /^Push 1: 1 N s backward/);
    await page.shows('#push-error', /^$/);
    assert.equal((await pushes(server)).length, 1);
  });

  test('pauses, steps, resumes and resets', async () => {
    const paused = await page.pause();
    assert.equal((await server.state()).running, false);
    await page.shows('#condition-text', /^Paused$/);
    const stepped = await page.step(37);
    assert.equal(stepped.tick, paused.tick + 37);
    assert.equal((await newestFrame(server)).tick, stepped.tick);
    await page.resume();
    assert.equal((await server.state()).running, true);
    await page.until((s) => s.tick > stepped.tick, 'time to go on');

    // Paused, so that the new time does not go on while it is looked at.
    const { session_id: session } = await page.pause();
    await page.click('#reset');
    const reset = await page.until(
      (s) => s.session_id !== session && s.tick !== null,
      'a new session',
    );
    assert.equal(reset.session_id, (await server.state()).session_id);
    assert.equal(reset.tick, 0, 'time starts anew');
    assert.ok(reset.plots.window[0] === 0, 'the plots are cleared');
  });

  test('walks, stops and switches strategies', async () => {
    await page.tab('walk');
    await page.click('#walk-stop');
    await eventually(async () => !(await server.state()).walking, 'the robot to stand');
    await page.click('#walk-in-place');
    await eventually(async () => (await server.state()).walking, 'the robot to walk');
    await page.fill('#vx', 0.1);
    await page.click('#walk-form button');
    const { top_view: start } = await page.state();
    await page.until((s) => s.top_view.centre.x > start.centre.x + 0.1, '10 cm of way');

    await page.tab('tuning');
    await page.page.uncheck('#strategy-step');
    await eventually(
      async () => (await server.state()).strategies.step === false,
      'the step strategy to be off',
    );
    // The server may have it before its answer is back on the page, which then sets the switch by what it knew.
    await page.click('#strategy-step');
    await eventually(
      async () => (await server.state()).strategies.step === true,
      'the step strategy to be on',
    );
  });

  test('shows the pendulum on the LIPM and the body again', async () => {
    await page.tab('world');
    await page.page.selectOption('#plant', 'lipm');
    await page.click('#reset-form button');
    await page.until((s) => s.scene.figure?.kind === 'pendulum', 'the pendulum');
    await page.tab('walk');
    await page.click('#walk-in-place');
    await page.until((s) => s.top_view.adjusted_step, 'the pendulum to step');
    const { scene } = await page.pause();
    const frame = await newestFrame(server);
    assert.equal(scene.tick, frame.tick);
    assertNear(scene.figure.com, frame.v.com, 1e-12, 'CoM');
    assertNear(scene.figure.leg_foot.slice(0, 2), frame.v.zmp, 1e-12, 'foot of the leg');
    assertNear(scene.figure.left_foot, frame.v.left_foot, 1e-12, 'left foot');
    await page.resume();
    await page.tab('world');
    await page.page.selectOption('#plant', 'bullet');
    await page.click('#reset-form button');
    await page.until((s) => s.scene.figure?.kind === 'urdf', 'the body');
  });

  test('says that the robot has fallen and why, and gets it up again', async () => {
    await page.fill('#impulse', 120);
    await page.click('.pad-left');
    await page.until((s) => s.condition === 'fallen', 'the fall');
    // The frame of the fall goes out before the state is told.
    const reason = await eventually(async () => (await server.state()).fall_reason, 'the fall on the server');
    await eventually(
      async () => (await page.text('#fall-banner')).includes(reason),
      'the reason of the fall',
    );
    await page.click('#fall-reset');
    await page.until((s) => s.condition === 'live', 'a live page after the reset');
    await eventually(() => page.page.locator('#fall-banner').isHidden(), 'the banner to go');
  });

  test('can be used on a phone; every control has a name', async () => {
    await page.page.setViewportSize({ width: 360, height: 740 });
    await page.fits(360);
    await page.fill('#impulse', 3);
    await page.click('.pad-right');
    await eventually(async () => (await pushes(server)).length === 1, 'a push on the phone');
    const nameless = await page.page.evaluate(() =>
      [...document.querySelectorAll('button, input, select, [role=img], canvas')]
        .filter((control) => control.parentElement.closest('[role=img]') === null)
        .filter((control) => {
          const name =
            control.getAttribute('aria-label') ??
            (control.labels?.length ? control.labels[0].textContent : control.textContent);
          return name.trim() === '';
        })
        .map((control) => control.outerHTML),
    );
    assert.deepEqual(nameless, []);
  });

  test('looks as the README shows it', async () => {
    await page.close();
    page = await Dashboard.open(browser, server.url);
    await page.until((s) => s.t > 3, 'a few steps');
    await page.fill('#impulse', 6);
    await page.click('.pad-left');
    const { t: pushed } = await page.until((s) => s.pushes.listed[0]?.state === 'done', 'the push');
    await page.until((s) => s.t > Math.max(7.5, pushed + 3), 'the recovery');
    await page.pause();
    await page.fill('#impulse', 12);
    await page.fold('#push-details', true);
    await page.fill('#duration', 0.4);
    await page.fold('#push-details', false);
    await page.click('.pad-forward');
    await page.until((s) => s.pushes.listed.length === 2, 'the second push');
    const state = await page.step(360);
    assert.ok(state.scene.push_arrow !== null, 'the arrow is in the picture');
    const { delivered_ns: delivered } = (await pushes(server))[0];
    const sum = `active\\s+${Math.hypot(...delivered).toFixed(2)} N s`;
    await page.shows('#pushes', new RegExp(sum));
    const png = await page.page.screenshot();
    assert.ok(png.length > 30000, `a picture of ${png.length} bytes`);
  });
});

describe('connection', () => {
  let server;
  let page;
  let endSecond;

  beforeEach(async () => {
    endSecond = async () => {};
    server = await Server.start('--plant', 'lipm');
    page = await Dashboard.open(browser, server.url);
    // The second is what becomes of a question that is under way when the server is killed.
    page.expected.push(/ERR_CONNECTION_|ERR_EMPTY_RESPONSE|WebSocket/);
  });

  afterEach(async () => {
    try {
      await Dashboard.closeAll();
    } finally {
      await server?.kill();
      await endSecond();
    }
  });

  const lost = () => page.shows('#condition-text', /^Lost: .*Reconnecting in \d+ s$/);

  test('is told to be lost when the server is killed, and comes back by itself', async () => {
    const { session_id: session } = await page.state();
    await server.kill();
    await lost();
    await eventually(() => page.page.locator('#stale').isVisible(), 'the words for an old picture');
    assert.equal(await page.page.locator('#pause').isDisabled(), true);

    endSecond = await serveOnPort(server.port);
    const state = await page.until((s) => s.condition === 'live' && s.tick > 0, 'a live page');
    assert.notEqual(state.session_id, session);
    assert.equal(state.session_id, (await server.state()).session_id);
    await page.shows('#condition-text', /^Live$/);
    await page.until((s) => s.tick > state.tick, 'frames of the new server');
  });

  test('is told to be lost when the server stops in good order', async () => {
    await server.stop();
    await lost();
  });
});

describe('with a key', () => {
  const key = 'the-key-of-this-page';
  let server;

  before(async () => {
    server = await Server.startWith({ STAGGER_API_KEY: key }, '--plant', 'bullet');
  });

  after(() => server?.kill());

  test('asks for it, goes live with it, and keeps it for this tab alone', async () => {
    const context = await browser.newContext();
    context.setDefaultTimeout(patience);
    const page = await context.newPage();
    // With a key the page starts over: it cannot be asked anything while it goes.
    const submit = () => Promise.all([page.waitForEvent('load'), page.click('#key-form button')]);
    const urls = [];
    page.on('request', (request) => urls.push(request.url()));
    page.on('websocket', (socket) => urls.push(socket.url()));
    try {
      await page.goto(server.url);
      await page.waitForSelector('#key-dialog[open]');
      await page.fill('#key', 'not-the-key-at-all');
      await submit();
      await eventually(
        async () => /does not take/.test(await page.locator('#key-error').textContent()),
        'the wrong key to be refused',
      );
      await page.fill('#key', key);
      await submit();
      await eventually(
        () =>
          page.evaluate(() => {
            const state = window.stagger?.scene_state();
            return state?.condition === 'live' && state.scene?.figure !== null;
          }),
        'a live page',
      );
      assert.ok(!urls.some((url) => url.includes(key)), 'the key is in no address');
      assert.equal(await page.evaluate(() => window.localStorage.length), 0);
      const other = await context.newPage();
      await other.goto(server.url);
      await other.waitForSelector('#key-dialog[open]');
    } finally {
      await context.close();
    }
  });
});
