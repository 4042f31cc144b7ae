// Tier 5: every view, light and dark, of a full body that was pushed: nothing that axe-core objects to, nothing wider
// than a phone. With STAGGER_SCREENSHOT=1 it makes the pictures in docs/views, which the README shows.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { Server, eventually, longPatience, root } from '../server/support.mjs';
import { Dashboard, call, launchBrowser } from './support.mjs';

const sharp = process.env.STAGGER_SCREENSHOT === '1';
const folder = path.join(root, 'docs', 'views');

let browser;
let server;
let page;
let runs;
let campaign;

const step = (ticks) => call(server, 'POST', '/simulation/step', { ticks });

/** A walk that is pushed and goes on, recorded. */
async function recorded(degrees, watch) {
  await call(server, 'POST', '/simulation/reset', { seed: 1 });
  await call(server, 'POST', '/walk', { vx: 0.1, vy: 0, wz: 0 });
  await step(3000);
  const { id } = await call(server, 'POST', '/recordings', { note: `pushed at ${degrees} degrees` });
  await step(1000);
  await call(server, 'POST', '/pushes', {
    impulse_ns: 15,
    direction_deg: degrees,
    duration_s: 0.1,
    trigger: { phase: 'single_support', leg: 'left', fraction: 0.3 },
  });
  await watch();
  await call(server, 'POST', `/recordings/${id}/stop`, {});
  return id;
}

before(async () => {
  server = await Server.start('--plant', 'bullet');
  await call(server, 'POST', '/simulation/pause', {});
  browser = await launchBrowser();
  const design = { kind: 'bisect', axis: 'push.fr', lo: 0.05, hi: 0.5, tol: 0.05, repeats: 1 };
  const spec = {
    version: 1,
    name: 'pendulum-limits',
    base: {
      robot: 'kasaei',
      plant: 'lipm',
      push: { duration_s: 0.05, trigger: { phase: 'single_support', leg: 'left', fraction: 0.1 } },
    },
    design,
    factors: {
      'push.direction_deg': Array.from({ length: 12 }, (_, i) => 30 * i),
      'push.trigger.fraction': [0.1, 0.6],
    },
    pass: { recover_within_s: 4 },
  };
  campaign = (await call(server, 'POST', '/campaigns', spec)).id;
  const first = await recorded(0, () => step(2000));
  page = await Dashboard.open(browser, server.url, { live: false, sharp });
  const second = await recorded(90, async () => {
    // The whole push is seen: of a long step a page may lose frames.
    for (let i = 0; i < 60; i += 1) await page.step(20);
    await step(4000);
  });
  runs = [first, second];
  await page.until((s) => s.explain.ending === 'recovered', 'the recovery');
  await eventually(
    async () => (await call(server, 'GET', `/campaigns/${campaign}`)).state === 'done',
    'the campaign to be done',
    longPatience,
  );
  if (sharp) fs.mkdirSync(folder, { recursive: true });
});
after(async () => {
  await Dashboard.closeAll();
  await browser?.close();
  await server?.kill();
});

/** Everything in its place in both themes; `selector` is what the picture is of: by default the window. */
async function lookAt(name, selector) {
  for (const theme of ['light', 'dark']) {
    await page.page.emulateMedia({ colorScheme: theme });
    await page.until((s) => s.theme === theme, `${name} in ${theme}`);
    assert.deepEqual(await page.axe(), [], `${name}, ${theme}`);
    if (sharp) await picture(path.join(folder, `${name}-${theme}.png`), selector);
  }
}

/** At rest, from the top of all that scrolls. */
async function picture(file, selector) {
  await page.page.evaluate(() => {
    for (const element of document.querySelectorAll('*')) if (element.scrollTop > 0) element.scrollTop = 0;
    document.activeElement?.blur();
  });
  await page.until((s) => s.scene.at_rest && s.plots.current, 'a page at rest');
  const what = selector === undefined ? page.page : page.page.locator(selector);
  await what.screenshot({ path: file });
}

/** A panel of the controls with all of its height. */
async function lookAtPanel(name) {
  await page.page.setViewportSize({ width: 1440, height: 1250 });
  await lookAt(name, '.column-controls');
  await page.page.setViewportSize({ width: 1440, height: 900 });
}

describe('nothing is wrong with', () => {
  test('the page, and each of its views', async () => {
    await lookAt('page');
    await lookAt('robot', '.scene');
    await lookAt('above', '.top-panel');
    for (const group of ['balance', 'steps', 'torques', 'momentum']) {
      await page.click(`[data-group=${group}]`);
      await lookAt(`plots-${group}`, '.plots-panel');
    }
    await page.click('[data-group=balance]');
  });

  test('what explains a push', async () => {
    await page.click('#explain-compare');
    await page.until((s) => !s.explain.busy && s.explain.trials.length === 5, 'the trials', longPatience);
    await lookAt('explain', '#explain-panel');
  });

  test('the panels of the controls', async () => {
    await page.fold('#push-details', true);
    await page.fold('#repeat-details', true);
    await lookAtPanel('push');
    await page.fold('#push-details', false);
    await page.fold('#repeat-details', false);
    await page.tab('walk');
    await page.fold('#steps-details', true);
    await lookAtPanel('walk');
    await page.fold('#steps-details', false);
    await page.tab('world');
    await lookAtPanel('world');
    await page.tab('tuning');
    await page.until((s) => s.tuning.count > 0, 'the parameters');
    await page.fill('#tuning-search', 'step');
    await lookAtPanel('parameters');
    await page.tab('robots');
    await lookAtPanel('robots');
  });

  test('a replay with another run laid over it', async () => {
    const [first, second] = runs;
    await page.tab('runs');
    await page.click(`[data-run="${first}"] [data-act=replay]`);
    await page.until((s) => s.runs.replayed === first, 'the replay');
    await page.click(`[data-run="${second}"] [data-act=over]`);
    await page.until((s) => s.runs.over === second, 'the other run');
    await page.until((s) => s.scene.ghost?.kind === 'urdf', 'its body');
    await page.fill('#replay-time', (await page.state()).runs.t + 0.8);
    await lookAt('runs');
    await page.click('#replay-close');
    await page.until((s) => s.runs.replayed === null, 'the live world');
  });

  test('the results of a campaign', async () => {
    await page.tab('campaigns');
    await page.click(`[data-campaign="${campaign}"] [data-act=show]`);
    await page.until((s) => s.campaigns.shown === campaign, 'the results');
    await page.click('.heat');
    await page.fold('#campaign-details', true);
    await lookAt('campaigns');
    await page.click('#campaign-close');
  });

  test('the help, and a phone', async () => {
    await page.tab('push');
    await page.click('#help-open');
    await lookAt('help');
    await page.page.keyboard.press('Escape');
    await page.page.setViewportSize({ width: 390, height: 844 });
    for (const tab of ['walk', 'world', 'runs', 'campaigns', 'tuning', 'robots', 'push']) {
      await page.tab(tab);
      await page.fits(390);
    }
    await lookAt('phone');
  });
});
