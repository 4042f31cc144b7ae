// Tier 5: the built dashboard in a real browser on the real server.
//   npm ci && node --test web/      in tests/, with web/ and the server built
// STAGGER_BIN, CHROMIUM: other programs than build/bin/stagger and /usr/bin/chromium.
// STAGGER_SCREENSHOT=1: writes docs/dashboard.png.
import assert from 'node:assert/strict';
import { after, afterEach, before, beforeEach, describe, test } from 'node:test';
import path from 'node:path';
import { Dashboard, Server, launchBrowser, top, until } from './support.mjs';

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

describe('dashboard', () => {
  let server;
  let page;
  /** Console errors that the test at hand brings about on purpose. */
  let expected;

  before(async () => {
    server = await Server.start();
  });

  after(() => server?.stop());

  beforeEach(async () => {
    expected = [];
    await server.call('POST', '/simulation/reset', { plant: 'bullet' });
    await server.call('PATCH', '/strategies', { ankle: true, step: true });
    await server.call('POST', '/simulation/resume', {});
    await server.call('POST', '/walk', { vx: 0, vy: 0, wz: 0 });
    page = await Dashboard.open(browser, server.url);
  });

  afterEach(async () => {
    const violations = await page.violations();
    const { hosts } = page;
    const errors = page.errors.filter((text) => !expected.some((pattern) => pattern.test(text)));
    await page.close();
    assert.deepEqual(errors, [], 'no error on the console');
    assert.deepEqual(violations, [], 'nothing against the Content-Security-Policy');
    assert.deepEqual([...hosts], [new URL(server.url).host], 'no host but the server');
  });

  test('loads, says that it is live and whom it shows', async () => {
    assert.equal(await page.text('#condition-text'), 'Live');
    assert.match(await page.text('#bar-robot'), /^kasaei, full body$/);
    await until(async () => /×$/.test(await page.text('#bar-speed')), 'the real-time factor');
    assert.match(await page.page.title(), /^Live · stagger$/);
    const robot = await server.call('GET', '/robots/kasaei');
    const links = await page.page.locator('#link option').allInnerTexts();
    assert.deepEqual(links, robot.links);
    assert.equal(await page.page.locator('#link').inputValue(), 'torso');
  });

  test('poses the robot exactly as the stream says, and goes on doing so', async () => {
    const postures = [];
    for (let i = 0; i < 2; i += 1) {
      const state = await page.pause();
      const frame = await server.frame();
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
    const frame = await server.frame();
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
    const shown = (value) => value.toFixed(3).replace(/^-0\.000$/, '0.000').replace('-', '−');
    await until(
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
    await page.fill('#duration', 0.05);
    assert.match(await page.text('#push-equals'), /^130 N peak\s+·\s+Δv 0\.22 m\/s$/);
    await page.click('.pad-forward');
    const [push] = await until(async () => {
      const pushes = await server.pushes();
      return pushes.length === 1 && pushes;
    }, 'the push on the server');
    assert.equal(push.spec.impulse_ns, 6.5);
    assert.equal(push.spec.duration_s, 0.05);
    assert.equal(push.spec.link, 'torso');
    assert.deepEqual(push.spec.direction, [1, 0, 0]);
    assert.equal(push.start_tick, null, 'a paused simulation has not pushed yet');
    await page.until((s) => s.pushes.listed[0]?.state === 'scheduled', 'the push on the list');

    // All at once, so that nothing but the push has had time to move the DCM.
    const before = await server.frame();
    const during = await page.step(25);
    assert.equal(during.top_view.push_arrow, true);
    assert.ok(Math.hypot(...during.scene.push_arrow.force_n) > 100, 'the arrow shows the force');
    assert.match(await page.text('#push-label'), /^130 N$/);
    const state = await page.step(35);
    const shift = state.top_view.marks.dcm.x - before.v.dcm[0];
    assert.ok(shift > 0.03, `the DCM went forward by ${shift} m`);
    assert.equal(state.scene.push_arrow, null, 'no arrow without a force');
    assert.ok(state.plots.markers > 0, 'the plots mark the push');

    const done = await server.call('GET', `/pushes/${push.id}`);
    assert.equal(done.state, 'done');
    assert.ok(Math.abs(Math.hypot(...done.delivered_ns) - 6.5) < 1e-6);
    await until(
      async () => /6\.5 N s forward\s+done\s+6\.50 N s/.test(await page.text('#pushes')),
      'the delivered impulse on the list',
    );
    await until(async () => /push 1/.test(await page.text('#events')), 'the push in the event log');
  });

  test('an arrow key pushes, but not while typing', async () => {
    await page.pause();
    await page.fill('#impulse', 4);
    await page.page.press('#impulse', 'ArrowUp');
    assert.equal(await page.page.inputValue('#impulse'), '5', 'the arrow changed the number');
    await page.page.locator('#impulse').blur();
    await page.page.keyboard.press('ArrowLeft');
    const first = await until(async () => (await server.pushes())[0], 'a push by arrow key');
    assert.deepEqual(first.spec.direction, [0, 1, 0]);
    assert.equal(first.spec.impulse_ns, 5);
    await page.page.uncheck('#arrow-keys');
    await page.page.keyboard.press('ArrowDown');
    await page.page.check('#arrow-keys');
    await page.page.keyboard.press('ArrowRight');
    const pushes = await until(async () => {
      const now = await server.pushes();
      return now.length > 1 && now;
    }, 'a second push');
    assert.deepEqual(
      pushes.map((push) => push.spec.direction),
      [
        [0, -1, 0],
        [0, 1, 0],
      ],
      'no push while typing, none while switched off',
    );
  });

  test('a push can wait for its phase and be cancelled', async () => {
    await page.pause();
    await page.click('summary');
    await page.page.selectOption('#trigger', 'single_support left');
    await page.fill('#fraction', 0.25);
    await page.page.selectOption('#profile', 'half_sine');
    await page.fill('#angle', 30);
    await page.click('#push-angle');
    const push = await until(async () => (await server.pushes())[0], 'the push on the server');
    assert.deepEqual(push.spec.trigger, { phase: 'single_support', leg: 'left', fraction: 0.25 });
    assert.equal(push.spec.profile, 'half_sine');
    assertNear(push.spec.direction, [Math.cos(Math.PI / 6), 0.5, 0], 1e-12, 'direction');
    await page.click('#pushes button');
    await until(
      async () => (await server.pushes())[0].state === 'cancelled',
      'the push to be cancelled',
    );
    await until(async () => /cancelled/.test(await page.text('#pushes')), 'cancelled on the list');
  });

  test('says what is wrong with a push that is out of range', async () => {
    expected = [/status of 422/];
    await page.fill('#impulse', 999);
    await page.click('.pad-backward');
    await until(
      async () => /impulse_ns.*999.*200 N s/s.test(await page.text('#push-error')),
      'the error beside the pad',
    );
    assert.deepEqual(await server.pushes(), []);
    await page.fill('#impulse', '');
    await page.click('.pad-backward');
    await until(
      async () => /impulse is not a number/.test(await page.text('#push-error')),
      'the words for an empty field',
    );
    await page.fill('#impulse', 1);
    await page.click('.pad-backward');
    await until(async () => (await page.text('#push-error')) === '', 'the error to go');
    assert.equal((await server.pushes()).length, 1);
  });

  test('pauses, steps, resumes and resets', async () => {
    const paused = await page.pause();
    assert.equal((await server.simulation()).running, false);
    assert.equal(await page.text('#condition-text'), 'Paused');
    const stepped = await page.step(37);
    assert.equal(stepped.tick, paused.tick + 37);
    assert.equal((await server.frame()).tick, stepped.tick);
    await page.resume();
    assert.equal((await server.simulation()).running, true);
    await page.until((s) => s.tick > stepped.tick, 'time to go on');

    const { session_id: session } = await page.state();
    await page.click('#reset');
    const reset = await page.until(
      (s) => s.session_id !== session && s.tick !== null,
      'a new session',
    );
    assert.equal(reset.session_id, (await server.simulation()).session_id);
    assert.ok(reset.t < stepped.t, 'time starts anew');
    assert.ok(reset.plots.window[0] === 0, 'the plots are cleared');
  });

  test('walks, stops and switches strategies', async () => {
    await page.click('#walk-stop');
    await until(async () => !(await server.simulation()).walking, 'the robot to stand');
    await page.click('#walk-in-place');
    await until(async () => (await server.simulation()).walking, 'the robot to walk');
    await page.fill('#vx', 0.1);
    await page.click('#walk-form button');
    const { top_view: start } = await page.state();
    await page.until((s) => s.top_view.centre.x > start.centre.x + 0.1, '10 cm of way');

    await page.page.uncheck('#strategy-step');
    await until(
      async () => (await server.simulation()).strategies.step === false,
      'the step strategy to be off',
    );
    await page.page.check('#strategy-step');
    await until(
      async () => (await server.simulation()).strategies.step === true,
      'the step strategy to be on',
    );
  });

  test('shows the pendulum on the LIPM and the body again', async () => {
    await page.page.selectOption('#plant', 'lipm');
    await page.click('#reset-form button');
    await page.until((s) => s.scene.figure?.kind === 'pendulum', 'the pendulum');
    await page.click('#walk-in-place');
    await page.until((s) => s.top_view.adjusted_step, 'the pendulum to step');
    const { scene } = await page.pause();
    const frame = await server.frame();
    assert.equal(scene.tick, frame.tick);
    assertNear(scene.figure.com, frame.v.com, 1e-12, 'CoM');
    assertNear(scene.figure.leg_foot.slice(0, 2), frame.v.zmp, 1e-12, 'foot of the leg');
    assertNear(scene.figure.left_foot, frame.v.left_foot, 1e-12, 'left foot');
    await page.resume();
    await page.page.selectOption('#plant', 'bullet');
    await page.click('#reset-form button');
    await page.until((s) => s.scene.figure?.kind === 'urdf', 'the body');
  });

  test('says that the robot has fallen and why, and gets it up again', async () => {
    await page.fill('#impulse', 120);
    await page.click('.pad-left');
    await page.until((s) => s.condition === 'fallen', 'the fall');
    const { fall_reason: reason } = await server.simulation();
    await until(
      async () => (await page.text('#fall-banner')).includes(reason) && reason !== '',
      'the reason of the fall',
    );
    await page.click('#fall-reset');
    await page.until((s) => s.condition === 'live', 'a live page after the reset');
    await until(() => page.page.locator('#fall-banner').isHidden(), 'the banner to go');
  });

  test('can be used on a phone, and every control has a name', async () => {
    await page.page.setViewportSize({ width: 360, height: 740 });
    assert.equal(
      await page.page.evaluate(() => document.documentElement.scrollWidth),
      360,
      'nothing sticks out at the side',
    );
    await page.fill('#impulse', 3);
    await page.click('.pad-right');
    await until(async () => (await server.pushes()).length === 1, 'a push on the phone');
    const nameless = await page.page.evaluate(() =>
      [...document.querySelectorAll('button, input, select, canvas')]
        .filter((control) => {
          const name =
            control.getAttribute('aria-label') ??
            (control.labels?.length ? control.labels[0].innerText : control.textContent);
          return name.trim() === '';
        })
        .map((control) => control.outerHTML),
    );
    assert.deepEqual(nameless, []);
  });

  test('looks as the README shows it', async () => {
    await page.until((s) => s.t > 3, 'a few steps');
    await page.fill('#impulse', 6);
    await page.click('.pad-left');
    await page.until((s) => s.t > 7.5, 'the recovery');
    await page.pause();
    await page.fill('#impulse', 12);
    await page.fill('#duration', 0.4);
    await page.click('.pad-forward');
    await page.until((s) => s.pushes.listed.length === 2, 'the push');
    const state = await page.step(360);
    assert.ok(state.scene.push_arrow !== null, 'the arrow is in the picture');
    await until(async () => /active/.test(await page.text('#pushes')), 'the push at work');
    const picture = process.env.STAGGER_SCREENSHOT === '1';
    const png = await page.page.screenshot({
      ...(picture ? { path: path.join(top, 'docs/dashboard.png') } : {}),
    });
    assert.ok(png.length > 30000, `a picture of ${png.length} bytes`);
  });
});

describe('connection', () => {
  test('is told to be lost when the server is killed, and comes back by itself', async () => {
    let server = await Server.start({ plant: 'lipm' });
    const page = await Dashboard.open(browser, server.url);
    try {
      const { session_id: session } = await page.state();
      await server.stop('SIGKILL');
      await page.until((s) => s.condition === 'lost' || s.condition === 'connecting', 'the loss');
      await until(
        async () => /^Lost: .*Reconnecting in \d+ s$/.test(await page.text('#condition-text')),
        'the words for a lost connection',
      );
      await until(() => page.page.locator('#stale').isVisible(), 'the words for an old picture');
      assert.equal(await page.page.locator('#pause').isDisabled(), true);
      server = await Server.start({ plant: 'lipm', port: server.port });
      const state = await page.until((s) => s.condition === 'live' && s.tick > 0, 'a live page');
      assert.notEqual(state.session_id, session);
      assert.equal(state.session_id, (await server.simulation()).session_id);
      await until(async () => (await page.text('#condition-text')) === 'Live', 'the word Live');
      assert.deepEqual(await page.violations(), []);
    } finally {
      await page.close();
      await server.stop();
    }
  });

  test('tells that the server stopped in good order', async () => {
    const server = await Server.start({ plant: 'lipm' });
    const page = await Dashboard.open(browser, server.url);
    try {
      await server.stop();
      await until(
        async () => /^Lost: /.test(await page.text('#condition-text')),
        'the words for a lost connection',
      );
    } finally {
      await page.close();
      await server.stop();
    }
  });
});
