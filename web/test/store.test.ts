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
    for (let i = 0; i < 5000; i += 1) {
      frame(i, i / 100);
      store.addEvent(event('step', i / 100));
    }
    expect(store.series.length).toBe(store.series.capacity);
    expect(store.events.length).toBe(400);
    expect(store.events[399]?.t).toBeCloseTo(49.99, 9);
  });

  it('clears everything at a new session', () => {
    frame(0, 5);
    store.addEvent(event('fall', 5));
    store.addDropped(3);
    store.setHello(read<Hello>(hello('b')));
    expect(store.frame).toBeNull();
    expect(store.series.length).toBe(0);
    expect(store.events).toEqual([]);
    expect(store.framesDropped).toBe(0);
    frame(0, 0.01);
    expect(store.series.length).toBe(1);
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
});
