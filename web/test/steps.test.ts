import { describe, expect, it } from 'vitest';
import { nextSide } from '../src/panels/steps';

describe('nextSide', () => {
  const middle = { x: 1, y: 1 };

  it('begins with the foot on whose side the first step is put down', () => {
    expect(nextSide([], { x: 1, y: 1.1 }, middle, 0)).toBe('left');
    expect(nextSide([], { x: 1, y: 0.9 }, middle, 0)).toBe('right');
    // Turned by a quarter to the left, left is where x is less.
    expect(nextSide([], { x: 0.9, y: 1 }, middle, Math.PI / 2)).toBe('left');
  });

  it('goes on with the other foot, wherever it is put down', () => {
    const step = { side: 'left', x: 0, y: 0, yaw_deg: 0 } as const;
    expect(nextSide([step], { x: 1, y: 5 }, middle, 0)).toBe('right');
    expect(nextSide([step, { ...step, side: 'right' }], middle, middle, 0)).toBe('left');
  });
});
