import { describe, expect, it } from 'vitest';
import { parseSimulation } from '../src/api';
import { parsePush } from '../src/push_body';
import type { PushBody } from '../src/push_request';
import { runTrial, trialFrom, trialJson, trialLink, trialTitle } from '../src/trial';
import type { TrialApi, TrialSpec } from '../src/trial';

const spec: TrialSpec = {
  robot: 'kasaei',
  plant: 'bullet',
  seed: 7,
  state: 'estimated',
  controlDelayMs: 1,
  terrain: { kind: 'slope', angle_deg: 5 },
  parameters: { 'gait.t_ss': 0.4 },
  strategies: ['ankle', 'step'],
  walk: { vx: 0.2, vy: 0, wz: -0.1 },
  settleS: 0.1,
  observeS: 0.2,
  push: {
    link: 'torso',
    point: [0, 0.1, 0.2],
    direction: [0.6, 0.8, 0],
    impulse_ns: 6.25,
    duration_s: 0.05,
    profile: 'half_sine',
    trigger: { phase: 'single_support', leg: 'left', fraction: 0.25 },
  },
};

describe('a link', () => {
  it('carries the trial whole', () => {
    const link = trialLink('http://127.0.0.1:8080/#old', spec);
    expect(link.startsWith('http://127.0.0.1:8080/#trial=')).toBe(true);
    expect(trialFrom(new URL(link).hash)).toEqual(spec);
    const standing: TrialSpec = {
      ...spec,
      walk: null,
      push: null,
      state: null,
      parameters: null,
    };
    expect(trialFrom(new URL(trialLink('http://a/', standing)).hash)).toEqual(standing);
  });

  it('is what `stagger trial` reads', () => {
    expect(trialJson(spec)).toMatchObject({ robot: 'kasaei', settle_s: 0.1, walk: { vx: 0.2 } });
    expect(trialJson({ ...spec, walk: null })).toMatchObject({ stand: true });
    expect(trialJson({ ...spec, walk: null })).not.toHaveProperty('walk');
  });

  it('that cannot be read is none', () => {
    for (const hash of ['', '#x', '#trial=', '#trial=%', '#trial=[]', '#trial={"seed":1}']) {
      expect(trialFrom(hash)).toBeNull();
    }
  });

  it('is told in one line', () => {
    expect(trialTitle(spec)).toMatch(/kasaei, full body, seed 7: walks .*6\.25 N s at \(0\.6, 0\.8, 0\) at 25 % of single support on the left leg/);
  });
});

/** A world that only counts: what was asked of it, and when. */
class CountingWorld implements TrialApi {
  tick = 500;
  readonly calls: string[] = [];
  private start: number | null = null;
  private body: PushBody = {};

  /** `wait`: ticks from the push's request until its trigger comes. */
  constructor(private readonly wait: number) {}

  private answer(call: string): Promise<{ tick: number; timeS: number }> {
    this.calls.push(`${call}@${this.tick}`);
    return Promise.resolve({ tick: this.tick, timeS: this.tick * 0.001 });
  }
  pause(): ReturnType<TrialApi['pause']> {
    return this.answer('pause');
  }
  reset(choice: object): ReturnType<TrialApi['reset']> {
    this.tick = 0;
    return this.answer(`reset ${JSON.stringify(choice)}`);
  }
  async setStrategies(change: Readonly<Record<string, boolean>>): Promise<void> {
    await this.answer(`strategies ${JSON.stringify(change)}`);
  }
  walk(): ReturnType<TrialApi['walk']> {
    return this.answer('walk');
  }
  step(ticks: number): ReturnType<TrialApi['step']> {
    this.tick += ticks;
    return Promise.resolve({ tick: this.tick, timeS: this.tick * 0.001 });
  }
  async push(body: PushBody): ReturnType<TrialApi['push']> {
    await this.answer('push');
    this.start = this.tick + this.wait;
    this.body = body;
    return this.readPush();
  }
  readPush(): ReturnType<TrialApi['readPush']> {
    const started = this.start !== null && this.tick > this.start;
    const startTick = started ? this.start : null;
    return Promise.resolve(parsePush({ id: 1, spec: this.body, start_tick: startTick }));
  }
  simulation(): ReturnType<TrialApi['simulation']> {
    return Promise.resolve(parseSimulation({ tick: this.tick, state_hash: 'ab' }));
  }
}

describe('runTrial', () => {
  const run = (world: CountingWorld, trial: TrialSpec): ReturnType<typeof runTrial> =>
    runTrial(
      world,
      trial,
      () => undefined,
      () => Promise.resolve(),
    );

  it('gives every command at its tick, whatever the slices', async () => {
    const world = new CountingWorld(0);
    const { ticks, stateHash } = await run(world, spec);
    expect(stateHash).toBe('ab');
    expect(ticks).toBe(100 + 50 + 200);
    expect(world.calls.map((call) => call.replace(/ .*@/, '@'))).toEqual([
      'pause@500',
      'strategies@500',
      'reset@0',
      'walk@0',
      'push@100',
    ]);
    expect(world.calls[1]).toContain('"ankle":true,"hip":false,"step":true,"time":false');
    expect(world.calls[2]).toContain('"seed":7');
  });

  it('counts the observation from the end of a push that had to wait', async () => {
    for (const wait of [3, 39, 40, 41, 1234]) {
      const { ticks } = await run(new CountingWorld(wait), spec);
      expect(ticks).toBe(100 + wait + 50 + 200);
    }
  });

  it('does not wait for ever', async () => {
    const { ticks } = await run(new CountingWorld(1e9), spec);
    expect(ticks).toBe(100 + 10000 + 200);
  });

  it('stands and is not pushed when nothing else is said', async () => {
    const world = new CountingWorld(0);
    const { ticks } = await run(world, { ...spec, walk: null, push: null });
    expect(ticks).toBe(300);
    expect(world.calls.some((call) => /^(walk|push)/.test(call))).toBe(false);
  });
});
