// A trial as a link carries it: the trial specification of docs/trial.md in the address's fragment,
// and how it is run in the live world so that everybody gets the same state hash.

import type { Api, ResetChoice, SimulationState } from './api';
import { formatShort } from './dom';
import { asArray, asBoolean, asNumber, asString, isObject, parseJson } from './json';
import { pushFrom } from './push_body';
import type { PushBody, PushTrigger } from './push_request';
import type { Store } from './store';

export const strategyNames = ['ankle', 'hip', 'step', 'time'] as const;

export interface Walk {
  readonly vx: number;
  readonly vy: number;
  readonly wz: number;
}

export interface TrialSpec {
  readonly robot: string;
  readonly plant: string;
  readonly seed: number;
  /** What control knows of the body; null on the pendulum. */
  readonly state: string | null;
  readonly controlDelayMs: number | null;
  readonly terrain: Readonly<Record<string, unknown>>;
  /** Those that differ from the robot's own; null where the server has none to choose. */
  readonly parameters: Readonly<Record<string, unknown>> | null;
  readonly strategies: readonly string[];
  /** null: it stands. */
  readonly walk: Walk | null;
  readonly settleS: number;
  readonly observeS: number;
  readonly push: PushBody | null;
}

/** A trial in a world like the one that is shown; null until that is known. */
export function trialLike(
  store: Pick<Store, 'simulation' | 'hello'>,
  push: PushBody,
  settleS: number,
  observeS: number,
): TrialSpec | null {
  const { simulation, hello } = store;
  if (simulation === null || hello === null) return null;
  return {
    robot: hello.robot,
    plant: hello.plant,
    seed: hello.seed,
    state: simulation.state,
    controlDelayMs: simulation.controlDelayMs,
    terrain: hello.terrain,
    parameters: simulation.parameters,
    strategies: strategyNames.filter((name) => simulation.strategies[name] === true),
    walk: simulation.walking ? simulation.walk : null,
    settleS,
    observeS,
    push,
  };
}

const prefix = '#trial=';

/** The specification as `stagger trial` reads it. */
export function trialJson(spec: TrialSpec): Record<string, unknown> {
  return {
    robot: spec.robot,
    plant: spec.plant,
    seed: spec.seed,
    ...(spec.state === null ? {} : { state: spec.state }),
    ...(spec.controlDelayMs === null ? {} : { control_delay_ms: spec.controlDelayMs }),
    terrain: spec.terrain,
    ...(spec.parameters === null ? {} : { parameters: spec.parameters }),
    strategies: spec.strategies,
    ...(spec.walk === null ? { stand: true } : { walk: spec.walk }),
    settle_s: spec.settleS,
    observe_s: spec.observeS,
    ...(spec.push === null ? {} : { push: spec.push }),
  };
}

