import { beforeEach, describe, expect, it, vi } from 'vitest';
import { parseSimulation } from '../src/api';
import { parseMessage } from '../src/protocol';
import type { Data, Hello, StreamEvent } from '../src/protocol';
import { Store } from '../src/store';
import { data, hello } from './messages';

function read<T>(message: unknown): T {
  return parseMessage(JSON.stringify(message)) as T;
}

function event(kind: string, t = 0): StreamEvent {
  return read({ op: 'event', tick: Math.round(t * 1000), t, kind, text: kind, values: {} });
}

describe('Store', () => {
  let store: Store;

  beforeEach(() => {
    store = new Store();
    store.setHello(read<Hello>(hello()));
    store.setConnection({ kind: 'open' });
    store.setRunning(true);
  });

  const frame = (seq: number, t: number, v: Record<string, unknown> = {}): void =>
    store.setFrame(read<Data>(data(seq, t, v)));

  it('keeps the series of measured, reference and error', () => {
    frame(0, 0.01, { dcm: [0.3, 0.1], dcm_reference: [0, 0.5] });
    expect(store.series.last('dcm_x')).toBe(0.3);
    expect(store.series.last('dcm_reference_y')).toBe(0.5);
    expect(store.series.last('dcm_error')).toBeCloseTo(0.5, 12);
    expect(store.series.last('com_x')).toBeNaN();
  });

  it('takes the edges of the support polygon', () => {
    frame(0, 0.01, { support_polygon: [0.1, -0.2, -0.3, 0.4, 0.2, 0.1] });
    const edges = (
      ['polygon_min_x', 'polygon_max_x', 'polygon_min_y', 'polygon_max_y'] as const
    ).map((name) => store.series.last(name));
    expect(edges).toEqual([-0.3, 0.2, -0.2, 0.4]);
  });

  it('does not plot the same time twice, but shows the newest frame', () => {
    frame(0, 0.01, { dcm: [1, 0] });
    frame(1, 0.01, { dcm: [2, 0] });
    expect(store.series.length).toBe(1);
    expect(store.values('dcm')).toEqual([2, 0]);
  });

  it('stays in bounded memory over a long run', () => {
    for (let i = 0; i < 9000; i += 1) {
      frame(i, i / 100, { step_count: [i], left_foot: [i, 0, 0, 0], right_foot: [i, 0, 0, 0] });
      store.addEvent(event('step', i / 100));
    }
    expect(store.series.length).toBe(store.series.capacity);
    expect(store.footprints.length).toBe(40);
    expect(store.events.length).toBe(400);
    expect(store.events[399]?.t).toBeCloseTo(89.99, 9);
  });

  it('tells of a push from its begin on, also by frames that are quicker than the word of it', () => {
    const square = [0, 0, 0.2, 0, 0.2, 0.1, 0, 0.1];
    const at = (t: number, zmp: number, l: number): void =>
      frame(0, t, {
        state: [2],
        support_side: [0],
        phase_time: [t - 1.9],
        t_ss: [0.4],
        angular_momentum: [l, 0],
        zmp_reference: [0.05, 0.05],
        zmp_command: [zmp, 0.05],
        support_polygon: square,
      });
    at(1.97, 0.19, 7);
    at(1.98, 0.05, 1);
    at(2, 0.11, 3);
    at(2.01, 0.06, 3.5);
    store.addEvent({ ...event('push_started', 1.981), values: { id: 4, duration_s: 0.1 } });
    at(2.02, 0.05, 2);
    const { story } = store;
    expect(story?.id).toBe(4);
    expect(story?.trigger).toEqual({ phase: 'single_support', leg: 'left', fraction: 0.203 });
    expect(story?.ankle?.shiftM).toBeCloseTo(0.06, 12);
    expect(story?.hipNms).toBeCloseTo(2.5, 12);
  });

  it('clears everything at a new session', () => {
    frame(0, 5);
    store.addEvent(event('push_started', 5));
    store.addDropped(3);
    store.setHello(read<Hello>(hello('b')));
    expect(store.frame).toBeNull();
    expect(store.series.length).toBe(0);
    expect(store.events).toEqual([]);
    expect(store.story).toBeNull();
    expect(store.framesDropped).toBe(0);
    frame(0, 0.01);
    expect(store.series.length).toBe(1);
    // Of the frames of the session before none is the begin of a push in this one.
    store.addEvent(event('push_started', 5));
    expect(store.story?.hipNms).toBe(0);
  });

  it('pairs joints with the names of hello', () => {
    frame(0, 0.01, { joint_position: [0.5, -0.25] });
    const joints: [string, number][] = [];
    store.eachJoint((name, position) => joints.push([name, position]));
    expect(joints).toEqual([
      ['left_knee', 0.5],
      ['right_knee', -0.25],
    ]);
  });

  it('names the condition: fallen before paused, the connection before both', () => {
    expect(store.condition).toBe('live');
    store.setRunning(false);
    expect(store.condition).toBe('paused');
    frame(0, 0.01, { fallen: [1] });
    expect(store.condition).toBe('fallen');
    store.setConnection({ kind: 'lost', reason: '', retryAt: 0 });
    expect(store.condition).toBe('lost');
    store.setConnection({ kind: 'connecting' });
    expect(store.condition).toBe('connecting');
  });

  it('does not call live what nobody has said to be running', () => {
    store.setConnection({ kind: 'connecting' });
    store.setHello(read<Hello>(hello('b')));
    store.setConnection({ kind: 'open' });
    expect(store.condition).toBe('connecting');
    store.setRunning(false);
    expect(store.condition).toBe('paused');
  });

  it('goes by its own answer when an older heartbeat comes after it', () => {
    store.answerRunning(false, 1000);
    store.hearRunning(true, 1100);
    expect(store.condition).toBe('paused');
    store.hearRunning(true, 2000);
    expect(store.condition).toBe('live');
  });

  it('tells listeners once per change of condition', () => {
    const changed = vi.fn();
    store.on('condition', changed);
    frame(0, 0.01);
    frame(1, 0.02);
    expect(changed).not.toHaveBeenCalled();
    store.setRunning(false);
    store.setRunning(false);
    expect(changed).toHaveBeenCalledTimes(1);
  });

  it('does not take a state of another session', () => {
    store.setSimulation(parseSimulation({ session_id: 'old', running: false }));
    expect(store.simulation).toBeNull();
    expect(store.running).toBe(true);
    store.setSimulation(parseSimulation({ session_id: 'a', running: false }));
    expect(store.running).toBe(false);
  });

  it('names the walking state', () => {
    frame(0, 0.01, { state: [2] });
    expect(store.walkingState).toBe('single_support');
  });

  it('keeps where the feet have landed', () => {
    const feet = { left_foot: [0, 0.1, 0, 0], right_foot: [0.2, -0.1, 0.01, 0.3] };
    frame(0, 0.01, { step_count: [4], support_side: [0], ...feet });
    frame(1, 0.02, { step_count: [5], support_side: [0], ...feet });
    frame(2, 0.03, { step_count: [5], support_side: [1], ...feet });
    expect(store.footprints).toEqual([
      { x: 0.2, y: -0.1, z: 0.01, yaw: 0.3, side: 1, t: 0.02 },
    ]);
  });

  it('looks where its feet look, also across the turn', () => {
    frame(0, 0.01, { left_foot_target: [0, 0, 0, 3.1], right_foot_target: [0, 0, 0, -3.1] });
    expect(Math.cos(store.heading)).toBeCloseTo(-1, 2);
  });
});
