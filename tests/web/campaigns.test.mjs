// Tier 5: campaigns from the page, on the pendulum.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { describe, test } from 'node:test';
import { eventually, longPatience } from '../server/support.mjs';
import { Dashboard, call, onPages } from './support.mjs';

let server;
let page;

onPages(async (browser, started) => {
  server = started;
  await call(server, 'POST', '/simulation/pause', {});
  page = await Dashboard.open(browser, server.url, { live: false });
  await page.tab('campaigns');
});

const act = (id, name) => `[data-campaign="${id}"] [data-act=${name}]`;
const campaign = (id) => call(server, 'GET', `/campaigns/${id}`);
const newest = async () => (await call(server, 'GET', '/campaigns?limit=1')).items[0];
const finished = (id) =>
  eventually(async () => (await campaign(id)).state === 'done', 'the campaign to be done', longPatience);

async function resultsOf(id, format) {
  const { status, text } = await server.get(`/api/v1/campaigns/${id}/results?format=${format}`);
  assert.equal(status, 200, text);
  return text;
}
const trialsOf = async (id) =>
  (await resultsOf(id, 'ndjson')).trim().split('\n').map((line) => JSON.parse(line));

/** Fills the form and starts what it asks for; the new campaign's id. */
async function startByForm(name, kind, change = {}) {
  const wanted = { name, directions: 4, phases: '0.1', from: 0.1, to: 0.7, step: 0.1, ...change };
  await page.page.selectOption('#campaign-plant', 'lipm');
  await page.page.selectOption('#campaign-kind', kind);
  for (const [field, value] of Object.entries(wanted)) await page.fill(`#campaign-${field}`, value);
  await page.click('#campaign-start');
  await eventually(async () => (await newest())?.name === name, 'the new campaign');
  return (await newest()).id;
}

async function show(id) {
  await finished(id);
  await page.click(act(id, 'show'));
  return page.until((s) => s.campaigns.shown === id, 'the results');
}

