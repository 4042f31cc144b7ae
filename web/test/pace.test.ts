import { describe, expect, it } from 'vitest';
import { Pace } from '../src/pace';

/** Draws each 16 ms for so long, each frame being `age` old; the rates that were asked for. */
function run(pace: Pace, from: number, ms: number, age: number): number[] {
  const rates: number[] = [];
  for (let now = from; now < from + ms; now += 16) {
    pace.received(now - age);
    const rate = pace.drawn(now);
    if (rate !== null) rates.push(rate);
  }
  return rates;
}

describe('Pace', () => {
  it('asks for no other rate while it keeps up', () => {
    const pace = new Pace();
    expect(run(pace, 0, 60000, 5)).toEqual([]);
    expect(pace.behindMs).toBe(5);
  });

  it('asks for fewer frames when what is drawn is old, down to a limit', () => {
    const pace = new Pace();
    expect(run(pace, 0, 30000, 300)).toEqual([50, 25, 12.5]);
  });

  it('counts what waits to be read', () => {
    const pace = new Pace();
    pace.compared(5.5, 5.1);
    run(pace, 0, 100, 0);
    expect(pace.behindMs).toBeCloseTo(400, 9);
    pace.restart();
    run(pace, 100, 100, 0);
    expect(pace.behindMs).toBe(0);
  });

  it('asks for more again when it has kept up for long', () => {
    const pace = new Pace();
    run(pace, 0, 2000, 300);
    expect(pace.rateHz).toBe(50);
    expect(run(pace, 2000, 9000, 5)).toEqual([]);
    expect(run(pace, 11000, 5000, 5)).toEqual([100]);
  });
});
