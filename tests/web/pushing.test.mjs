// Tier 5: pushing and walking as a person does it, with mouse and keyboard, and links that repeat.
import assert from 'node:assert/strict';
import { after, afterEach, before, beforeEach, describe, test } from 'node:test';
import { Server, command, eventually } from '../server/support.mjs';
import { Dashboard, call, launchBrowser, pushes } from './support.mjs';

let browser;
let server;
let page;

before(async () => {
  browser = await launchBrowser();
});
after(() => browser?.close());

beforeEach(async () => {
  server = await Server.start('--plant', 'lipm');
  page = await Dashboard.open(browser, server.url);
});

afterEach(async () => {
  try {
    await Dashboard.closeAll();
  } finally {
    await server?.kill();
  }
});

const specOf = async () => (await pushes(server))[0]?.spec;

/** Drags from the robot, which is paused, by so many pixels; the button stays down until `up`. */
async function dragRobot(dx, dy) {
  // The camera goes on after it for a while: the robot has a place on the page once that rests.
  await page.until(({ scene: { figure, camera } }) => {
    const [ahead, aside] = [0, 1].map((i) => figure.com[i] - camera.target[i]);
    return Math.hypot(ahead, aside) < 1e-3;
  }, 'the camera to rest');
  const { x, y } = await page.robotOnPage();
  await page.page.mouse.move(x, y);
  await page.page.mouse.down();
  await page.page.mouse.move(x + dx / 2, y + dy / 2);
  await page.page.mouse.move(x + dx, y + dy);
}

