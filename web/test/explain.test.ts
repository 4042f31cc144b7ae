import { describe, expect, it } from 'vitest';
import { PushStory } from '../src/explain';
import type { Data, StreamEvent, Values } from '../src/protocol';
import { overlapDepth, roomTowards } from '../src/views/transform';

const states = ['idle', 'initialize', 'single_support', 'double_support'];
const square = [0, 0, 0.2, 0, 0.2, 0.1, 0, 0.1];

function event(kind: string, t: number, values: Record<string, unknown> = {}): StreamEvent {
  return { op: 'event', tick: Math.round(1000 * t), t, kind, text: kind, source: '', values };
}

function frame(t: number, v: Values = {}): Data {
  const standard: Values = {
    state: [2],
    support_side: [1],
    phase_time: [0.1],
    t_ss: [0.4],
    dcm: [0, 0],
    dcm_reference: [0, 0],
    zmp_reference: [0.05, 0.05],
    zmp_command: [0.05, 0.05],
    support_polygon: square,
  };
  return { op: 'data', seq: 0, tick: Math.round(1000 * t), t, v: { ...standard, ...v } };
}

const begun = (): PushStory =>
  new PushStory(event('push_started', 2, { id: 3, impulse_ns: 6, duration_s: 0.1 }));

describe('what is told of a push', () => {
  it('is the ZMP shift that was greatest, of the room that it had', () => {
    const story = begun();
    story.look(frame(2), states);
    story.look(frame(2.1, { zmp_command: [0.11, 0.05] }), states);
    story.look(frame(2.2, { zmp_command: [0.05, 0.06] }), states);
    expect(story.ankle?.shiftM).toBeCloseTo(0.06, 12);
    expect(story.ankle?.roomM).toBeCloseTo(0.15, 12);
  });

  it('is recovery once it has been back for a second, counted from the push', () => {
    const story = begun();
    story.look(frame(2), states);
    story.look(frame(2.6, { dcm: [0.05, 0] }), states);
    story.take(event('step', 2.7, { adjustment: 0.001 }));
    story.take(event('step', 3.1, { adjustment: 0.08 }));
    story.take(event('step', 3.5, { adjustment: 0.01 }));
    story.look(frame(3.5), states);
    expect(story.ending).toBe('watching');
    story.look(frame(3.61), states);
    expect(story.ending).toBe('recovered');
    expect(story.recoveryS).toBeCloseTo(0.5, 12);
    expect(story.stepsToRecover).toBe(2);
  });

  it('is a fall, also when the frames before it come after it', () => {
    const story = begun();
    story.look(frame(2), states);
    story.take(event('fall', 2.5));
    const far = { capture_region: [1, 0, 1.2, 0, 1.2, 0.1, 1, 0.1], reachable_footholds: square };
    story.look(frame(2.2, far), states);
    story.look(frame(4, { ...far, reachable_footholds: [-1, 0, -0.8, 0, -0.8, 0.1] }), states);
    expect(story.ending).toBe('fell');
    expect(story.marginM).toBeCloseTo(-0.8, 12);
    expect(story.lostS).toBe(2.2);
  });

  it('holds the phase of the gait, unless it was seen too late', () => {
    const story = begun();
    story.look(frame(2.01), states);
    expect(story.trigger).toEqual({ phase: 'single_support', leg: 'right', fraction: 0.225 });
    const late = begun();
    late.look(frame(2.2), states);
    expect(late.trigger).toBeNull();
  });

  it('begins with the last frame before the push', () => {
    const story = begun();
    story.look(frame(1.9, { state: [0], angular_momentum: [9, 0] }), states);
    story.look(frame(1.98, { angular_momentum: [3, 0] }), states);
    story.look(frame(1.99, { state: [3], phase_time: [0.02], t_ds: [0.1], angular_momentum: [2, 0] }), states);
    story.look(frame(2.01, { angular_momentum: [2.5, 0] }), states);
    expect(story.trigger).toEqual({ phase: 'double_support', leg: 'right', fraction: 0.3 });
    expect(story.hipNms).toBeCloseTo(0.5, 12);
  });
});

describe('polygons', () => {
  const points = [
    { x: 0, y: 0 },
    { x: 2, y: 0 },
    { x: 2, y: 1 },
    { x: 0, y: 1 },
  ];
  it('tell the room from inside to the edge', () => {
    expect(roomTowards(points, { x: 0.5, y: 0.5 }, { x: 3, y: 0 })).toBeCloseTo(1.5, 12);
    expect(roomTowards(points, { x: 0.5, y: 0.5 }, { x: 0, y: -2 })).toBeCloseTo(0.5, 12);
    expect(roomTowards(points, { x: 3, y: 0.5 }, { x: 1, y: 0 })).toBeNull();
  });

  it('tell how deep they overlap, or how far they are apart', () => {
    const moved = (dx: number): typeof points => points.map(({ x, y }) => ({ x: x + dx, y }));
    expect(overlapDepth(points, moved(1.75))).toBeCloseTo(0.25, 12);
    expect(overlapDepth(points, moved(2.5))).toBeCloseTo(-0.5, 12);
    expect(overlapDepth(points, [])).toBeNull();
  });
});
