import { describe, expect, it } from 'vitest';
import { RingTable } from '../src/ring';

describe('RingTable', () => {
  it('keeps the newest rows in order once it is full', () => {
    const ring = new RingTable(['t', 'x'], 3);
    for (let i = 0; i < 8; i += 1) ring.push({ t: i, x: 10 * i });
    expect(ring.length).toBe(3);
    expect([...ring.view('t')]).toEqual([5, 6, 7]);
    expect([...ring.view('x')]).toEqual([50, 60, 70]);
    expect(ring.last('x')).toBe(70);
  });

  it('gives every run of rows as one piece, at whatever place the ring stands', () => {
    for (let pushed = 1; pushed <= 20; pushed += 1) {
      const ring = new RingTable(['t'], 7);
      for (let i = 0; i < pushed; i += 1) ring.push({ t: i });
      const held = Math.min(pushed, 7);
      for (let from = 0; from <= held; from += 1) {
        const expected = Array.from({ length: held - from }, (_, i) => pushed - held + from + i);
        expect([...ring.view('t', from)]).toEqual(expected);
      }
    }
  });

  it('does not grow', () => {
    const ring = new RingTable(['t'], 10);
    const bytes = ring.view('t').buffer.byteLength;
    for (let i = 0; i < 1000; i += 1) ring.push({ t: i });
    expect(ring.view('t').buffer.byteLength).toBe(bytes);
    expect(ring.length).toBe(10);
  });

  it('finds the first row that is not below a value', () => {
    const ring = new RingTable(['t'], 4);
    for (const t of [1, 2, 3, 4, 5, 6]) ring.push({ t });
    expect(ring.lowerBound('t', 0)).toBe(0);
    expect(ring.lowerBound('t', 4)).toBe(1);
    expect(ring.lowerBound('t', 4.5)).toBe(2);
    expect(ring.lowerBound('t', 7)).toBe(4);
  });

  it('marks what is missing as NaN and is empty after clear', () => {
    const ring = new RingTable(['t', 'x'], 4);
    ring.push({ t: 1 });
    expect(ring.last('x')).toBeNaN();
    ring.clear();
    expect(ring.length).toBe(0);
    expect(ring.last('t')).toBeUndefined();
    expect([...ring.view('t')]).toEqual([]);
  });

  it('refuses a capacity that is no whole number from 1', () => {
    for (const capacity of [0, -1, 1.5]) {
      expect(() => new RingTable(['t'], capacity)).toThrow(/allowed: whole numbers from 1/);
    }
  });

  it('copies what it holds', () => {
    const ring = new RingTable(['t'], 4);
    for (let i = 0; i < 6; i += 1) ring.push({ t: i });
    const copy = ring.copy();
    ring.push({ t: 6 });
    expect([...copy.view('t')]).toEqual([2, 3, 4, 5]);
    expect(copy.lowerBound('t', 4)).toBe(2);
    expect([...copy.view('t', 1, 3)]).toEqual([3, 4]);
    expect(new RingTable(['t'], 3).copy().length).toBe(0);
  });
});
