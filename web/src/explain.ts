// What the strategies did about a push, made of the frames and events that came after it.

import type { Data, StreamEvent } from './protocol';
import type { Leg, Phase, PushTrigger } from './push_request';
import type { Walk } from './trial';
import { overlapDepth, polygonFrom, roomTowards, stepsFrom } from './views/transform';
import type { Point } from './views/transform';

/** What is nearer to its plan or reference than this is back at it [m]; as in a trial. */
const toleranceM = 0.03;
/** A frame further from the push's begin than this does not tell the gait at it [s]. */
const promptS = 0.05;
/** So long it has to be back before it counts as recovered [s]. */
const settledS = 1;

/** A step that landed elsewhere or at another time than planned. */
export interface SavingStep {
  readonly side: Leg;
  readonly planned: Point;
  readonly landed: Point;
  /** How far the engine had moved it [m]. */
  readonly movedM: number;
  /** Single support [s]. */
  readonly plannedS: number;
  readonly actualS: number;
}

export type Ending = 'watching' | 'recovered' | 'fell' | 'pushed again';

function numberOf(values: Readonly<Record<string, unknown>>, name: string): number {
  const value = values[name];
  return typeof value === 'number' ? value : Number.NaN;
}

export class PushStory {
  readonly id: number;
  readonly startS: number;
  readonly impulseNs: number;
  readonly durationS: number;
  ending: Ending = 'watching';
  /** Greatest shift of the commanded ZMP from its reference, and how far it could have gone [m]. */
  ankle: { readonly shiftM: number; readonly roomM: number } | null = null;
  /** Greatest change of the angular momentum since the push began [N m s]. */
  hipNms = 0;
  readonly steps: SavingStep[] = [];
  /** Steps from the push to the last one that was moved. */
  stepsToRecover = 0;
  /** The least by which reach and capture region overlapped [m]; negative: they were apart. */
  marginM: number | null = null;
  /** Since when no step reached far enough [s]. */
  lostS: number | null = null;
  fallS: number | null = null;
  fallWords = '';
  /** The gait when the push began, as a push can wait for it again; null: it stood, or is unknown. */
  trigger: PushTrigger | null = null;
  /** Frames may come later than events: those up to here still count [s]. */
  private overS = Infinity;
  /** Whether it stood when the push began. */
  stood = false;
  private backS: number;
  private stepsSeen = 0;
  private momentum: readonly [number, number] | null = null;

  /** The switches of the strategies and the commanded velocity at the push's begin, as far as they are known. */
  constructor(
    started: StreamEvent,
    readonly strategies: Readonly<Record<string, boolean>> = {},
    readonly walk: Walk | null = null,
  ) {
    this.id = numberOf(started.values, 'id');
    this.startS = started.t;
    this.impulseNs = numberOf(started.values, 'impulse_ns');
    this.durationS = numberOf(started.values, 'duration_s');
    this.backS = started.t;
  }

  get endS(): number {
    return this.startS + this.durationS;
  }

  /** From the push's end until back [s]. */
  get recoveryS(): number {
    return Math.max(0, this.backS - this.endS);
  }

  take(event: StreamEvent): void {
    if (this.ending !== 'watching') return;
    const { values } = event;
    if (event.kind === 'push_started') {
      this.ending = 'pushed again';
      this.overS = event.t;
    } else if (event.kind === 'fall') {
      this.ending = 'fell';
      this.fallS = event.t;
      this.overS = event.t;
      this.fallWords = event.text;
    } else if (event.kind === 'step') {
      this.stepsSeen += 1;
      if (numberOf(values, 'adjustment') > toleranceM) this.stepsToRecover = this.stepsSeen;
    } else if (event.kind === 'adjustment') {
      this.steps.push({
        side: numberOf(values, 'side') > 0.5 ? 'right' : 'left',
        planned: { x: numberOf(values, 'planned_x'), y: numberOf(values, 'planned_y') },
        landed: { x: numberOf(values, 'x'), y: numberOf(values, 'y') },
        movedM: numberOf(values, 'moved_m'),
        plannedS: numberOf(values, 'planned_t_ss'),
        actualS: numberOf(values, 't_ss'),
      });
    }
  }

