import { describe, expect, it } from 'vitest';
import { parseRobot } from '../src/api';
import { parseRecorded, parseRecording, pushTimeOf, tagsFrom } from '../src/recording';
import { Replay } from '../src/replay';
import { RingTable } from '../src/ring';
import { meshPath, parseReport, robotNameFrom } from '../src/robot_report';
import { changedOf, matches, parseParameters } from '../src/tuning';
import { overlaidColumn } from '../src/views/overlay';

describe('a recording', () => {
  const world = (seed: number): object => ({
    op: 'world',
    session_id: `s${seed}`,
    config: { robot: 'kasaei', plant: 'lipm', seed, terrain: { kind: 'flat' } },
  });
  const text = [
    world(1),
    { op: 'data', tick: 0, t: 0, v: { 'com.x': 9 } },
    world(2),
    { op: 'event', tick: 10, t: 0.01, kind: 'push_started', text: 'push 1', values: { id: 1 } },
    { op: 'data', tick: 10, t: 0.01, v: { state: 2, 'com.x': 1, 'com.y': null, 'preview[0].x': null } },
    { op: 'data', tick: 20, t: 0.02, v: { state: 2, 'preview[0].x': 3, 'preview[1].x': 4 } },
  ]
    .map((line) => JSON.stringify(line))
    .join('\n');

  it('is its last world, as a live page would have got it', () => {
    const recorded = parseRecorded(text, ['idle']);
    expect(recorded?.hello.sessionId).toBe('s2');
    expect(recorded?.hello.seed).toBe(2);
    expect(recorded?.frames.map(({ v }) => v)).toEqual([
      { state: [2], com: [1, Number.NaN] },
      { state: [2], preview: [3, 4] },
    ]);
    expect(recorded?.hello.channels.find(({ name }) => name === 'com')?.components).toEqual([
      { name: 'x', unit: '' },
      { name: 'y', unit: '' },
    ]);
    expect(recorded === null ? null : pushTimeOf(recorded)).toBe(0.01);
    expect(parseRecorded('', [])).toBeNull();
  });

  it('tells of its own pushes, of the last one by the time shown', () => {
    const walking = { state: 2, 'angular_momentum.x': 0, 'angular_momentum.y': 0 };
    const data = (t: number, x: number): object => ({
      op: 'data',
      tick: Math.round(1000 * t),
      t,
      v: { ...walking, 'angular_momentum.x': x },
    });
    const event = (kind: string, t: number, values: object): object => ({
      op: 'event',
      tick: Math.round(1000 * t),
      t,
      kind,
      values,
    });
    const push = (impulse_ns: number, direction: number[]): object => ({
      op: 'command',
      tick: 0,
      command: { push: { impulse_ns, direction } },
    });
    const lines = [
      { ...world(3), config: { strategies: { hip: true, step: true } } },
      push(9, [0, 1, 0]),
      push(2, [-1, 0, 0]),
      push(3, [1, 0, 0]),
      { op: 'command', tick: 5, command: { strategies: { hip: true, step: false } } },
      data(1, 1),
      data(1.01, 3),
      event('push_started', 1.01, { id: 2, impulse_ns: 2, duration_s: 0.1 }),
      data(1.02, 2),
      event('strategies', 1.5, { hip: 0, step: 1 }),
      event('push_started', 2, { id: 3, impulse_ns: 3, duration_s: 0.1 }),
      data(2.01, 5),
      event('fall', 2.5, {}),
      data(2.6, 50),
    ];
    const recorded = parseRecorded(lines.map((line) => JSON.stringify(line)).join('\n'), []);
    if (recorded === null) throw new Error('no recording');
    const replay = new Replay(parseRecording({}), recorded, parseRobot({}));
    const { store } = replay;
    const told = (): unknown[] => [store.story?.id, store.story?.ending, store.story?.strategies];
    const first = [2, 'pushed again', { hip: true, step: false }];
    expect(told()).toEqual(first);
    expect(store.story?.hipNms).toBe(1);
    replay.seek(2.01);
    expect(told()).toEqual([3, 'fell', { hip: false, step: true }]);
    expect(store.story?.hipNms).toBe(0);
    replay.seek(1.9);
    expect(told()).toEqual(first);
    expect(store.pushes.map(({ id, directionDeg }) => [id, directionDeg])).toEqual([
      [3, 0],
      [2, 180],
      [1, 90],
    ]);
  });

  it('has tags that are typed after commas', () => {
    expect(tagsFrom(' a, b ,,a')).toEqual(['a', 'b']);
  });

  it('is laid over another one at the same time from the push on', () => {
    const table = new RingTable<string>(['t', 'x'], 10);
    for (let i = 0; i < 3; i += 1) table.push({ t: i, x: 10 * i });
    const column = overlaidColumn({ table, shift: 5 }, 'x', Float64Array.of(4.9, 5, 6.25, 7, 7.1));
    expect(Array.from(column)).toEqual([Number.NaN, 0, 12.5, 20, Number.NaN]);
  });
});

describe('parameters', () => {
  const all = parseParameters({
    items: [
      { name: 'gait.t_ss', unit: 's', meaning: 'duration of single support', default: 0.36, value: 0.4 },
      { name: 'hip.in_steps', unit: '', meaning: 'in steps, too', default: false, value: false },
    ],
  });
  it('are found by words of their name and meaning', () => {
    expect(all.filter((one) => matches(one, 'support T_SS')).map(({ name }) => name)).toEqual(['gait.t_ss']);
    expect(all.filter((one) => matches(one, '')).length).toBe(2);
  });
  it('that are changed are what a preset keeps', () => {
    expect(changedOf(all)).toEqual({ 'gait.t_ss': 0.4 });
  });
});

describe('the files of a robot', () => {
  it('are named as the URDF says', () => {
    const urdf = '<mesh filename="package://my/meshes/foot.stl"/><mesh filename="../a/hip.dae"/>';
    expect(meshPath(urdf, 'foot.stl')).toBe('my/meshes/foot.stl');
    expect(meshPath(urdf, 'hip.dae')).toBe('a/hip.dae');
    expect(meshPath(urdf, 'other.stl')).toBe('other.stl');
    expect(robotNameFrom('_My Robot 2.URDF')).toBe('my_robot_2');
  });

  it('are told of with what is odd', () => {
    const { facts, quirks } = parseReport({
      figures: {
        mass_kg: 3.5,
        com_height_m: 0.3,
        single_support: [{ joint: 'knee', needed_nm: 5, limit_nm: 4 }],
      },
      quirks: [{ where: 'foot', what: 'has no sole', answer: 'taken from the mesh' }],
    });
    expect(facts).toContainEqual(['Mass', '3.50 kg']);
    expect(quirks).toEqual([
      'knee is too weak to stand on one leg',
      'foot: has no sole; taken from the mesh',
    ]);
  });
});
