import { describe, expect, it } from 'vitest';
import {
  campaignSpec,
  canBeShown,
  compare,
  extentOf,
  isUnderWay,
  knownLimits,
  limitCurves,
  newsOf,
  numbersFrom,
  parseCampaign,
  parseTrials,
  survivalOf,
} from '../src/campaign';
import type { CampaignChoice } from '../src/campaign';
import { factsOf, roughly } from '../src/panels/campaign_row';
import { linePath, polarPlace, ringStep } from '../src/views/polar';

interface Told {
  number?: number;
  fr?: number;
  degrees?: number;
  fraction?: number;
  passed?: boolean;
  outcome?: string;
  repeat?: number;
}

function line(told: Told): string {
  const { number = 0, fr = 0.1, degrees = 0, fraction = 0.1, passed = true, repeat = 0 } = told;
  const angle = (degrees * Math.PI) / 180;
  return JSON.stringify({
    number,
    repeat,
    values: { 'push.direction_deg': degrees, 'push.trigger.fraction': fraction, 'push.fr': fr },
    outcome: told.outcome ?? (passed ? 'recovered' : 'fell'),
    passed,
    reason: passed ? '' : 'the torso leans too far',
    fr,
    delta_v: 3 * fr,
    ceiling_dv: 1.5,
    spec: { robot: 'kasaei', push: { direction: [Math.cos(angle), Math.sin(angle), 0] } },
  });
}

const trials = (...told: Told[]) => parseTrials(told.map(line).join('\n') + '\n');

describe('results of a campaign', () => {
  it('are read line by line, with what was set in words', () => {
    const [trial] = trials({ number: 7, degrees: 270, fr: 0.2 });
    expect(trial).toMatchObject({
      number: 7,
      directionDeg: 270,
      series: 'fraction 0.1',
      fr: 0.2,
      ceilingFr: 0.5,
      outcome: 'recovered',
    });
    expect(parseTrials('nonsense\n{}\n')).toEqual([]);
  });

  it('give the limit below the lowest level at which any fails', () => {
    const [curve] = limitCurves(
      trials(
        { fr: 0.1 },
        { fr: 0.2 },
        { fr: 0.3, passed: false, number: 5, repeat: 1 },
        { fr: 0.3, repeat: 0 },
        { fr: 0.4 }, // survival need not be monotone
        { fr: 0.1, degrees: 90, passed: false },
        { fr: 0.1, degrees: 180 },
      ),
    );
    expect(curve?.limits.map(({ directionDeg, pass, fail }) => [directionDeg, pass, fail])).toEqual([
      [0, 0.2, 0.3],
      [90, null, 0.1],
      [180, 0.1, null],
    ]);
    expect(curve?.limits[0]?.trial.number).toBe(5);
  });

  it('are limits only where something has failed, as long as trials are missing', () => {
    const [curve] = limitCurves(
      trials({ fr: 0.1 }, { fr: 0.2, passed: false }, { fr: 0.1, degrees: 90 }),
    );
    const directions = (partial: boolean) =>
      knownLimits(curve?.limits ?? [], partial).map(({ directionDeg }) => directionDeg);
    expect([directions(false), directions(true)]).toEqual([[0, 90], [0]]);
  });

  it('make a curve for each moment, and leave out what says nothing', () => {
    const curves = limitCurves(
      trials({ fraction: 0.1 }, { fraction: 0.5 }, { fraction: 0.9, outcome: 'timeout' }),
    );
    expect(curves.map(({ series }) => series)).toEqual(['fraction 0.1', 'fraction 0.5']);
  });

  it('make a map of who passes', () => {
    const { directionsDeg, frs, rows } = survivalOf(
      trials(
        { fr: 0.1 },
        { fr: 0.1, repeat: 1, passed: false, number: 3 },
        { fr: 0.2, degrees: 90 },
      ),
    );
    expect([directionsDeg, frs]).toEqual([[0, 90], [0.1, 0.2]]);
    expect(rows[0]?.[0]).toMatchObject({ passed: 1, trials: 2, trial: { number: 3 } });
    expect(rows[0]?.[1]).toBeNull();
    expect(rows[1]?.[1]).toMatchObject({ passed: 1, trials: 1 });
  });

  it('are compared where the same was set', () => {
    const a = trials({ fr: 0.1 }, { fr: 0.2 }, { fr: 0.3, passed: false });
    const b = trials({ fr: 0.1 }, { fr: 0.2, passed: false, number: 9 }, { fr: 0.3 }, { fr: 0.4 });
    const { pairs, lost, won } = compare(a, b);
    expect([pairs, lost.map(({ number }) => number), won.length]).toEqual([3, [9], 1]);
  });
});

