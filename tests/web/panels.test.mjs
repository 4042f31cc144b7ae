// Tier 5: what explains a push, recordings, parameters, robots, lists of steps. The simulation is
// paused and goes on by steps: nothing here waits for it.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { describe, test } from 'node:test';
import { command, eventually, root } from '../server/support.mjs';
import { Dashboard, call, newestFrame, onPages } from './support.mjs';

let server;
let page;

onPages(async (browser, started) => {
  server = started;
  await call(server, 'POST', '/simulation/pause', {});
  await call(server, 'POST', '/simulation/reset', { robot: 'kasaei', plant: 'lipm', parameters: {} });
  await call(server, 'PATCH', '/strategies', { ankle: true, hip: true, step: true, time: true });
  page = await Dashboard.open(browser, server.url, { live: false });
});

const walk = () => call(server, 'POST', '/walk', { vx: 0, vy: 0, wz: 0 });
const step = (ticks) => call(server, 'POST', '/simulation/step', { ticks });

/** The same, seen by the page: of a long step it may lose the first frames. */
async function seenStep(ticks) {
  const { tick } = await step(ticks);
  await page.until((s) => s.tick === tick - 1, `tick ${tick}`);
}

/** A row of the list of recordings, by what it does. */
const act = (id, name) => `[data-run="${id}"] [data-act=${name}]`;

describe('a push is explained', () => {
  test('when it is recovered from, with trials without each strategy', async () => {
    await walk();
    await step(2150);
    await page.fill('#impulse', 9);
    await page.click('.pad-left');
    await eventually(async () => (await call(server, 'GET', '/pushes')).items.length === 1, 'the push');
    await seenStep(200);
    await step(6000);
    const { explain } = await page.until((s) => s.explain.ending === 'recovered', 'the recovery');
    const { items } = await call(server, 'GET', '/events?limit=1000&kind=adjustment');
    const told = items.reverse().filter(({ time_s: t }) => t >= 2.15);
    assert.ok(told.length > 0, 'the push needs a step');
    assert.deepEqual(
      explain.steps.map(({ landed, planned, plannedS, actualS }) => [landed, planned, plannedS, actualS]),
      told.map(({ values: v }) => [
        { x: v.x, y: v.y },
        { x: v.planned_x, y: v.planned_y },
        v.planned_t_ss,
        v.t_ss,
      ]),
    );
    await page.shows('#explain-title', /^Push 1: 9 N s left$/);
    await page.shows('#explain-verdict', /^Recovered (with the first step|after \d+ steps), [\d.]+ s after/);
    await page.shows('#explain-list', /Ankle[\s\S]*moved the ZMP by [\d.]+ cm of [\d.]+ cm/);
    await page.shows('#explain-list', /Step[\s\S]*(left|right) \(.*\) → \(.*\) m, moved/);

    await page.click('#explain-compare');
    const { explain: tried } = await page.until(
      (s) => !s.explain.busy && s.explain.trials.length === 5,
      'the trials',
    );
    // Each is the trial that the command line runs.
    for (const { name, spec, result } of tried.trials) {
      assert.equal(spec.strategies.length, name === 'as it is' ? 4 : 3, name);
      assert.ok(!spec.strategies.some((strategy) => name === `without ${strategy}`), name);
      assert.deepEqual(spec.push.trigger, explain.trigger);
      const { stdout } = await command(['trial', '-'], JSON.stringify(spec));
      assert.equal(JSON.parse(stdout).state_hash, result.stateHash, name);
    }
    const rows = await page.page.locator('#explain-trials tbody tr').allInnerTexts();
    assert.equal(rows.length, 5);
    tried.trials.forEach(({ name, result }, i) => {
      assert.ok(rows[i].startsWith(name) && rows[i].includes(result.outcome), rows[i]);
    });
  });

  test('when it is not, with the reason', async () => {
    await walk();
    await step(2100);
    // Onto the stance leg: more than a step catches.
    await call(server, 'POST', '/pushes', { impulse_ns: 40, direction_deg: 90, duration_s: 0.01 });
    // Of a long step the page may lose frames: the whole fall is looked at in short ones.
    for (let i = 0; i < 40; i += 1) await seenStep(20);
    await step(3000);
    await page.until((s) => s.explain.ending === 'fell', 'the fall');
    await page.until((s) => s.explain.margin_m < 0, 'no step to reach far enough');
    const { fall_reason: reason } = await server.state();
    await page.shows('#explain-verdict', new RegExp(`^Fell after .*: ${reason}\\..* No step reached`));
    await page.shows('#explain-list', /Margin left\s+none: a step was [\d.]+ cm short/);
  });
});

