import { describe, expect, it } from 'vitest';
import { csvOf } from '../src/export';
import { RingTable } from '../src/ring';

describe('csvOf', () => {
  it('writes the rows of a piece of time, every digit of them', () => {
    const table = new RingTable<string>(['t', 'a'], 5);
    for (let i = 0; i < 8; i += 1) table.push({ t: i / 10, a: i === 5 ? Number.NaN : i / 3 });
    expect(csvOf(table, [0.45, 0.6])).toBe(`t,a\r\n0.5,\r\n0.6,${6 / 3}\r\n`);
    expect(csvOf(table, [9, 10])).toBe('t,a\r\n');
  });
});
