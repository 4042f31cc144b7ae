import { describe, expect, it } from 'vitest';
import {
  buildPush,
  curlOf,
  deltaV,
  directionName,
  impulseFor,
  impulseOf,
  missingNumber,
  peakForce,
} from '../src/push_request';
import type { PushChoice } from '../src/push_request';

const choice: PushChoice = {
  link: 'torso',
  point: null,
  direction: 90,
  strength: { impulseNs: 15 },
  durationS: 0.1,
  profile: 'rectangular',
  when: 'now',
};

describe('buildPush', () => {
  it('names every field that the user has chosen, and no other', () => {
    expect(buildPush(choice)).toEqual({
      link: 'torso',
      direction_deg: 90,
      impulse_ns: 15,
      duration_s: 0.1,
      profile: 'rectangular',
    });
  });

  it('carries what else has been chosen', () => {
    const trigger = { phase: 'single_support', leg: 'left', fraction: 0.2 } as const;
    expect(buildPush({ ...choice, when: trigger })).toMatchObject({ trigger });
    expect(buildPush({ ...choice, when: { atS: 4.5 } })).toMatchObject({ at_s: 4.5 });
    const all = buildPush({
      ...choice,
      point: [0.1, 0, 0.2],
      direction: [1, 0, 0.5],
      strength: { forceN: 120 },
    });
    expect(all).toMatchObject({ point: [0.1, 0, 0.2], direction: [1, 0, 0.5], force_n: 120 });
    expect(all).not.toHaveProperty('direction_deg');
    expect(all).not.toHaveProperty('impulse_ns');
  });

  it('leaves the range to the server', () => {
    expect(buildPush({ ...choice, strength: { impulseNs: 999 } }).impulse_ns).toBe(999);
  });
});

describe('missingNumber', () => {
  it('names the first field without a number', () => {
    const none = Number.NaN;
    expect(missingNumber(choice)).toBeNull();
    expect(missingNumber({ ...choice, strength: { impulseNs: none } })).toMatch(/impulse/);
    expect(missingNumber({ ...choice, strength: { forceN: none } })).toMatch(/force/);
    expect(missingNumber({ ...choice, durationS: none })).toMatch(/duration/);
    expect(missingNumber({ ...choice, direction: Infinity })).toMatch(/direction/);
    expect(missingNumber({ ...choice, direction: [1, none, 0] })).toMatch(/direction/);
    expect(missingNumber({ ...choice, point: [none, 0, 0] })).toMatch(/point/);
    const trigger = { phase: 'double_support', fraction: none } as const;
    expect(missingNumber({ ...choice, when: trigger })).toMatch(/fraction/);
    expect(missingNumber({ ...choice, when: { atS: none } })).toMatch(/time/);
  });
});

describe('curlOf', () => {
  it('is a command that a shell passes on as it is', () => {
    const text = curlOf('http://127.0.0.1:8080', { link: "o'neil", impulse_ns: 3 });
    expect(text).toContain('http://127.0.0.1:8080/api/v1/pushes');
    expect(text).toContain(`'{"link":"o'\\''neil","impulse_ns":3}'`);
  });
});

describe('what a push amounts to', () => {
  it('is the constant force of the impulse', () => {
    expect(peakForce(15, 0.1, 'rectangular')).toBeCloseTo(150, 12);
  });

  it('is pi/2 as much at the peak of a half sine: its integral is the impulse', () => {
    const [impulse, duration] = [15, 0.2];
    const peak = peakForce(impulse, duration, 'half_sine');
    let integral = 0;
    const n = 10000;
    for (let i = 0; i < n; i += 1) {
      integral += (peak * Math.sin((Math.PI * (i + 0.5)) / n) * duration) / n;
    }
    expect(integral).toBeCloseTo(impulse, 6);
  });

  it('is the same told as impulse or as peak force', () => {
    for (const profile of ['rectangular', 'half_sine'] as const) {
      expect(impulseOf(peakForce(15, 0.2, profile), 0.2, profile)).toBeCloseTo(15, 12);
    }
  });

  it('scales with the robot, in two digits', () => {
    expect(impulseFor(0.2, 30)).toBe(6);
    expect(impulseFor(0.2, 2.94)).toBe(0.59);
  });

  it('is a change of velocity', () => {
    expect(deltaV(15, 30)).toBe(0.5);
  });
});

describe('directions', () => {
  it('have names on the axes, degrees elsewhere', () => {
    expect([0, 90, 180, 270, -90, 360].map(directionName)).toEqual([
      'forward',
      'left',
      'backward',
      'right',
      'right',
      'forward',
    ]);
    expect(directionName(45)).toBe('45°');
    expect(directionName(-30.25)).toBe('329.8°');
  });
});
