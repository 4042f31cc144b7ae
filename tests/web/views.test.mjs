// Tier 5: what the views show, plots and their tools, keys, and themes.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { describe, test } from 'node:test';
import { eventually } from '../server/support.mjs';
import { Dashboard, call, newestFrame, onPages } from './support.mjs';

let browser;
let server;
let page;

onPages(async (...given) => {
  [browser, server] = given;
  await call(server, 'POST', '/simulation/reset', { robot: 'kasaei', plant: 'lipm', terrain: { kind: 'flat' } });
  await call(server, 'POST', '/simulation/resume', {});
  await call(server, 'POST', '/walk', { vx: 0.1, vy: 0, wz: 0 });
  page = await Dashboard.open(browser, server.url);
});

/** So much simulation time at once, without waiting for it; then it goes on, as far as the page knows, too. */
async function ahead(seconds) {
  await call(server, 'POST', '/simulation/pause', {});
  await call(server, 'POST', '/simulation/step', { ticks: Math.round(1000 * seconds) });
  const { tick } = await call(server, 'POST', '/simulation/resume', {});
  await page.until((s) => s.tick > tick, 'the time that was gone ahead');
  // What it has asked meanwhile would tell it that it is paused: its button would resume instead of pause.
  await page.informed();
}

/** A paused page while a foot is in the air, for no longer than so much of its time. */
async function inSwing(latest = 1) {
  for (;;) {
    await page.pause();
    const { v, ...frame } = await newestFrame(server);
    if (v.swing_path.length > 0 && v.phase_time[0] < latest * v.t_ss[0]) return { ...frame, v };
    await call(server, 'POST', '/simulation/step', { ticks: 20 });
  }
}

describe('the views', () => {
  test('show steps, regions, the swing and the forces of the stream', async () => {
    await ahead(2);
    await page.until((s) => s.top_view.footprints >= 2, 'two landings');
    const frame = await inSwing();
    const { scene, top_view: view } = await page.until(
      (s) => s.scene.tick === frame.tick && s.top_view.tick === frame.tick,
      'that frame',
    );
    const flat = (points) => points.flatMap(({ x, y }) => [x, y]);
    assert.deepEqual(flat(view.capture_region), frame.v.capture_region);
    assert.deepEqual(flat(view.reachable_footholds), frame.v.reachable_footholds);
    assert.equal(view.capturable, true);
    assert.equal(view.swing_path, frame.v.swing_path.length / 3);
    const { marks } = scene;
    assert.equal(marks.swing_path, view.swing_path);
    assert.equal(marks.ground_forces, frame.v.ground_forces.length / 6);
    assert.ok(marks.capture_region && marks.reachable_footholds && marks.adjusted_step);
    assert.ok(marks.footprints >= 2 && marks.coming_steps >= 1);
    await page.shows('#verdict', /^The next step can save it$/);

    await page.click('.layers summary');
    for (const layer of ['steps', 'regions', 'forces']) await page.page.uncheck(`#layer-${layer}`);
    const bare = (await page.until((s) => s.scene.marks.ground_forces === 0, 'a bare view')).scene;
    assert.equal(bare.marks.capture_region, false);
    assert.equal(bare.marks.footprints, 0);
    assert.equal(bare.marks.swing_path, 0);
  });

  test('say when no step can save it', async () => {
    await ahead(2);
    const { v } = await inSwing(0.4);
    // Onto the stance leg: more than a step catches, and it takes longer than this to fall.
    const direction_deg = v.support_side[0] > 0.5 ? 270 : 90;
    await call(server, 'POST', '/pushes', { impulse_ns: 40, direction_deg, duration_s: 0.01 });
    const { top_view: view, condition } = await page.step(20);
    assert.equal(condition, 'paused', 'told before the fall');
    assert.equal(view.capturable, false);
    assert.ok(view.capture_region.length > 2);
    await page.shows('#verdict', /^No step reaches far enough$/);
  });

  test('look from four sides, follow or stay', async () => {
    const from = async (preset) => {
      await page.click(`[data-preset=${preset}]`);
      const { camera } = (await page.state()).scene;
      return camera.position.map((value, i) => value - camera.target[i]);
    };
    assert.ok((await from('behind'))[0] < -1);
    assert.ok((await from('side'))[1] < -1);
    assert.ok((await from('front'))[0] > 1);
    const [x, y, z] = await from('top');
    assert.ok(z > 10 * Math.hypot(x, y));
    const { target: before } = (await page.state()).scene.camera;
    await page.until((s) => s.scene.camera.target[0] > before[0] + 0.05, 'the camera to go along');
    await page.page.locator('body').press('f');
    assert.equal((await page.state()).scene.camera.follow, false);
  });

  test('show the ground that hello tells of', async () => {
    const patches = [{ x_min: 0.5, x_max: 1, y_min: -0.5, y_max: 0.5, friction: 0.3 }];
    for (const [terrain, words] of [
      [{ kind: 'slope', angle_deg: 4 }, /^slope of 4°$/],
      [{ kind: 'uneven', height_m: 0.01, patches }, /^tiles up to 10 mm$/],
      [{ kind: 'platform', vx: 0.05 }, /^moving platform$/],
    ]) {
      await call(server, 'POST', '/simulation/reset', { plant: 'bullet', terrain });
      const { scene } = await page.until(
        (s) => s.scene.ground.kind === terrain.kind && s.scene.figure?.kind === 'urdf',
        terrain.kind,
      );
      assert.equal(scene.ground.tiles > 0, terrain.kind === 'uneven');
      assert.equal(scene.ground.patches, terrain.patches?.length ?? 0);
      await page.shows('#bar-terrain', words);
    }
  });

  test('let the ground be chosen', async () => {
    await page.tab('world');
    await page.page.selectOption('#plant', 'bullet');
    await page.page.selectOption('#terrain', 'slope');
    await page.fill('#terrain-value', 3);
    await page.fill('#seed', 9);
    await page.click('#reset-form button');
    await page.until((s) => s.scene.ground.kind === 'slope', 'the slope');
    const { terrain, seed } = await server.state();
    assert.equal(terrain.kind, 'slope');
    assert.equal(terrain.angle_deg, 3);
    assert.equal(seed, 9);
  });
});

