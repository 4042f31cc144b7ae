// A push as the user describes it, what it amounts to, and the body of POST /api/v1/pushes.

export type Profile = 'rectangular' | 'half_sine';
export type Phase = 'single_support' | 'double_support';
export type Leg = 'left' | 'right';

export interface PushTrigger {
  readonly phase: Phase;
  readonly leg?: Leg;
  readonly fraction: number;
}

export interface PushChoice {
  readonly link: string;
  readonly directionDeg: number;
  readonly impulseNs: number;
  readonly durationS: number;
  readonly profile: Profile;
  readonly trigger: PushTrigger | null;
}

export interface PushBody {
  readonly link: string;
  readonly direction_deg: number;
  readonly impulse_ns: number;
  readonly duration_s: number;
  readonly profile: Profile;
  readonly trigger?: PushTrigger;
}

/** The four directions of the pad, in the frame of the robot's heading [deg]. */
export const directions = { forward: 0, left: 90, backward: 180, right: 270 } as const;
export type Direction = keyof typeof directions;

/** Which direction an arrow key pushes in, or null. */
export function directionOfKey(key: string): Direction | null {
  switch (key) {
    case 'ArrowUp':
      return 'forward';
    case 'ArrowLeft':
      return 'left';
    case 'ArrowDown':
      return 'backward';
    case 'ArrowRight':
      return 'right';
    default:
      return null;
  }
}

/** Words for a direction: a name on the four axes, else degrees. */
export function directionName(degrees: number): string {
  const turn = ((degrees % 360) + 360) % 360;
  for (const [name, angle] of Object.entries(directions)) {
    if (Math.abs(turn - angle) < 0.05) return name;
  }
  return `${Number(turn.toFixed(1))}°`;
}

/** Peak of a force with this impulse [N]; a half sine peaks pi/2 above the constant force. */
export function peakForce(impulseNs: number, durationS: number, profile: Profile): number {
  const mean = impulseNs / durationS;
  return profile === 'half_sine' ? (mean * Math.PI) / 2 : mean;
}

/** Change of the centre of mass's velocity that the impulse amounts to [m/s]. */
export function deltaV(impulseNs: number, massKg: number): number {
  return impulseNs / massKg;
}

/** The words that name the first number that is missing, or null when all are there. */
export function missingNumber(choice: PushChoice): string | null {
  if (!Number.isFinite(choice.impulseNs)) return 'The impulse is not a number.';
  if (!Number.isFinite(choice.durationS)) return 'The duration is not a number.';
  if (!Number.isFinite(choice.directionDeg)) return 'The direction is not a number.';
  if (choice.trigger !== null && !Number.isFinite(choice.trigger.fraction)) {
    return 'The fraction of the phase is not a number.';
  }
  return null;
}

/** The request's body. Ranges are the server's business: it says what is allowed. */
export function buildPush(choice: PushChoice): PushBody {
  return {
    link: choice.link,
    direction_deg: choice.directionDeg,
    impulse_ns: choice.impulseNs,
    duration_s: choice.durationS,
    profile: choice.profile,
    ...(choice.trigger === null ? {} : { trigger: choice.trigger }),
  };
}