/** A recording of a push that way, through the API. */
async function recorded(degrees) {
  await call(server, 'POST', '/simulation/reset', {});
  await walk();
  await step(1500);
  const { id } = await call(server, 'POST', '/recordings', {});
  await step(400 + degrees);
  await call(server, 'POST', '/pushes', { impulse_ns: 6, direction_deg: degrees });
  await step(2500);
  await call(server, 'POST', `/recordings/${id}/stop`, {});
  return id;
}

describe('runs', () => {
  test('are recorded, noted, found by a tag, and deleted', async () => {
    await page.tab('runs');
    await page.click('#record-now');
    const { id } = await eventually(
      async () => (await call(server, 'GET', '/recordings?state=recording')).items[0],
      'the recording',
    );
    await step(300);
    await page.click(act(id, 'stop'));
    await page.until((s) => s.runs.listed.some((run) => run.id === id && run.state === 'done'), 'its end');
    await page.click(`[data-run="${id}"] summary`);
    await page.fill(`#note-${id}`, 'a first look');
    await page.fill(`#tags-${id}`, 'demo, left');
    await page.page.check(`#keep-${id}`);
    await page.click(act(id, 'save'));
    await eventually(async () => {
      const { note, tags, protected: kept } = await call(server, 'GET', `/recordings/${id}`);
      return note === 'a first look' && tags.join() === 'demo,left' && kept;
    }, 'note and tags on the server');
    // Reading them, the page fills its fields anew: what is changed there before that would be lost.
    await page.until((s) => s.runs.listed.some((run) => run.note === 'a first look'), 'note and tags on the page');
    page.expected.push(/status of 409/);
    await page.click(act(id, 'delete'));
    await page.shows('#runs-error', /protected/);
    await page.page.uncheck(`#keep-${id}`);
    await page.click(act(id, 'save'));
    await eventually(
      async () => !(await call(server, 'GET', `/recordings/${id}`)).protected,
      'no protection',
    );
    await page.fill('#runs-tag', 'nothing has this');
    await page.until((s) => s.runs.listed.length === 0, 'an empty list');
    await page.fill('#runs-tag', 'demo');
    await page.until((s) => s.runs.listed.length === 1, 'the one');
    await page.click(`[data-run="${id}"] summary`);
    await page.click(act(id, 'delete'));
    await page.until((s) => s.runs.listed.length === 0, 'it to go');
    assert.equal((await server.get(`/api/v1/recordings/${id}`)).status, 404);
  });

  test('are replayed in the views, and two of them over each other', async () => {
    const [first, second] = [await recorded(0), await recorded(90)];
    await page.shows('#explain-title', /^Push 1: 6 N s left$/);
    await page.tab('runs');
    await page.click(act(first, 'replay'));
    await page.until((s) => s.runs.replayed === first, 'the replay');
    // The card tells of its push, and what can be tried is the live one.
    await page.shows('#explain-title', /^Push 1: 6 N s forward$/);
    await page.shows('#explain-verdict', /^Recovered/);
    assert.equal(await page.page.locator('#explain-compare').isVisible(), false);
    const live = await page.newestTick();
    // Scrubbed by keys and typed: what is drawn is what the file has at that time.
    const { text } = await server.get(`/api/v1/recordings/${first}/data?format=ndjson&every=10`);
    const lines = text.trim().split('\n').map((line) => JSON.parse(line));
    const frames = lines.filter(({ op }) => op === 'data');
    const pushed = lines.find(({ kind }) => kind === 'push_started').t;
    const shows = async (frame) => {
      const { scene, top_view: view } = await page.until(
        (s) => s.scene.tick === frame.tick && s.top_view.tick === frame.tick,
        `tick ${frame.tick}`,
      );
      assert.deepEqual(scene.figure.com, ['x', 'y', 'z'].map((axis) => frame.v[`com.${axis}`]));
      assert.equal(view.marks.dcm.y, frame.v['dcm.y']);
    };
    await page.page.locator('#replay-time').press('End');
    await shows(frames.at(-1));
    await page.page.locator('#replay-time').press('Home');
    await shows(frames[0]);
    await page.page.locator('#replay-time').press('ArrowRight');
    await shows(frames[1]);
    await page.fill('#replay-time', pushed + 0.2);
    await page.shows('#replay-shown', /0\.\d+ s after the push/);
    const { plots } = await page.until((s) => s.plots.current, 'the plots');
    assert.ok(plots.markers > 0, 'its push is marked');
    await page.click('#replay-play');
    await page.until((s) => s.runs.t > pushed + 0.5, 'it to play');
    // At its end it stops by itself: the button would play it again.
    await eventually(async () => {
      const { playing } = (await page.state()).runs;
      if (playing) await page.click('#replay-play');
      return !playing;
    }, 'it to stop');

    await page.click(act(second, 'over'));
    const { runs } = await page.until((s) => s.runs.over === second, 'the other run');
    // They were pushed 90 ticks apart: over each other both are pushed at once.
    assert.ok(Math.abs(runs.shift + 0.09) < 0.011, `${runs.shift} s`);
    const both = await page.until((s) => s.plots.current && 'other_dcm_y' in s.plots.last, 'both lines');
    assert.ok(Number.isFinite(both.plots.last.dcm_y));
    await page.shows('#replay-over', /aligned at the push/);
    // In 3D it stands beside the first run, at the same time from the push on.
    const answer = await server.get(`/api/v1/recordings/${second}/data?format=ndjson&every=10`);
    const others = answer.text.trim().split('\n').map((line) => JSON.parse(line));
    const then = both.runs.t - runs.shift;
    const frame = others.filter(({ op, t }) => op === 'data' && t <= then + 1e-9).at(-1);
    const { scene: withGhost } = await page.until((s) => s.scene.ghost?.kind === 'pendulum', 'the ghost');
    assert.deepEqual(withGhost.ghost.com, ['x', 'y', 'z'].map((axis) => frame.v[`com.${axis}`]));
    assert.ok(!(await page.axe()).length, 'axe');

    await page.click('#replay-close');
    await page.until((s) => s.scene.ghost === null, 'the ghost to go');
    const { scene } = await page.until((s) => s.scene.tick === live, 'the live world again');
    assert.deepEqual(scene.figure.com, (await newestFrame(server)).v.com);
    await page.shows('#explain-title', /^Push 1: 6 N s left$/);
    assert.ok(await page.page.locator('#explain-compare').isEnabled());
  });
});

