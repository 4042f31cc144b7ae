import { describe, expect, it } from 'vitest';
import {
  GroundTransform,
  lag,
  overlapOf,
  polygonFrom,
  scaleBarLength,
  soleCorners,
  stepsFrom,
} from '../src/views/transform';
import type { Point } from '../src/views/transform';

describe('GroundTransform', () => {
  const view = new GroundTransform({ x: 2, y: -1 }, 200, 400, 300);

  it('puts the centre in the middle', () => {
    expect(view.toCanvas({ x: 2, y: -1 })).toEqual({ x: 200, y: 150 });
  });

  it('has x up the page and y to the left', () => {
    expect(view.toCanvas({ x: 2.5, y: -1 })).toEqual({ x: 200, y: 50 });
    expect(view.toCanvas({ x: 2, y: -0.5 })).toEqual({ x: 100, y: 150 });
  });

  it('comes back from the canvas to the world', () => {
    for (const point of [
      { x: 0, y: 0 },
      { x: 2.3, y: -1.7 },
      { x: -40.25, y: 12.5 },
    ]) {
      const back = view.toWorld(view.toCanvas(point));
      expect(back.x).toBeCloseTo(point.x, 12);
      expect(back.y).toBeCloseTo(point.y, 12);
    }
  });
});

describe('soleCorners', () => {
  it('has the length along the yaw and the width across', () => {
    const corners = soleCorners({ x: 1, y: 2, yaw: Math.PI / 2 }, 0.4, 0.2);
    const expected = [
      [0.9, 2.2],
      [1.1, 2.2],
      [1.1, 1.8],
      [0.9, 1.8],
    ];
    corners.forEach((corner, i) => {
      expect(corner.x).toBeCloseTo(expected[i]?.[0] ?? Number.NaN, 12);
      expect(corner.y).toBeCloseTo(expected[i]?.[1] ?? Number.NaN, 12);
    });
  });
});

describe('scaleBarLength', () => {
  it.each([
    [0.34, 0.2],
    [0.2, 0.2],
    [0.19, 0.1],
    [0.99, 0.5],
    [1, 1],
    [7, 5],
  ])('takes the greatest round length up to %f m', (longest, length) => {
    expect(scaleBarLength(longest)).toBeCloseTo(length, 12);
  });
});

describe('lag', () => {
  it('comes as near in one long step as in many short ones', () => {
    let value = 0;
    for (let i = 0; i < 100; i += 1) value = lag(value, 1, 0.01, 0.5);
    expect(value).toBeCloseTo(lag(0, 1, 1, 0.5), 12);
    expect(lag(0, 1, 0, 0.5)).toBe(0);
  });
});

describe('lists in a frame', () => {
  it('are read in whole entries', () => {
    expect(stepsFrom([1, 2, 0.5, 1, 3, 4, 0, 0, 9])).toEqual([
      { x: 1, y: 2, yaw: 0.5, side: 1 },
      { x: 3, y: 4, yaw: 0, side: 0 },
    ]);
    expect(polygonFrom([1, 2, 3, 4, 5])).toEqual([
      { x: 1, y: 2 },
      { x: 3, y: 4 },
    ]);
  });
});

describe('overlapOf', () => {
  const square = (x: number, y: number, side: number): Point[] => [
    { x, y },
    { x: x + side, y },
    { x: x + side, y: y + side },
    { x, y: y + side },
  ];
  const area = (points: readonly Point[]): number =>
    points.reduce((sum, p, i) => {
      const next = points[(i + 1) % points.length] ?? p;
      return sum + (p.x * next.y - next.x * p.y) / 2;
    }, 0);

  it('is what two areas have in common', () => {
    expect(area(overlapOf(square(0, 0, 2), square(1, 1, 2)))).toBeCloseTo(1, 12);
    expect(area(overlapOf(square(0, 0, 2), square(0.5, 0.5, 1)))).toBeCloseTo(1, 12);
    const diamond = [
      { x: 1, y: 0 },
      { x: 2, y: 1 },
      { x: 1, y: 2 },
      { x: 0, y: 1 },
    ];
    expect(area(overlapOf(square(0, 0, 1), diamond))).toBeCloseTo(0.5, 12);
  });

  it('is empty where they have nothing in common', () => {
    expect(overlapOf(square(0, 0, 1), square(3, 0, 1))).toEqual([]);
    expect(overlapOf([], square(0, 0, 1))).toEqual([]);
  });
});
