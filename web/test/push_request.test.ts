import { describe, expect, it } from 'vitest';
import {
  buildPush,
  deltaV,
  directionName,
  directionOfKey,
  directions,
  missingNumber,
  peakForce,
} from '../src/push_request';
import type { PushChoice } from '../src/push_request';

const choice: PushChoice = {
  link: 'torso',
  directionDeg: 90,
  impulseNs: 15,
  durationS: 0.1,
  profile: 'rectangular',
  trigger: null,
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

  it('carries the trigger when there is one', () => {
    const trigger = { phase: 'single_support', leg: 'left', fraction: 0.2 } as const;
    expect(buildPush({ ...choice, trigger })).toMatchObject({ trigger });
  });

  it('leaves the range to the server', () => {
    expect(buildPush({ ...choice, impulseNs: 999 }).impulse_ns).toBe(999);
  });
});

describe('missingNumber', () => {
  it('names the first field without a number', () => {
    expect(missingNumber(choice)).toBeNull();
    expect(missingNumber({ ...choice, impulseNs: Number.NaN })).toMatch(/impulse/);
    expect(missingNumber({ ...choice, durationS: Number.NaN })).toMatch(/duration/);
    expect(missingNumber({ ...choice, directionDeg: Infinity })).toMatch(/direction/);
    const trigger = { phase: 'double_support', fraction: Number.NaN } as const;
    expect(missingNumber({ ...choice, trigger })).toMatch(/fraction/);
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

  it('is a change of velocity', () => {
    expect(deltaV(15, 30)).toBe(0.5);
  });
});

describe('directions', () => {
  it('follow the arrow keys as seen from above with the robot looking up', () => {
    expect(directionOfKey('ArrowUp')).toBe('forward');
    expect(directionOfKey('ArrowLeft')).toBe('left');
    expect(directionOfKey('ArrowRight')).toBe('right');
    expect(directionOfKey('ArrowDown')).toBe('backward');
    expect(directionOfKey('a')).toBeNull();
    expect(directions.left).toBe(90);
  });

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
