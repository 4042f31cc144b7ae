// Campaigns (docs/campaign.md): what the server says of one, its trials, and the push limits and
// survival that they amount to.

import { localTime } from './dom';
import { asArray, asNumber, asNumberOrNull, asNumbers, asString, isObject, parseJson } from './json';
import type { JsonObject } from './json';

/** What the server says of a campaign. */
export interface CampaignInfo {
  readonly id: string;
  readonly name: string;
  readonly created: string;
  readonly state: string;
  readonly done: number;
  readonly total: number;
  /** A bisection may need fewer trials than `total`. */
  readonly totalIsMost: boolean;
  readonly recovered: number;
  readonly fell: number;
  readonly timeout: number;
  readonly invalid: number;
  readonly etaS: number | null;
  /** Do its thresholds hold? null: it is not at its end. */
  readonly passed: boolean | null;
  readonly error: string;
}

export function parseCampaign(value: unknown): CampaignInfo {
  const body: JsonObject = isObject(value) ? value : {};
  const { passed } = body;
  return {
    id: asString(body['id']),
    name: asString(body['name']),
    created: asString(body['created']),
    state: asString(body['state']),
    done: asNumber(body['done']),
    total: asNumber(body['total']),
    totalIsMost: body['total_is_most'] === true,
    recovered: asNumber(body['recovered']),
    fell: asNumber(body['fell']),
    timeout: asNumber(body['timeout']),
    invalid: asNumber(body['invalid']),
    etaS: asNumberOrNull(body['eta_s']),
    passed: typeof passed === 'boolean' ? passed : null,
    error: asString(body['error']),
  };
}

/** For people: campaigns may share a name. */
export function campaignTitle({ name, created }: CampaignInfo): string {
  return `${name}, ${localTime(created)}`;
}

/** May trials be missing? */
export function isPartial({ state }: CampaignInfo): boolean {
  return state !== 'done';
}

/** Does it still change by itself? */
export function isUnderWay({ state }: CampaignInfo): boolean {
  return ['queued', 'running', 'cancelling'].includes(state);
}

/** Is there, or will there be, something to see? */
export function canBeShown(info: CampaignInfo): boolean {
  return info.done > 0 || isUnderWay(info);
}

/** What is new of a campaign since it was shown: trials, its state alone, or nothing. */
export function newsOf(shown: CampaignInfo, now: CampaignInfo): 'trials' | 'state' | 'nothing' {
  if (now.done !== shown.done) return 'trials';
  return now.state === shown.state ? 'nothing' : 'state';
}

/** How many trials have been run, and of how many while that is not all. */
export function trialCount({ state, done, total, totalIsMost }: CampaignInfo): string {
  return state === 'done' ? `${done} trials` : `${done} of ${totalIsMost ? 'at most ' : ''}${total} trials`;
}

/** On how many trials stands what is shown of it? */
export function extentOf(info: CampaignInfo): string {
  if (isUnderWay(info)) return `${trialCount(info)} so far`;
  return info.state === 'done' ? trialCount(info) : `${trialCount(info)}: ${info.state}`;
}

/** One trial of the results. */
export interface CampaignTrial {
  readonly number: number;
  /** What was set, with the repeat: the same in two campaigns makes a pair. */
  readonly key: string;
  /** What was set beside direction and hardness, in words. */
  readonly series: string;
  /** From the heading, 0 to 360 [deg]; null: it is not pushed, or several times. */
  readonly directionDeg: number | null;
  readonly outcome: string;
  readonly passed: boolean;
  readonly reason: string;
  readonly fr: number | null;
  readonly deltaV: number | null;
  /** What the pendulum could take at most, as Fr. */
  readonly ceilingFr: number | null;
  /** As `stagger trial` reads it. */
  readonly spec: JsonObject;
}

const hardness = ['push.fr', 'push.delta_v', 'push.impulse_ns', 'push.force_n'];

function words(path: string, value: unknown): string {
  const name = path.split('.').at(-1) ?? path;
  if (isObject(value)) {
    return Object.entries(value)
      .map(([part, of]) => words(part, of))
      .join(', ');
  }
  return `${name} ${typeof value === 'string' ? value : JSON.stringify(value)}`;
}