describe('parameters', () => {
  test('are searched, changed within their ranges, and kept as a preset', async () => {
    await page.tab('tuning');
    const all = (await call(server, 'GET', '/parameters')).items;
    await page.until((s) => s.tuning.count === all.length, 'all of them');
    await page.fill('#tuning-search', 'single support duration');
    const visible = () => page.page.locator('.parameter:visible').evaluateAll((rows) => rows.map((r) => r.dataset.parameter));
    await eventually(async () => (await visible()).includes('gait.t_ss'), 'what was searched for');
    assert.ok((await visible()).length < 6);
    await page.shows('[data-parameter="gait.t_ss"] .hint', /0\.18 to 1\.08 s · own: 0\.36 s/);
    await page.fill('#parameter-gait-t_ss', '0.420');
    await page.page.press('#parameter-gait-t_ss', 'Enter');
    const changed = async () => (await server.state()).parameters;
    await eventually(async () => (await changed())['gait.t_ss'] === 0.42, 'the change');
    await page.until((s) => s.tuning.changed['gait.t_ss'] === 0.42, 'its mark');
    assert.ok(await page.page.locator('[data-parameter="gait.t_ss"].changed').isVisible());
    // The page may know it from the events before its own answer has come, which writes into the field.
    const typed = () => page.page.inputValue('#parameter-gait-t_ss');
    await eventually(async () => (await typed()) === '0.42', 'the value as it counts');

    page.expected.push(/status of 422/);
    await page.fill('#parameter-gait-t_ss', 7);
    await page.page.press('#parameter-gait-t_ss', 'Enter');
    await page.shows('[data-parameter="gait.t_ss"] .alert', /is 7.*1\.08/);
    assert.equal((await changed())['gait.t_ss'], 0.42);

    await page.page.uncheck('#strategy-time');
    await eventually(async () => !(await server.state()).strategies.time, 'the switch');
    await page.fold('#preset-details', true);
    await page.fill('#preset-name', 'slower');
    await page.shows('#tuning-count', /1 changed/);
    await eventually(() => page.page.evaluate(() => !document.querySelector('#strategy-time').checked), 'the state');
    await page.page.press('#preset-name', 'Enter');
    const kept = await eventually(
      async () => (await call(server, 'GET', '/presets')).items.find(({ name }) => name === 'slower'),
      'the preset',
    );
    assert.deepEqual(kept.parameters, { 'gait.t_ss': 0.42 });
    await page.click('[data-parameter="gait.t_ss"] button');
    await eventually(async () => !('gait.t_ss' in (await changed())), "the robot's own value");
    await page.click('[data-preset=slower] button');
    await eventually(async () => (await changed())['gait.t_ss'] === 0.42, 'the preset in use');
    await page.page.check('#tuning-changed');
    await page.fill('#tuning-search', '');
    await eventually(async () => (await visible()).join() === 'gait.t_ss', 'the changed one alone');
    assert.deepEqual(await page.axe(), []);
    await page.click('[data-preset=slower] button[aria-label^=Delete]');
    await page.until((s) => !s.tuning.presets.includes('slower'), 'it to go');
  });
});

