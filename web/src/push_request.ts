// A push as the user describes it, what it amounts to, and the body of POST /api/v1/pushes.

export type Profile = 'rectangular' | 'half_sine';
export type Phase = 'single_support' | 'double_support';
export type Leg = 'left' | 'right';

export interface PushTrigger {
  readonly phase: Phase;
  readonly leg?: Leg;
  readonly fraction: number;
}

export type Vector = readonly [number, number, number];

export interface PushChoice {
  readonly link: string;
  /** In the link's frame [m]; null: the link's centre of mass. */
  readonly point: Vector | null;
  /** Degrees from the heading, or a vector in its frame. */
  readonly direction: number | Vector;
  /** One of the two is a number: the impulse [N s] or the peak force [N]. */
  readonly strength: { readonly impulseNs: number } | { readonly forceN: number };
  readonly durationS: number;
  readonly profile: Profile;
  /** At once, at a phase of the gait, or at a simulation time [s]. */
  readonly when: 'now' | PushTrigger | { readonly atS: number };
}

/** The request's body, as docs/api.md has it. */
export interface PushBody {
  readonly link?: string;
  readonly point?: Vector;
  readonly direction_deg?: number;
  readonly direction?: Vector;
  readonly impulse_ns?: number;
  readonly force_n?: number;
  readonly duration_s?: number;
  readonly profile?: Profile;
  readonly trigger?: PushTrigger;
  readonly at_s?: number;
}

/** The four directions of the pad, in the frame of the robot's heading [deg]. */
export const directions = { forward: 0, left: 90, backward: 180, right: 270 } as const;
export type Direction = keyof typeof directions;

/** Words for a direction: a name on the four axes, else degrees. */
export function directionName(degrees: number): string {
  const turn = ((degrees % 360) + 360) % 360;
  for (const [name, angle] of Object.entries(directions)) {
    if (Math.abs(turn - angle) < 0.05) return name;
  }
  return `${Number(turn.toFixed(1))}°`;
}

/** Peak of a force over the constant force of the same impulse. */
function peakOf(profile: Profile): number {
  return profile === 'half_sine' ? Math.PI / 2 : 1;
}

/** Peak of a force with this impulse [N]. */
export function peakForce(impulseNs: number, durationS: number, profile: Profile): number {
  return (impulseNs / durationS) * peakOf(profile);
}

/** Impulse of a force with this peak [N s]. */
export function impulseOf(forceN: number, durationS: number, profile: Profile): number {
  return (forceN * durationS) / peakOf(profile);
}

/** Change of the centre of mass's velocity that the impulse amounts to [m/s]. */
export function deltaV(impulseNs: number, massKg: number): number {
  return impulseNs / massKg;
}

/** An impulse that changes the robot's velocity by about this much, in two digits [N s]. */
export function impulseFor(deltaVMs: number, massKg: number): number {
  return Number((deltaVMs * massKg).toPrecision(2));
}

/** The words that name the first number that is missing, or null when all are there. */
export function missingNumber(choice: PushChoice): string | null {
  const { strength, when, point, direction } = choice;
  if ('impulseNs' in strength && !Number.isFinite(strength.impulseNs)) {
    return 'The impulse is not a number.';
  }
  if ('forceN' in strength && !Number.isFinite(strength.forceN)) {
    return 'The force is not a number.';
  }
  if (!Number.isFinite(choice.durationS)) return 'The duration is not a number.';
  const parts = typeof direction === 'number' ? [direction] : direction;
  if (!parts.every(Number.isFinite)) return 'The direction is not a number.';
  if (point !== null && !point.every(Number.isFinite)) {
    return 'The point needs three numbers, or none for the centre of mass.';
  }
  if (when !== 'now' && 'phase' in when && !Number.isFinite(when.fraction)) {
    return 'The fraction of the phase is not a number.';
  }
  if (when !== 'now' && 'atS' in when && !Number.isFinite(when.atS)) {
    return 'The time of the push is not a number.';
  }
  return null;
}

/** The request's body. Ranges are the server's business: it says what is allowed. */
export function buildPush(choice: PushChoice): PushBody {
  const { point, direction, strength, when } = choice;
  return {
    link: choice.link,
    ...(point === null ? {} : { point }),
    ...(typeof direction === 'number' ? { direction_deg: direction } : { direction }),
    ...('impulseNs' in strength
      ? { impulse_ns: strength.impulseNs }
      : { force_n: strength.forceN }),
    duration_s: choice.durationS,
    profile: choice.profile,
    ...(when === 'now' ? {} : 'phase' in when ? { trigger: when } : { at_s: when.atS }),
  };
}

/** The same push when a phase comes, or at once. */
export function pushAgain(body: PushBody, trigger: PushTrigger | null): PushBody {
  const again = Object.fromEntries(
    Object.entries(body).filter(([name]) => name !== 'at_s' && name !== 'trigger'),
  ) as PushBody;
  return trigger === null ? again : { ...again, trigger };
}

/** The same push for a terminal. */
export function curlOf(origin: string, body: PushBody): string {
  const json = JSON.stringify(body).replaceAll("'", "'\\''");
  return `curl -X POST ${origin}/api/v1/pushes -H 'Content-Type: application/json' -d '${json}'`;
}