describe('campaigns', () => {
  test('find push limits, and any trial is shown in the live world to the same hash', async () => {
    const id = await startByForm('limits', 'bisect', { directions: 12, step: 0.05 });
    const { campaigns } = await show(id);
    const { limits } = JSON.parse(await resultsOf(id, 'json'));
    assert.equal(limits.length, 12);
    const near = (value) => value && Number(value.toFixed(6));
    assert.deepEqual(
      campaigns.curves[0].limits.map((l) => [l.directionDeg, near(l.pass), near(l.fail)]),
      limits.map((l) => [l.values['push.direction_deg'], near(l.pass), near(l.fail)]),
    );
    const trials = await trialsOf(id);
    const fallen = trials.find(({ outcome }) => outcome === 'fell');
    const held = trials.find(({ passed, steps_to_recover: steps }) => passed && steps > 0);
    assert.ok(fallen && held, 'one of them falls, one needs a step');
    await page.click(`.heat[data-trial="${fallen.number}"]`);
    await page.shows('#campaign-trial-text', /^Trial \d+ fell: .*kasaei, pendulum/);
    await page.click('#campaign-replay');
    // In the live world a trial takes two hundred requests, one after the other.
    const live = await page.until((s) => s.trial.outcome !== null, 'the trial', longPatience);
    assert.equal(live.trial.outcome.fallen, true);
    // One that falls ends there in a campaign; in the live world it lies for a while.
    await page.click(`.heat[data-trial="${held.number}"]`);
    await page.click('#campaign-replay');
    const same = (s) => s.trial.outcome?.stateHash === held.state_hash;
    await page.until(same, 'the same state hash', longPatience);
  });

  test('are written as a specification, compared, reported and deleted', async () => {
    const first = await startByForm('all', 'grid');
    await finished(first);
    await page.fold('#campaign-details', true);
    await page.click('#campaign-write');
    const spec = JSON.parse(await page.page.inputValue('#campaign-spec'));
    spec.name = 'no-steps';
    spec.base.strategies = ['ankle'];
    await page.fill('#campaign-spec', JSON.stringify(spec));
    await page.click('#campaign-start-spec');
    await eventually(async () => (await newest()).name === 'no-steps', 'the second campaign');
    const second = (await newest()).id;
    await show(second);
    await page.click(act(first, 'compare'));
    await page.until((s) => s.campaigns.other === first, 'the other campaign');
    const [before, now] = [await trialsOf(first), await trialsOf(second)];
    const lost = before.filter(({ passed }, i) => passed && !now[i].passed).length;
    assert.ok(lost > 0, 'without steps it takes less');
    await page.shows('#campaign-difference', RegExp(`^Of ${now.length} trials .* ${lost} passed there and not here, 0 `));

    const [download] = await Promise.all([
      page.page.waitForEvent('download'),
      page.click(act(second, 'report')),
    ]);
    assert.match(await readFile(await download.path(), 'utf8'), /no-steps: push campaign/);
    await page.click(act(second, 'remove'));
    await page.until((s) => s.campaigns.shown === null, 'the card to go');
    assert.equal((await server.get(`/api/v1/campaigns/${second}`)).status, 404);
  });

  test('tell how far they are, are cancelled, and say what is wrong with one', async () => {
    const id = await startByForm('long', 'grid', { repeats: 500 });
    await page.shows(`[data-campaign="${id}"]`, /running · \d+ of 14000 trials · about/);
    await page.click(act(id, 'cancel'));
    await eventually(async () => (await campaign(id)).state === 'cancelled', 'the end');
    await page.shows(`[data-campaign="${id}"]`, /cancelled · \d+ of 14000 trials/);

    await page.fill('#campaign-phases', 'early');
    await page.click('#campaign-start');
    await page.shows('#campaigns-error', /Moments of the step are numbers between commas/);
    page.expected.push(/(400|422).*\/campaigns$/);
    await page.fill('#campaign-phases', '1.5');
    await page.click('#campaign-start');
    await page.shows('#campaigns-error', /fraction/);
  });

  test('fill while they run, and are read again only when there is more', async () => {
    const asked = { results: 0, list: 0 };
    page.page.on('request', (request) => {
      if (request.url().includes('/results?')) ++asked.results;
      else if (request.url().includes('/campaigns?')) ++asked.list;
    });
    // 28 trials a direction, one direction after the other.
    const id = await startByForm('growing', 'grid', { directions: 360, repeats: 4 });
    await page.click(act(id, 'show'));
    const some = (s) => s.campaigns.shown === id && s.campaigns.trials > 0;
    const first = await page.until(some, 'trials', longPatience);
    await page.shows('#campaign-extent', /^\d+ of 10080 trials so far/);
    await page.click('.heat');
    const { chosen } = (await page.state()).campaigns;
    const { campaigns } = await page.until(
      (s) =>
        s.campaigns.trials > first.campaigns.trials &&
        s.campaigns.curves[0].limits.filter(({ fail }) => fail !== null).length > 2,
      'more trials from more directions',
      longPatience,
    );
    assert.equal((await campaign(id)).state, 'running');
    const places = await page.page.locator('#campaign-polar .mark').count();
    assert.ok(places > 2 && places < 360, `${places} directions`);
    const line = await page.page.locator('#campaign-polar .curve').getAttribute('d');
    assert.match(line, /^M[^Z]*L[^Z]*$/, 'a line that is open where nobody has been pushed from yet');
    assert.equal(campaigns.chosen, chosen);
    assert.equal(await page.page.evaluate(() => document.activeElement.className), 'heat');

    await page.click(act(id, 'cancel'));
    await page.shows('#campaign-extent', /^\d+ of 10080 trials: cancelled/);
    const { done } = await campaign(id);
    await page.until((s) => s.campaigns.trials === done, 'all trials that were run');
    const { results, list } = asked;
    await eventually(() => asked.list > list + 2, 'the list to be read again');
    assert.equal(asked.results, results, 'nothing new, nothing read');
  });
});