describe('a push', () => {
  test('starts with a strength that suits the robot', async () => {
    for (const robot of ['kasaei', 'op3', 'g1']) {
      await call(server, 'POST', '/simulation/reset', { robot });
      await page.until((s) => s.robot === robot, `${robot} on the page`);
      const { mass_kg: mass } = await call(server, 'GET', `/robots/${robot}`);
      await eventually(async () => {
        const impulse = Number(await page.page.inputValue('#impulse'));
        return Math.abs(impulse - 0.2 * mass) <= 0.006 * mass;
      }, `0.2 m/s times ${mass} kg`);
    }
  });

  test('is aimed by a drag, shown in numbers, and applied or dropped', async () => {
    await page.pause();
    await page.click('[data-preset=top]');
    await dragRobot(0, -60);
    await page.page.mouse.up();
    const { aimed } = (await page.until((s) => s.pushes.aimed, 'the push that was aimed')).pushes;
    assert.deepEqual(await pushes(server), [], 'nothing is sent before it is applied');
    const text = await page.text('#aim-text');
    assert.ok(text.startsWith(`${aimed.impulse_ns} N s`), text);
    // Seen from above with the robot looking up, a drag upwards is forward.
    assert.ok(Math.abs(((aimed.direction_deg + 180) % 360) - 180) <= 2, `${aimed.direction_deg}`);
    await page.page.keyboard.press('Enter');
    const spec = await eventually(specOf, 'the push on the server');
    assert.equal(spec.impulse_ns, aimed.impulse_ns);
    const angle = (Math.atan2(spec.direction[1], spec.direction[0]) * 180) / Math.PI;
    assert.ok(Math.abs(angle - aimed.direction_deg) < 1e-9 || aimed.direction_deg > 180);
    await eventually(() => page.page.locator('#aim-card').isHidden(), 'the card to go');

    await dragRobot(-60, 0);
    await page.page.mouse.up();
    await page.until((s) => s.pushes.aimed, 'another one');
    await page.page.keyboard.press('Escape');
    await page.until((s) => !s.pushes.aimed, 'it to be dropped');
    assert.equal((await pushes(server)).length, 1);
  });

  test('by a spring is recorded as pushes that follow one another', async () => {
    // A robot that steps might have gone from where it was seen by the time it is taken hold of.
    await page.pause();
    await page.click('[data-mode=spring]');
    await dragRobot(40, 0);
    await call(server, 'POST', '/simulation/resume', {});
    await eventually(async () => (await pushes(server)).length >= 3, 'three pieces of the pull');
    await page.page.mouse.up();
    await page.shows('#push-answer', /^Spring: \d+ pushes in a row/);
    const { spring } = (await page.state()).pushes;
    const sent = (await pushes(server)).map(({ id }) => id).sort((a, b) => a - b);
    assert.deepEqual(spring.pushes.map(({ id }) => id).slice(0, sent.length), sent);
    spring.pushes.forEach(({ body }, i) => {
      assert.equal(body.duration_s, 0.1);
      if (i > 0) {
        const gap = body.at_s - spring.pushes[i - 1].body.at_s;
        assert.ok(Math.abs(gap - 0.1) < 1e-9, `${gap} s from piece to piece`);
      }
    });
    await page.fold('#repeat-details', true);
    await page.click('#copy-curl');
    const lines = (await page.page.inputValue('#copied-text')).split('\n');
    assert.equal(lines.length, spring.pushes.length);
  });

  test('has a form with every field of the push resource', async () => {
    await page.pause();
    await page.fold('#push-details', true);
    await page.page.selectOption('#strength-kind', 'force');
    await page.fill('#impulse', 120);
    await page.fill('#duration', 0.2);
    await page.page.selectOption('#profile', 'half_sine');
    await page.page.selectOption('#link', 'pelvis');
    for (const [axis, value] of [['x', 0.01], ['y', -0.02], ['z', 0.03]]) {
      await page.fill(`#point-${axis}`, value);
    }
    for (const [axis, value] of [['x', 0.6], ['y', 0], ['z', 0.8]]) {
      await page.fill(`#direction-${axis}`, value);
    }
    await page.page.selectOption('#trigger', 'time');
    await page.fill('#at-s', 500.5);
    await page.click('#push-angle');
    const spec = await eventually(specOf, 'the push on the server');
    assert.equal(spec.link, 'pelvis');
    assert.deepEqual(spec.point, [0.01, -0.02, 0.03]);
    assert.deepEqual(spec.direction, [0.6, 0, 0.8]);
    assert.equal(spec.profile, 'half_sine');
    assert.equal(spec.at_s, 500.5);
    assert.ok(Math.abs(spec.impulse_ns - (120 * 0.2 * 2) / Math.PI) < 1e-9);
    // The same from the command that is copied.
    await page.fold('#repeat-details', true);
    await page.click('#copy-curl');
    const curl = await page.page.inputValue('#copied-text');
    const [, url, json] = /^curl -X POST (\S+) .* -d '(.*)'$/.exec(curl);
    assert.equal(url, `${new URL(server.url).origin}/api/v1/pushes`);
    await call(server, 'POST', '/pushes', JSON.parse(json));
    assert.deepEqual(await specOf(), spec);
  });

  test('comes again, in presets, and in trains', async () => {
    await page.pause();
    await page.click('[data-delta-v="0.5"][data-duration="0.01"]');
    await page.page.locator('body').press('ArrowLeft');
    const first = await eventually(specOf, 'the push');
    assert.equal(first.duration_s, 0.01);
    assert.ok(Math.abs(first.direction[1] - 1) < 1e-12);
    await page.page.locator('#push-again:enabled').waitFor();
    await page.page.locator('body').press('p');
    await eventually(async () => (await pushes(server)).length === 2, 'the same push again');
    assert.deepEqual(await specOf(), first);

    await page.fold('#push-details', true);
    await page.fill('#train-count', 3);
    await page.fill('#train-every', 0.5);
    await page.click('#push-angle');
    await eventually(async () => (await pushes(server)).length === 5, 'a train of three');
    const { tick } = await server.state();
    const [third, second] = await pushes(server);
    assert.ok(Math.abs(second.spec.at_s - (tick * 0.001 + 0.5)) < 1e-9);
    assert.ok(Math.abs(third.spec.at_s - (tick * 0.001 + 1)) < 1e-9);
  });
});

