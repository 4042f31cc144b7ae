import { describe, expect, it } from 'vitest';
import { formatNumber, formatShort } from '../src/dom';

describe('formatNumber', () => {
  it('has a real minus sign, no negative zero, and a dash for nothing', () => {
    expect(formatNumber(-1.25, 1)).toBe('−1.3');
    expect(formatNumber(-0.0004, 3)).toBe('0.000');
    expect(formatNumber(undefined, 2)).toBe('–');
    expect(formatNumber(Number.NaN, 2)).toBe('–');
  });
});

describe('formatShort', () => {
  it.each([
    [120, '120'],
    [6.5, '6.5'],
    [0, '0'],
    [0.125, '0.125'],
    [10.1004, '10.1'],
    [Number.NaN, '–'],
  ])('writes %f as %s', (value, text) => {
    expect(formatShort(value, 3)).toBe(text);
  });
});