function parseTrial(line: string): CampaignTrial[] {
  const body = parseJson(line);
  if (!isObject(body) || !isObject(body['spec'])) return [];
  const { spec } = body;
  const values: JsonObject = isObject(body['values']) ? body['values'] : {};
  const push: JsonObject = isObject(spec['push']) ? spec['push'] : {};
  const [x, y] = asNumbers(push['direction']);
  const degrees = x === undefined || y === undefined ? null : (Math.atan2(y, x) * 180) / Math.PI;
  const fr = asNumberOrNull(body['fr']);
  const deltaV = asNumberOrNull(body['delta_v']);
  const ceiling = asNumberOrNull(body['ceiling_dv']);
  const others = Object.entries(values).filter(
    ([path]) => path !== 'push.direction_deg' && !hardness.includes(path),
  );
  return [
    {
      number: asNumber(body['number']),
      key: JSON.stringify([Object.entries(values).sort(), body['repeat']]),
      series: others.map(([path, value]) => words(path, value)).join(', '),
      directionDeg: degrees === null ? null : Math.round(((degrees + 360) % 360) * 100) / 100,
      outcome: asString(body['outcome']),
      passed: body['passed'] === true,
      reason: asString(body['reason']),
      fr,
      deltaV,
      ceilingFr:
        fr === null || deltaV === null || ceiling === null || deltaV === 0
          ? null
          : (ceiling * fr) / deltaV,
      spec,
    },
  ];
}

/** Trials of a file of results, a line of JSON each. */
export function parseTrials(ndjson: string): CampaignTrial[] {
  return ndjson.split('\n').flatMap((line) => (line === '' ? [] : parseTrial(line)));
}

/** How hard a push in one direction may be, as Fr. */
export interface Limit {
  readonly directionDeg: number;
  /** The greatest below `fail` that all pass; null: not even the least. */
  readonly pass: number | null;
  /** The least that any does not pass; null: none was so hard. */
  readonly fail: number | null;
  readonly ceiling: number | null;
  /** Who did not pass first, or else the hardest that passed. */
  readonly trial: CampaignTrial;
}

export interface LimitCurve {
  readonly series: string;
  readonly limits: readonly Limit[];
}

/** Those that are limits already: while trials are missing, a direction in which none has failed may
 * hold more. */
export function knownLimits(limits: readonly Limit[], partial: boolean): readonly Limit[] {
  return partial ? limits.filter(({ fail }) => fail !== null) : limits;
}

function grouped<T>(items: readonly T[], key: (item: T) => string): Map<string, T[]> {
  const groups = new Map<string, T[]>();
  for (const item of items) {
    const group = groups.get(key(item));
    if (group === undefined) groups.set(key(item), [item]);
    else group.push(item);
  }
  return groups;
}

function limitOf(directionDeg: number, trials: readonly CampaignTrial[]): Limit | null {
  const sorted = [...trials].sort((a, b) => (a.fr ?? 0) - (b.fr ?? 0) || a.number - b.number);
  const failed = sorted.find(({ passed }) => !passed);
  const fail = failed?.fr ?? null;
  const held = sorted.filter(({ passed, fr }) => passed && (fail === null || (fr ?? 0) < fail));
  const hardest = held.at(-1);
  const trial = failed ?? hardest;
  if (trial === undefined) return null;
  return {
    directionDeg,
    pass: hardest?.fr ?? null,
    fail,
    ceiling: trial.ceilingFr,
    trial,
  };
}

/** Only what says something of the robot: neither a push that never came nor a trial that cannot run. */
const counts = ({ outcome, fr, directionDeg }: CampaignTrial): boolean =>
  (outcome === 'recovered' || outcome === 'fell') && fr !== null && directionDeg !== null;

/** Push limits over the directions, a curve for all else that was set. */
export function limitCurves(trials: readonly CampaignTrial[]): LimitCurve[] {
  return [...grouped(trials.filter(counts), ({ series }) => series)].map(([series, members]) => ({
    series,
    limits: [...grouped(members, ({ directionDeg }) => String(directionDeg))]
      .map(([direction, of]) => limitOf(Number(direction), of))
      .filter((limit) => limit !== null)
      .sort((a, b) => a.directionDeg - b.directionDeg),
  }));
}

export interface SurvivalCell {
  readonly passed: number;
  readonly trials: number;
  /** Who did not pass first, or else the first. */
  readonly trial: CampaignTrial;
}