describe('a link', () => {
  test('opened in a fresh browser profile ends with the same state hash', async () => {
    await call(server, 'POST', '/simulation/reset', { seed: 5 });
    await call(server, 'POST', '/walk', { vx: 0.1, vy: 0, wz: 0 });
    await eventually(async () => (await server.state()).walking, 'the walk');
    // A link tells of the world that the page knows; in the one before the robot stepped in place.
    await page.informed();
    await page.fold('#push-details', true);
    await page.fill('#angle', 30);
    await page.page.selectOption('#trigger', 'single_support left');
    await page.fill('#fraction', 0.3);
    await page.fold('#push-details', false);
    await page.fold('#repeat-details', true);
    await page.fill('#settle', 1);
    await page.fill('#observe', 1);
    await page.click('#copy-link');
    const link = await page.page.inputValue('#copied-text');
    assert.ok(link.startsWith(`${new URL(server.url).origin}/#trial=`), link);
    await page.click('#trial-run');
    const here = (await page.until((s) => s.trial.outcome, 'the trial')).trial.outcome;
    assert.equal((await server.state()).state_hash, here.stateHash);

    const spec = JSON.parse(decodeURIComponent(link.split('#trial=')[1]));
    assert.equal(spec.seed, 5);
    assert.deepEqual(spec.walk, { vx: 0.1, vy: 0, wz: 0 });
    const trial = await command(['trial', '-'], JSON.stringify(spec));
    assert.equal(JSON.parse(trial.stdout).state_hash, here.stateHash, 'and so says `stagger trial`');

    // Somebody else's world, somebody else's browser: there it runs by itself.
    const elsewhere = await Server.start('--plant', 'lipm', '--robot', 'op3');
    try {
      const moved = link.replace(new URL(server.url).origin, new URL(elsewhere.url).origin);
      const there = await Dashboard.open(browser, moved, { live: false });
      const { trial: shown } = await there.until((s) => s.trial.outcome, 'the same trial');
      assert.deepEqual(shown.outcome, here);
      await there.shows('#trial-progress', new RegExp(here.stateHash));
      await there.close();
    } finally {
      await elsewhere.kill();
    }
  });

  test('asks first where others are watching', async () => {
    const link = `${new URL(server.url).origin}/#trial=${encodeURIComponent(
      JSON.stringify({ robot: 'kasaei', plant: 'lipm', settle_s: 0.2, observe_s: 0.2 }),
    )}`;
    const { session_id: session } = await server.state();
    const other = await Dashboard.open(browser, link);
    await other.shows('#trial-progress', /Others are watching/);
    assert.equal((await server.state()).session_id, session);
    await other.click('#trial-start');
    await other.until((s) => s.trial.outcome, 'the trial');
    const { session_id: started } = await server.state();
    assert.notEqual(started, session);
    for (const viewer of [page, other]) {
      await viewer.until((s) => s.session_id === started, 'the same world for both');
    }
    await other.close();
  });
});

describe('walking', () => {
  const walk = async () => (await server.state()).walk;

  test('goes by the pad, by keys, and stops', async () => {
    await page.tab('walk');
    const box = await page.page.locator('#walk-pad').boundingBox();
    await page.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.page.mouse.down();
    await page.page.mouse.move(box.x + box.width / 2, box.y + box.height * 0.25);
    await page.page.mouse.up();
    await eventually(async () => Math.abs((await walk()).vx - 0.25) < 0.02, 'half of the way up');
    const { vx } = await walk();
    // The key goes on from the velocity that the page knows.
    await page.informed();
    await page.page.locator('body').press('w');
    await eventually(async () => Math.abs((await walk()).vx - vx - 0.05) < 1e-9, 'W: faster');
    await page.page.locator('body').press('a');
    await eventually(async () => Math.abs((await walk()).vy - 0.05) < 1e-9, 'A: to the left');
    await page.page.locator('body').press('q');
    await eventually(async () => Math.abs((await walk()).wz - 0.05) < 1e-9, 'Q: turning left');
    await page.page.locator('body').press('x');
    await eventually(async () => !(await server.state()).walking, 'X: it stands');
  });
});
