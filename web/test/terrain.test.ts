import { describe, expect, it } from 'vitest';
import { Terrain } from '../src/terrain';

describe('Terrain', () => {
  it('is flat when nothing is said', () => {
    const terrain = new Terrain();
    expect(terrain.kind).toBe('flat');
    expect(terrain.height(3, -4)).toBe(0);
    expect(terrain.shift(7)).toEqual([0, 0]);
  });

  it('rises along the slope, and not across it', () => {
    const terrain = new Terrain({ kind: 'slope', angle_deg: 5, uphill_deg: 90 });
    expect(terrain.height(0, 2)).toBeCloseTo(2 * Math.tan((5 * Math.PI) / 180), 12);
    expect(terrain.height(2, 0)).toBeCloseTo(0, 12);
  });

  it('has the tiles of docs/trial.md: numbers of another program', () => {
    const tiles = (seed: number): Terrain => new Terrain({ kind: 'uneven', height_m: 0.02 }, seed);
    expect(tiles(1).tileHeight(0, 0)).toBe(0);
    expect(tiles(1).tileHeight(1, 0)).toBe(0.006832626213335836);
    expect(tiles(1).tileHeight(-1, 3)).toBe(0.018206687595304246);
    expect(tiles(7).tileHeight(0, -2)).toBe(0.015608034151958852);
    // Tile (-1, 3) has its middle at (-0.5, 1.5).
    expect(tiles(1).height(-0.74, 1.26)).toBe(0.018206687595304246);
    expect(tiles(1).height(-0.76, 1.26)).not.toBe(0.018206687595304246);
  });

  it('moves as a platform does: gathers speed for a second, shoves from rest to rest', () => {
    const shove = { at_s: 2, duration_s: 0.5, x_m: 0.2, y_m: -0.1 };
    const still = new Terrain({ kind: 'platform', shoves: [shove] });
    expect(still.shift(2)).toEqual([0, 0]);
    expect(still.shift(2.25)[0]).toBeCloseTo(0.1, 12);
    expect(still.shift(9)).toEqual([0.2, -0.1]);
    const moving = new Terrain({ kind: 'platform', vx: 0.3 });
    const speed = (t: number): number =>
      ((moving.shift(t + 1e-4)[0] ?? 0) - (moving.shift(t - 1e-4)[0] ?? 0)) / 2e-4;
    expect(speed(0.01)).toBeLessThan(0.01);
    expect(speed(0.5)).toBeCloseTo(0.15, 6);
    expect(speed(4)).toBeCloseTo(0.3, 6);
  });

  it('reads patches and leaves out what is none', () => {
    const patch = { x_min: 1, x_max: 2, y_min: -1, y_max: 1, friction: 0.2 };
    const terrain = new Terrain({ kind: 'flat', patches: [patch, 3] });
    expect(terrain.patches).toEqual([{ xMin: 1, xMax: 2, yMin: -1, yMax: 1, friction: 0.2 }]);
  });
});