export function trialLink(page: string, spec: TrialSpec): string {
  return page.replace(/#.*$/, '') + prefix + encodeURIComponent(JSON.stringify(trialJson(spec)));
}

/** The trial of an address's fragment, or null when there is none that can be read. */
export function trialFrom(fragment: string): TrialSpec | null {
  if (!fragment.startsWith(prefix)) return null;
  let text: string;
  try {
    text = decodeURIComponent(fragment.slice(prefix.length));
  } catch {
    return null;
  }
  return trialFromJson(parseJson(text));
}

/** The trial of a specification, or null when it is none that a link can carry. */
export function trialFromJson(json: unknown): TrialSpec | null {
  if (!isObject(json) || asString(json['robot']) === '') return null;
  const walk = isObject(json['walk']) ? json['walk'] : {};
  const { push, terrain, state, parameters, control_delay_ms: delay } = json;
  return {
    robot: asString(json['robot']),
    plant: asString(json['plant'], 'bullet'),
    seed: asNumber(json['seed'], 1),
    state: typeof state === 'string' ? state : null,
    controlDelayMs: typeof delay === 'number' ? delay : null,
    terrain: isObject(terrain) ? terrain : { kind: 'flat' },
    parameters: isObject(parameters) ? parameters : null,
    strategies: Array.isArray(json['strategies'])
      ? asArray(json['strategies']).map((name) => asString(name))
      : strategyNames,
    walk: asBoolean(json['stand'])
      ? null
      : { vx: asNumber(walk['vx']), vy: asNumber(walk['vy']), wz: asNumber(walk['wz']) },
    settleS: asNumber(json['settle_s'], 3),
    observeS: asNumber(json['observe_s'], 4),
    push: isObject(push) ? pushFrom(push) : null,
  };
}

/** One line for people. */
export function trialTitle(spec: TrialSpec): string {
  const { push, walk } = spec;
  const moves =
    walk === null
      ? 'stands'
      : walk.vx === 0 && walk.vy === 0 && walk.wz === 0
        ? 'steps in place'
        : `walks at (${walk.vx}, ${walk.vy}) m/s, turning ${walk.wz} rad/s`;
  const way =
    push?.direction === undefined
      ? `${push?.direction_deg ?? 0}°`
      : `(${push.direction.map((part) => Number(part.toFixed(3))).join(', ')})`;
  const strength =
    push?.impulse_ns === undefined
      ? `${formatShort(push?.force_n ?? 0, 3)} N`
      : `${formatShort(push.impulse_ns, 3)} N s`;
  const pushed = push === null ? 'no push' : `${strength} at ${way}${pushTime(push)}`;
  const plant = spec.plant === 'lipm' ? 'pendulum' : 'full body';
  return `${spec.robot}, ${plant}, seed ${spec.seed}: ${moves}; ${pushed}`;
}

function pushTime(push: PushBody): string {
  const trigger: PushTrigger | undefined = push.trigger;
  if (trigger !== undefined) {
    const leg = trigger.leg === undefined ? '' : ` on the ${trigger.leg} leg`;
    return ` at ${Math.round(100 * trigger.fraction)} % of ${trigger.phase.replace('_', ' ')}${leg}`;
  }
  return push.at_s === undefined ? '' : ` at ${push.at_s} s`;
}

export interface TrialOutcome {
  readonly stateHash: string;
  readonly ticks: number;
  readonly fallen: boolean;
  readonly reason: string;
}

const tickS = 0.001;
/** So many ticks are done at a time, and no faster than they last: people want to see them. */
const sliceTicks = 40;
/** How long a push may wait for its phase or time beyond the settling [s]; as in a trial. */
const patienceS = 10;

function ticksOf(seconds: number): number {
  return Math.round(seconds / tickS);
}

/** What runs a trial needs of the world; a test gives its own. */
export type TrialApi = Pick<
  Api,
  'pause' | 'reset' | 'setStrategies' | 'walk' | 'step' | 'push' | 'readPush' | 'simulation'
>;

/**
 * Runs the trial in the live world: a fresh world, every command at a fixed tick, and a stop at a
 * fixed tick. The world stays paused there. `progress` is told in words.
 */
export async function runTrial(
  api: TrialApi,
  spec: TrialSpec,
  progress: (text: string) => void,
  pause: (ms: number) => Promise<void> = (ms) => new Promise((done) => setTimeout(done, ms)),
): Promise<TrialOutcome> {
  await api.pause();
  progress('Building the world…');
  await api.setStrategies(
    Object.fromEntries(strategyNames.map((name) => [name, spec.strategies.includes(name)])),
  );
  const choice: ResetChoice = {
    robot: spec.robot,
    plant: spec.plant,
    seed: spec.seed,
    terrain: spec.terrain,
    ...(spec.parameters === null ? {} : { parameters: spec.parameters }),
    ...(spec.state === null ? {} : { state: spec.state }),
    ...(spec.controlDelayMs === null ? {} : { control_delay_ms: spec.controlDelayMs }),
  };
  let { tick } = await api.reset(choice);
  if (spec.walk !== null) await api.walk(spec.walk);

  const run = async (until: number, words: string): Promise<void> => {
    while (tick < until) {
      progress(`${words} ${(tick * tickS).toFixed(1)} s`);
      const ticks = Math.min(sliceTicks, until - tick);
      const begun = performance.now();
      ({ tick } = await api.step(ticks));
      await pause(Math.max(0, ticks - (performance.now() - begun)));
    }
  };

  await run(ticksOf(spec.settleS), 'Settling:');
  if (spec.push !== null) {
    const { id } = await api.push(spec.push);
    const latest = tick + ticksOf(patienceS + (spec.push.at_s ?? 0));
    let push = await api.readPush(id);
    while (push.startTick === null && tick < latest) {
      // A push at once or at a time acts at its tick however long a slice is.
      await run(Math.min(latest, tick + sliceTicks), 'Waiting for the push:');
      push = await api.readPush(id);
    }
    if (push.startTick !== null) {
      await run(push.startTick + Math.ceil(push.durationS / tickS - 1e-9), 'Push:');
    }
    // The observation begins where the push has ended, whichever slice saw that.
    const begin = push.startTick === null ? tick : push.startTick + ticksOf(push.durationS);
    await run(begin + ticksOf(spec.observeS), 'Observing:');
  } else {
    await run(tick + ticksOf(spec.observeS), 'Observing:');
  }
  return outcome(await api.simulation());
}

function outcome(state: SimulationState): TrialOutcome {
  return {
    stateHash: state.stateHash,
    ticks: state.tick,
    fallen: state.fallen,
    reason: state.fallReason,
  };
}