export interface Survival {
  readonly directionsDeg: readonly number[];
  readonly frs: readonly number[];
  /** A row for each Fr, a cell for each direction; null: nobody tried. */
  readonly rows: readonly (readonly (SurvivalCell | null)[])[];
}

const frDigits = 4;

/** How many of those that were pushed so hard from there passed, whatever else was set. */
export function survivalOf(trials: readonly CampaignTrial[]): Survival {
  const members = trials.filter(counts);
  const frOf = ({ fr }: CampaignTrial): number => Number((fr ?? 0).toFixed(frDigits));
  const ascending = (values: number[]): number[] => [...new Set(values)].sort((a, b) => a - b);
  const directionsDeg = ascending(members.map(({ directionDeg }) => directionDeg ?? 0));
  const frs = ascending(members.map(frOf));
  const cells = grouped(members, (trial) => `${trial.directionDeg ?? 0} ${frOf(trial)}`);
  return {
    directionsDeg,
    frs,
    rows: frs.map((fr) =>
      directionsDeg.map((direction) => {
        const of = cells.get(`${direction} ${fr}`) ?? [];
        const trial = of.find(({ passed }) => !passed) ?? of[0];
        if (trial === undefined) return null;
        return { passed: of.filter(({ passed }) => passed).length, trials: of.length, trial };
      }),
    ),
  };
}

export interface Comparison {
  readonly pairs: number;
  /** Passed in the first and not in the second. */
  readonly lost: readonly CampaignTrial[];
  readonly won: readonly CampaignTrial[];
}

/** Trials of `b` beside those of `a` for which the same was set. */
export function compare(
  a: readonly CampaignTrial[],
  b: readonly CampaignTrial[],
): Comparison {
  const before = new Map(a.map((trial) => [trial.key, trial]));
  const pairs = b.flatMap((after) => {
    const first = before.get(after.key);
    return first === undefined ? [] : [{ first, after }];
  });
  return {
    pairs: pairs.length,
    lost: pairs.filter(({ first, after }) => first.passed && !after.passed).map((p) => p.after),
    won: pairs.filter(({ first, after }) => !first.passed && after.passed).map((p) => p.after),
  };
}

/** What the form asks. */
export interface CampaignChoice {
  readonly name: string;
  readonly robot: string;
  readonly plant: string;
  /** Halve towards the limit of each direction, or push with every hardness. */
  readonly kind: 'bisect' | 'grid';
  readonly directions: number;
  /** Shares of the left leg's single support. */
  readonly phases: readonly number[];
  readonly durationS: number;
  /** As Fr. */
  readonly from: number;
  readonly to: number;
  readonly step: number;
  readonly repeats: number;
}

const digits = (value: number): number => Number(value.toFixed(6));

/** The specification, as POST /api/v1/campaigns takes it. */
export function campaignSpec(choice: CampaignChoice): Record<string, unknown> {
  const { from, to, step, repeats } = choice;
  const levels = Math.max(1, Math.floor((to - from) / step + 1e-9) + 1);
  return {
    version: 1,
    name: choice.name,
    base: {
      robot: choice.robot,
      plant: choice.plant,
      push: {
        duration_s: choice.durationS,
        trigger: { phase: 'single_support', leg: 'left', fraction: 0.1 },
      },
    },
    design:
      choice.kind === 'bisect'
        ? { kind: 'bisect', axis: 'push.fr', lo: from, hi: to, tol: step, repeats }
        : { kind: 'grid', repeats },
    factors: {
      'push.direction_deg': Array.from({ length: choice.directions }, (_, i) =>
        digits((360 * i) / choice.directions),
      ),
      'push.trigger.fraction': choice.phases,
      ...(choice.kind === 'grid'
        ? { 'push.fr': Array.from({ length: levels }, (_, i) => digits(from + i * step)) }
        : {}),
    },
    pass: { recover_within_s: 4 },
  };
}

/** Numbers between commas; null when one is none. */
export function numbersFrom(text: string): number[] | null {
  const parts = text.split(',').map((part) => part.trim());
  const values = parts.map((part) => (part === '' ? Number.NaN : Number(part)));
  return values.every(Number.isFinite) ? values : null;
}

export function campaignsFrom(answer: unknown): CampaignInfo[] {
  return asArray(isObject(answer) ? answer['items'] : undefined).map(parseCampaign);
}