describe('plots', () => {
  test('come in groups, with joints and momentum of the robot', async () => {
    await call(server, 'POST', '/simulation/reset', { plant: 'bullet' });
    await page.until((s) => s.plots.groups.includes('torques'), 'the joints');
    await ahead(0.5);
    // A busy page takes fewer frames a second: paused, there would be no more of them.
    await page.until((s) => s.plots.points > 20, 'some data');
    await page.pause();
    const { v } = await newestFrame(server);
    for (const group of ['steps', 'torques', 'momentum', 'balance']) {
      await page.click(`[data-group=${group}]`);
      const { plots } = await page.until(
        (s) => s.plots.group === group && s.plots.current && s.plots.points > 20,
        group,
      );
      const { last } = plots;
      if (group === 'torques') assert.ok(Object.values(last).includes(v.joint_torque[1]));
      if (group === 'momentum') assert.equal(last.angular_momentum_y, v.angular_momentum[1]);
      if (group === 'steps') assert.equal(last.step_time_planned, v.planned_t_ss[0]);
    }
  });

  test('zoom, move, freeze and come back while the simulation goes on', async () => {
    // There is an earlier time to go to once the page holds more than it shows.
    await ahead(6);
    await page.until((s) => s.t > 6, 'six seconds');
    const span = ({ plots }) => plots.window[1] - plots.window[0];
    await page.page.locator('.plot-dcm_y .u-over').hover();
    await page.page.mouse.wheel(0, -800);
    await page.until((s) => span(s) < 5, 'a closer look');
    const box = await page.page.locator('.plot-dcm_y .u-over').boundingBox();
    await page.page.mouse.move(box.x + 20, box.y + 20);
    await page.page.mouse.down();
    await page.page.mouse.move(box.x + 120, box.y + 20);
    await page.page.mouse.up();
    const moved = await page.until((s) => !s.plots.following, 'an earlier time');
    await page.until((s) => s.t > moved.t + 0.3, 'time to go on');
    assert.deepEqual((await page.state()).plots.window, moved.plots.window);
    await page.click('#plot-now');
    await page.until((s) => s.plots.following && Math.abs(span(s) - 10) < 1e-9, 'now');

    await page.page.locator('body').press('g');
    const frozen = await page.until((s) => s.plots.frozen && s.plots.current, 'the freeze drawn');
    const { plots } = await page.until((s) => s.t > frozen.t + 0.5, 'time to go on');
    assert.deepEqual(plots.window, frozen.plots.window);
    assert.deepEqual(plots.last, frozen.plots.last);
    assert.equal(plots.points, frozen.plots.points);
    await page.click('#plot-freeze');
    const { dcm_y: then } = frozen.plots.last;
    await page.until((s) => !s.plots.frozen && s.plots.last.dcm_y !== then, 'the thaw');
  });

  test('have a cursor for the keyboard, and a legend that hides lines', async () => {
    await ahead(1.5);
    await page.until((s) => s.plots.points > 100, 'a second of data');
    await page.pause();
    await page.page.locator('#plots').focus();
    await page.page.keyboard.press('Home');
    await page.page.keyboard.press('ArrowRight');
    await eventually(async () => (await page.state()).plots.cursor === 5, 'the cursor');
    await page.shows('.plot-dcm_y .readout', /^at .* s: .* \/ .* m$/);
    assert.match(await page.page.locator('#plot-spoken').textContent(), /DCM error/);
    await page.click('[data-role=reference]');
    const { plots } = await page.until((s) => s.plots.hidden.includes('reference'), 'no references');
    assert.equal('dcm_reference_x' in plots.last, false);
    await page.click('[data-role=reference]');
    await page.until((s) => s.plots.hidden.length === 0, 'the references again');
  });

  test('are exported as numbers and as a picture', async () => {
    await ahead(1);
    await page.until((s) => s.plots.points > 50, 'some data');
    const { plots } = await page.pause();
    const save = async (button) => {
      const [download] = await Promise.all([page.page.waitForEvent('download'), page.click(button)]);
      return readFile(await download.path());
    };
    const lines = String(await save('#plot-csv')).trim().split('\r\n');
    const names = lines[0].split(',');
    assert.equal(lines.length, 1 + plots.points);
    const end = Object.fromEntries(lines.at(-1).split(',').map((text, i) => [names[i], Number(text)]));
    assert.equal(end.dcm_x, plots.last.dcm_x);
    assert.equal(end.zmp_reference_y, plots.last.zmp_reference_y);
    const png = await save('#plot-png');
    assert.equal(png.subarray(1, 4).toString(), 'PNG');
    assert.ok(png.length > 5000, `${png.length} bytes`);
  });

  test('and the timeline mark a push', async () => {
    await call(server, 'POST', '/pushes', { impulse_ns: 2, direction_deg: 90 });
    await ahead(2);
    await page.until((s) => s.plots.markers > 0 && s.timeline.events > 0, 'the marker');
    await page.until((s) => s.t > 2, 'two seconds');
    const box = await page.page.locator('#timeline').boundingBox();
    await page.click('#plot-closer');
    await page.click('#plot-closer');
    await page.click('#plot-closer');
    await page.page.mouse.click(box.x + 4, box.y + box.height / 2);
    const { plots, timeline } = await page.until((s) => !s.plots.following, 'another time');
    assert.ok(plots.window[0] < timeline.range[0] + 2);
  });
});