describe('a campaign of the list', () => {
  const told = {
    id: '4', name: 'omni', state: 'running', done: 10, total: 40, total_is_most: true, fell: 2,
    eta_s: 300, passed: null,
  };

  it('tells how far it is', () => {
    const info = parseCampaign(told);
    expect([isUnderWay(info), canBeShown(info)]).toEqual([true, true]);
    expect(factsOf(info)).toBe('running · 10 of at most 40 trials · about 5 min to go · 2 fell');
    const done = parseCampaign({ ...told, state: 'done', done: 40, eta_s: null, passed: false });
    expect([isUnderWay(done), canBeShown(done)]).toEqual([false, true]);
    expect(factsOf(done)).toBe('done · 40 trials · 2 fell · a threshold failed');
    expect([12.2, 600, 9000].map(roughly)).toEqual(['13 s', '10 min', '2.5 h']);
  });

  it('tells on how many trials stands what is shown of it', () => {
    const extent = (change: object): string => extentOf(parseCampaign({ ...told, ...change }));
    const counted = { total_is_most: false, done: 12, total: 96 };
    expect(extent({})).toBe('10 of at most 40 trials so far');
    expect(extent(counted)).toBe('12 of 96 trials so far');
    expect(extent({ ...counted, state: 'queued', done: 0 })).toBe('0 of 96 trials so far');
    expect(extent({ ...counted, state: 'interrupted' })).toBe('12 of 96 trials: interrupted');
    expect(extent({ ...counted, state: 'done', done: 96 })).toBe('96 trials');
  });

  it('has its trials read again only when there are more', () => {
    const news = (change: object): string =>
      newsOf(parseCampaign(told), parseCampaign({ ...told, eta_s: 200, ...change }));
    expect(news({})).toBe('nothing');
    expect(news({ state: 'cancelling' })).toBe('state');
    expect(news({ state: 'done', done: 11 })).toBe('trials');
  });

  it('can be shown from its beginning, and afterwards if any trial has been run', () => {
    const shown = (state: string, done: number): boolean =>
      canBeShown(parseCampaign({ ...told, state, done }));
    expect([shown('queued', 0), shown('failed', 3), shown('cancelled', 0)]).toEqual([true, true, false]);
  });
});

describe('the form', () => {
  const choice: CampaignChoice = {
    name: 'a', robot: 'kasaei', plant: 'lipm', kind: 'bisect', directions: 3, phases: [0.1, 0.5],
    durationS: 0.05, from: 0.1, to: 0.3, step: 0.1, repeats: 2,
  };

  it('asks for a bisection or for every hardness', () => {
    expect(campaignSpec(choice)).toMatchObject({
      design: { kind: 'bisect', axis: 'push.fr', lo: 0.1, hi: 0.3, tol: 0.1, repeats: 2 },
      factors: { 'push.direction_deg': [0, 120, 240], 'push.trigger.fraction': [0.1, 0.5] },
    });
    expect(campaignSpec({ ...choice, kind: 'grid' })).toMatchObject({
      design: { kind: 'grid', repeats: 2 },
      factors: { 'push.fr': [0.1, 0.2, 0.3] },
    });
  });

  it('reads numbers between commas', () => {
    expect(numbersFrom('0.1, 0.5')).toEqual([0.1, 0.5]);
    expect(numbersFrom('0.1,, 0.5')).toBeNull();
    expect(numbersFrom('early')).toBeNull();
  });
});

describe('the polar plot', () => {
  it('has forward above and left to the left', () => {
    const [x, y] = polarPlace(90, 1);
    expect(x).toBeLessThan(160);
    expect(y).toBeCloseTo(160);
    expect(polarPlace(0, 1)[1]).toBeLessThan(160);
  });

  it('joins directions all round, but not over those that have not been pushed from yet', () => {
    const at = (...directionsDeg: number[]) =>
      directionsDeg.map((directionDeg) => ({ directionDeg, share: 1 }));
    const shape = (path: string): string => path.replace(/[^MLZ]/g, '');
    expect(shape(linePath(at(0), true))).toBe('');
    expect(shape(linePath(at(0, 30, 60), false))).toBe('MLLZ');
    expect(shape(linePath(at(0, 30, 60), true))).toBe('MLL');
    expect(shape(linePath(at(0, 120, 240), true))).toBe('MLLZ');
    // 300 to 0 to 60, and 150 to 180.
    expect(shape(linePath(at(0, 30, 60, 150, 180, 330), true))).toBe('MLLMLML');
  });

  it('has five rings at most', () => {
    expect([0.05, 0.3, 0.34, 7].map(ringStep)).toEqual([0.01, 0.1, 0.1, 2]);
  });
});
