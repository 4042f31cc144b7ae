// Tier 5: what the card says of pushes to the full body, one of each class: which strategy was needed shows in the
// server's own trials without it.
import assert from 'node:assert/strict';
import { after, afterEach, before, describe, test } from 'node:test';
import { Server, command, longPatience } from '../server/support.mjs';
import { Dashboard, call, launchBrowser } from './support.mjs';

const all = ['ankle', 'hip', 'step', 'time'];
const settleTicks = 3000;
const observeS = 4;

/** `needed`: without it the robot falls; where it is null, every one of the others can be spared. */
const classes = [
  { name: 'the ankle suffices', push: [3, 0], strategies: all, steps: 0, needed: null },
  { name: 'the hip is needed', push: [6, 0], strategies: ['ankle', 'hip'], stand: true, steps: 0, needed: 'hip' },
  { name: 'a step is needed', push: [15, 0], strategies: all, needed: 'step' },
  { name: 'its time is needed', push: [15, 90], strategies: all, needed: 'time' },
  { name: 'nothing helps', push: [30, 90], strategies: all, falls: true },
];

let browser;
let server;
let page;
before(async () => {
  server = await Server.start('--plant', 'bullet');
  await call(server, 'POST', '/simulation/pause', {});
  browser = await launchBrowser();
});
after(async () => {
  await browser?.close();
  await server?.kill();
});
afterEach(() => Dashboard.closeAll());

describe('the card', () => {
  for (const { name, push, strategies, stand = false, steps, needed, falls = false } of classes) {
    test(`of a push where ${name}`, async () => {
      await call(server, 'POST', '/simulation/reset', { seed: 1 });
      const on = Object.fromEntries(all.map((strategy) => [strategy, strategies.includes(strategy)]));
      await call(server, 'PATCH', '/strategies', on);
      page = await Dashboard.open(browser, server.url, { live: false });
      if (!stand) await call(server, 'POST', '/walk', { vx: 0, vy: 0, wz: 0 });
      await page.step(settleTicks);
      const [impulse, direction] = push;
      const trigger = stand ? {} : { trigger: { phase: 'single_support', leg: 'left', fraction: 0.2 } };
      const body = { impulse_ns: impulse, direction_deg: direction, duration_s: 0.05, ...trigger };
      await call(server, 'POST', '/pushes', body);
      const ending = falls ? 'fell' : 'recovered';
      // In short steps: of a long one a page may lose frames.
      let explain = {};
      for (let ticks = 0; explain.ending !== ending && ticks < 1000 * observeS + 1500; ticks += 20) {
        const { tick } = await call(server, 'POST', '/simulation/step', { ticks: 20 });
        ({ explain } = await page.until((s) => s.tick === tick - 1, `tick ${tick}`));
      }
      assert.equal(explain.ending, ending);

      // Of the very same push the server's trial tells the same.
      const { stdout } = await command(
        ['trial', '-'],
        JSON.stringify({ robot: 'kasaei', seed: 1, stand, strategies, settle_s: 3, observe_s: observeS, push: body }),
      );
      const trial = JSON.parse(stdout);
      assert.equal(trial.outcome, ending);
      if (falls) {
        await page.shows('#explain-verdict', new RegExp(`^Fell after [\\d.]+ s: ${trial.reason}`));
      } else {
        assert.equal(explain.steps_to_recover, trial.steps_to_recover);
        assert.ok(Math.abs(explain.recovery_s - trial.recovery_time_s) < 0.05, `${explain.recovery_s} s`);
        await page.shows('#explain-verdict', /^Recovered /);
      }
      if (steps === 0) await page.shows('#explain-verdict', /^Recovered without a step of its own/);

      await page.click('#explain-compare');
      const { trials } = (
        await page.until((s) => !s.explain.busy && s.explain.trials.length > 0, 'the trials', longPatience)
      ).explain;
      assert.deepEqual(
        trials.map((row) => row.name),
        ['as it is', ...strategies.map((strategy) => `without ${strategy}`)],
      );
      for (const { name: which, spec, result } of trials) {
        const again = await command(['trial', '-'], JSON.stringify(spec));
        assert.equal(JSON.parse(again.stdout).state_hash, result.stateHash, which);
      }
      const outcomes = Object.fromEntries(trials.map((row) => [row.name, row.result.outcome]));
      assert.equal(outcomes['as it is'], ending, JSON.stringify(trials[0]));
      if (needed) assert.equal(outcomes[`without ${needed}`], 'fell', JSON.stringify(outcomes));
      if (needed === null) {
        for (const other of ['hip', 'step', 'time']) assert.equal(outcomes[`without ${other}`], 'recovered', other);
      }
      const rows = await page.page.locator('#explain-trials tbody tr').allInnerTexts();
      trials.forEach((row, i) => assert.ok(rows[i].startsWith(row.name) && rows[i].includes(row.result.outcome)));
    });
  }
});