describe('the page', () => {
  test('can be used by keys alone, and tells which', async () => {
    await page.page.locator('body').press('?');
    await eventually(() => page.page.locator('#help').isVisible(), 'the help');
    const help = await page.text('#help');
    for (const words of ['Push forward', 'Pause and resume', 'Step in place', 'Freeze the plots']) {
      assert.ok(help.includes(words), words);
    }
    await page.page.keyboard.press('Escape');
    await eventually(
      () => page.page.evaluate(() => document.activeElement === document.body),
      'the help to go',
    );
    await page.page.locator('body').press(' ');
    await eventually(async () => (await server.state()).running === false, 'Space: pause');
    const { tick } = await server.state();
    // A heartbeat from before the pause may come after its answer: with the event of it there are none left.
    await page.shows('#events', /pause/);
    await page.until((s) => s.condition === 'paused', 'the paused page');
    await page.page.locator('body').press('.');
    await eventually(async () => (await server.state()).tick === tick + 10, '.: a step');
    await page.page.locator('body').press(']');
    await eventually(() => page.page.locator('#walk-panel').isVisible(), ']: the next panel');
    const { session_id: session } = await server.state();
    await page.page.locator('body').press('r');
    await eventually(async () => (await server.state()).session_id !== session, 'R: a reset');
    // Typing a number is no command.
    await page.page.locator('#vx').press('r');
    await page.page.locator('#vx').press('.');
    assert.equal((await server.state()).tick, 0);
  });

  test('keeps the theme that was chosen', async () => {
    const background = () => page.page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const light = await background();
    while ((await page.text('#theme')) !== 'Theme: dark') await page.click('#theme');
    assert.notEqual(await background(), light);
    const dark = await background();
    await page.page.reload();
    await page.until((s) => s.condition === 'live', 'the page again');
    assert.equal(await background(), dark);
  });

  test('shows the same in several tabs', async () => {
    const other = await Dashboard.open(browser, server.url);
    const mine = await page.pause();
    const theirs = await other.drawn(mine.tick);
    assert.equal(theirs.session_id, mine.session_id);
    assert.deepEqual(theirs.scene.figure, mine.scene.figure);
    await other.close();
  });
});