describe('robots', () => {
  test('are chosen, and one of your own is looked into before it is used', async () => {
    await page.tab('robots');
    await page.click('[data-robot=op3] button');
    // While the page waits for an answer it takes no other wish; hello may come before the answer.
    await page.until((s) => s.robot === 'op3' && !s.robots.busy, 'the other robot');

    const file = path.join(root, 'tests/data/robots/pitch_first.urdf');
    const { stdout } = await command(['robots', 'check', '--json', file]);
    const { figures, legs } = JSON.parse(stdout);
    // Dropped, as a person does.
    await page.page.evaluate((text) => {
      const data = new DataTransfer();
      data.items.add(new File([text], 'Pitch first.urdf', { type: 'text/xml' }));
      document
        .querySelector('#robot-drop')
        .dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    }, await readFile(file, 'utf8'));
    const { robots } = await page.until((s) => s.robots.report, 'what was found');
    const facts = Object.fromEntries(robots.report.facts);
    assert.equal(facts.Mass, `${figures.mass_kg.toFixed(2)} kg`);
    assert.equal(facts['CoM height'], `${figures.com_height_m.toFixed(3)} m`);
    assert.ok(facts['left foot'].startsWith(legs.left.foot), facts['left foot']);
    assert.ok(!(await call(server, 'GET', '/robots')).items.some(({ uploaded }) => uploaded));
    assert.deepEqual(await page.axe(), []);

    await page.fill('#robot-name', 'mine');
    await page.click('#robot-form button');
    await page.until(
      (s) => s.robot === 'mine' && s.scene.figure?.kind === 'urdf' && !s.robots.busy,
      'it on the page',
    );
    assert.equal((await server.state()).robot, 'mine');

    await page.click('[data-robot=kasaei] button');
    await page.until((s) => s.robot === 'kasaei' && !s.robots.busy, 'the first one');
    await page.click('[data-robot=mine] button[aria-label^=Delete]');
    await page.until((s) => !s.robots.listed.includes('mine'), 'it to go');
  });

  test('that cannot walk are refused with the reason', async () => {
    page.expected.push(/status of 422/);
    await page.tab('robots');
    const file = path.join(root, 'tests/data/robots/four_joints.urdf');
    await page.page.setInputFiles('#robot-files', file);
    await page.shows('#robot-error', /urdf/);
    assert.equal(await page.page.locator('#robot-report').isVisible(), false);
  });
});

describe('a list of steps', () => {
  test('is put down by clicks from above, turned, and walked', async () => {
    await page.tab('walk');
    await page.fold('#steps-details', true);
    await page.until((s) => s.steps.taking, 'clicks to be taken');
    const place = async (x, y) => {
      const { top_view: view } = await page.until((s) => s.top_view.feet, 'the feet');
      const box = await page.page.locator('#top-view').boundingBox();
      await page.page.mouse.click(
        box.x + view.width / 2 - (y - view.centre.y) * view.pixels_per_metre,
        box.y + view.height / 2 - (x - view.centre.x) * view.pixels_per_metre,
      );
    };
    await place(0.15, 0.1);
    await page.until((s) => s.steps.listed.length === 1, 'the first step');
    await place(0.15, -0.1);
    const { steps } = await page.until((s) => s.steps.listed.length === 2, 'the second');
    assert.deepEqual(steps.listed.map(({ side }) => side), ['left', 'right']);
    steps.listed.forEach(({ x, y }, i) => {
      assert.ok(Math.abs(x - 0.15) < 0.01 && Math.abs(y - [0.1, -0.1][i]) < 0.01, `${x}, ${y}`);
    });
    await page.click('#steps tr:nth-child(2) button');
    await page.click('#steps tr:nth-child(1) button');
    await page.until((s) => s.steps.listed.every(({ yaw_deg: yaw }) => yaw === 15), 'both turned');
    await page.click('#steps-walk');
    await page.until((s) => s.steps.listed.length === 0, 'the list to be taken');
    await step(4000);
    const { v } = await newestFrame(server);
    for (const [foot, listed] of [['left_foot', steps.listed[0]], ['right_foot', steps.listed[1]]]) {
      const [x, y, , yaw] = v[foot];
      assert.ok(Math.hypot(x - listed.x, y - listed.y) < 0.01, `${foot} at ${x}, ${y}`);
      assert.ok(Math.abs(yaw - Math.PI / 12) < 0.01, `${foot} turned by ${yaw}`);
    }

    // What the leg cannot do is refused, with the step that it is.
    page.expected.push(/status of 422/);
    await page.fill('#step-x', 3);
    await page.fill('#step-y', 0.1);
    await page.click('#step-add');
    await page.click('#steps-walk');
    await page.shows('#steps-error', /steps\.0/);
  });
});