  /** Frames in their order, from a little before the push on. */
  look(frame: Data, states: readonly string[]): void {
    if (frame.t < this.startS - promptS || frame.t > this.overS) return;
    const numbers = (name: string): readonly number[] => frame.v[name] ?? [];
    const pair = (name: string): Point => {
      const [x = Number.NaN, y = Number.NaN] = numbers(name);
      return { x, y };
    };
    const state = states[numbers('state')[0] ?? -1] ?? '';
    const [lx, ly] = numbers('angular_momentum');
    // The last frame that the push has not changed yet tells how it was; without one, the first since.
    if (this.momentum === null || frame.t <= this.startS) {
      this.momentum = [lx ?? Number.NaN, ly ?? Number.NaN];
      this.stood = state === 'idle';
      this.trigger = this.triggerAt(state, frame);
    }
    if (frame.t < this.startS) return;
    const change = Math.hypot((lx ?? NaN) - this.momentum[0], (ly ?? NaN) - this.momentum[1]);
    if (change > this.hipNms) this.hipNms = change;

    this.noteAnkle(pair('zmp_reference'), pair('zmp_command'), numbers('support_polygon'));
    this.noteMargin(frame.t, numbers('capture_region'), numbers('reachable_footholds'));
    this.noteRecovery(frame.t, state, pair('dcm'), pair('dcm_reference'), numbers);
  }

  private triggerAt(state: string, frame: Data): PushTrigger | null {
    if (state !== 'single_support' && state !== 'double_support') return null;
    if (frame.t > this.startS + promptS) return null;
    const phase: Phase = state;
    const length = frame.v[phase === 'single_support' ? 't_ss' : 't_ds']?.[0] ?? Number.NaN;
    const passed = (frame.v['phase_time']?.[0] ?? 0) - (frame.t - this.startS);
    const fraction = Number(Math.min(0.99, Math.max(0, passed / length)).toFixed(3));
    const leg: Leg = (frame.v['support_side']?.[0] ?? 0) > 0.5 ? 'right' : 'left';
    return { phase, leg, fraction: Number.isFinite(fraction) ? fraction : 0 };
  }

  private noteAnkle(reference: Point, command: Point, polygon: readonly number[]): void {
    const shift = { x: command.x - reference.x, y: command.y - reference.y };
    const shiftM = Math.hypot(shift.x, shift.y);
    if (!(shiftM > (this.ankle?.shiftM ?? 1e-4))) return;
    const roomM = roomTowards(polygonFrom(polygon), reference, shift);
    if (roomM !== null) this.ankle = { shiftM, roomM };
  }

  private noteMargin(t: number, region: readonly number[], reach: readonly number[]): void {
    const depth = overlapDepth(polygonFrom(region), polygonFrom(reach));
    if (depth === null) return;
    if (this.marginM === null || depth < this.marginM) this.marginM = depth;
    if (depth >= 0) this.lostS = null;
    else this.lostS ??= t;
  }

  /** By the same criteria as the server's in a trial. */
  private noteRecovery(
    t: number,
    state: string,
    dcm: Point,
    reference: Point,
    numbers: (name: string) => readonly number[],
  ): void {
    const [planned] = stepsFrom(numbers('planned_step'));
    const [adjusted] = stepsFrom(numbers('adjusted_step'));
    const moved =
      planned === undefined || adjusted === undefined
        ? 0
        : Math.hypot(adjusted.x - planned.x, adjusted.y - planned.y);
    const near = Math.hypot(dcm.x - reference.x, dcm.y - reference.y) <= toleranceM;
    const asTold = (state === 'idle') === this.stood;
    if (!near || !asTold || moved > toleranceM || t < this.endS) this.backS = t;
    else if (this.ending === 'watching' && t >= this.backS + settledS) {
      this.ending = 'recovered';
      this.overS = t;
    }
  }
}
