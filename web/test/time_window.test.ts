import { beforeEach, describe, expect, it } from 'vitest';
import { TimeWindow } from '../src/views/time_window';

describe('TimeWindow', () => {
  let window: TimeWindow;

  beforeEach(() => {
    window = new TimeWindow(60);
  });

  it('goes along with the newest time', () => {
    expect(window.range(3)).toEqual([0, 10]);
    expect(window.range(25)).toEqual([15, 25]);
    expect(window.following).toBe(true);
  });

  it('stays where it has been moved to, and follows again at the end', () => {
    window.pan(-5, 0, 25);
    expect(window.range(25)).toEqual([10, 20]);
    expect(window.range(40)).toEqual([10, 20]);
    window.pan(100, 0, 40);
    expect(window.following).toBe(true);
  });

  it('does not leave what there is', () => {
    window.pan(-100, 5, 25);
    expect(window.range(25)).toEqual([5, 15]);
  });

  it('zooms about a time that stays where it is', () => {
    window.pan(-5, 0, 25);
    window.zoom(0.5, 12, 25);
    const [from, to] = window.range(25);
    expect(to - from).toBeCloseTo(5, 12);
    expect((12 - from) / (to - from)).toBeCloseTo(0.2, 12);
  });

  it('keeps following while it zooms, within its limits', () => {
    window.zoom(0.5, 20, 25);
    expect(window.range(25)).toEqual([20, 25]);
    for (let i = 0; i < 30; i += 1) window.zoom(2, null, 25);
    expect(window.span).toBe(60);
    for (let i = 0; i < 30; i += 1) window.zoom(0.5, null, 25);
    expect(window.span).toBe(0.2);
  });

  it('holds, and goes to a time', () => {
    window.hold(25);
    expect(window.range(99)).toEqual([15, 25]);
    window.centreOn(8, 25);
    expect(window.range(25)).toEqual([3, 13]);
    window.reset();
    expect(window.range(25)).toEqual([15, 25]);
  });
});
