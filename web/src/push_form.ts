// The form of a push: every field of the push resource, read into a choice and filled from one.

import { byId, fillSelect, formatNumber, formatShort, numberIn, setText } from './dom';
import { deltaV, impulseFor, impulseOf, peakForce } from './push_request';
import type { Leg, Phase, Profile, PushBody, PushChoice, Vector } from './push_request';
import type { Store } from './store';

/** Change of velocity that the form starts with [m/s]. */
const defaultDeltaV = 0.2;

export class PushForm {
  private readonly strength = byId('impulse', HTMLInputElement);
  private readonly kind = byId('strength-kind', HTMLSelectElement);
  private readonly unit = byId('strength-unit', HTMLElement);
  private readonly label = byId('strength-label', HTMLElement);
  private readonly duration = byId('duration', HTMLInputElement);
  private readonly link = byId('link', HTMLSelectElement);
  private readonly point = [
    byId('point-x', HTMLInputElement),
    byId('point-y', HTMLInputElement),
    byId('point-z', HTMLInputElement),
  ];
  private readonly profile = byId('profile', HTMLSelectElement);
  private readonly trigger = byId('trigger', HTMLSelectElement);
  private readonly fraction = byId('fraction', HTMLInputElement);
  private readonly atS = byId('at-s', HTMLInputElement);
  private readonly angle = byId('angle', HTMLInputElement);
  private readonly vector = [
    byId('direction-x', HTMLInputElement),
    byId('direction-y', HTMLInputElement),
    byId('direction-z', HTMLInputElement),
  ];
  private readonly equals = byId('push-equals', HTMLElement);
  /** Whose strength the form holds: another robot gets another default. */
  private sizedFor = '';

  constructor(private readonly store: Store) {
    for (const input of [this.strength, this.duration, this.profile]) {
      input.addEventListener('input', () => this.showEquals());
    }
    this.kind.addEventListener('change', () => this.changeKind());
    this.trigger.addEventListener('change', () => this.showTrigger());
    store.on('robot', () => this.robotChanged());
    this.showTrigger();
    this.showEquals();
  }

  /** The push that the form describes, towards `direction` or where the form says. */
  choice(direction?: number): PushChoice {
    const point = this.point.map((input) => numberIn(input));
    const vector = this.vector.map((input) => numberIn(input));
    const byVector = this.vector.some((input) => input.value.trim() !== '');
    const value = numberIn(this.strength);
    return {
      link: this.link.value,
      point: this.point.every((input) => input.value.trim() === '') ? null : asVector(point),
      direction: direction ?? (byVector ? asVector(vector) : numberIn(this.angle)),
      strength: this.kind.value === 'force' ? { forceN: value } : { impulseNs: value },
      durationS: numberIn(this.duration),
      profile: this.profile.value === 'half_sine' ? 'half_sine' : 'rectangular',
      when: this.when(),
    };
  }

  /** Puts a push into the form: what is shown is what would be sent. */
  fill(push: PushBody): void {
    if (push.link !== undefined) this.link.value = push.link;
    this.point.forEach((input, i) => (input.value = text(push.point?.[i])));
    const { direction } = push;
    this.vector.forEach((input, i) => (input.value = text(direction?.[i])));
    if (direction === undefined) this.angle.value = text(push.direction_deg ?? 0);
    this.kind.value = push.force_n === undefined ? 'impulse' : 'force';
    this.strength.value = text(push.impulse_ns ?? push.force_n);
    if (push.duration_s !== undefined) this.duration.value = text(push.duration_s);
    if (push.profile !== undefined) this.profile.value = push.profile;
    const { trigger } = push;
    if (trigger !== undefined) {
      this.trigger.value = [trigger.phase, trigger.leg ?? ''].join(' ').trim();
      this.fraction.value = text(trigger.fraction);
    } else {
      this.trigger.value = push.at_s === undefined ? '' : 'time';
      this.atS.value = text(push.at_s);
    }
    this.showKind();
    this.showTrigger();
    this.showEquals();
  }

  /** Sets the strength by the change of velocity that it amounts to [m/s]. */
  setDeltaV(metresPerSecond: number, durationS: number): void {
    const mass = this.store.robot?.massKg ?? 30;
    this.kind.value = 'impulse';
    this.strength.value = String(impulseFor(metresPerSecond, mass));
    this.duration.value = String(durationS);
    this.showKind();
    this.showEquals();
  }

  /** Makes the strength a share greater or smaller. */
  scale(factor: number): void {
    const value = numberIn(this.strength) * factor;
    if (Number.isFinite(value)) this.strength.value = String(Number(value.toPrecision(2)));
    this.showEquals();
  }

  private when(): PushChoice['when'] {
    const [phase, leg] = this.trigger.value.split(' ');
    if (phase === undefined || phase === '') return 'now';
    if (phase === 'time') return { atS: numberIn(this.atS) };
    return {
      phase: phase as Phase,
      ...(leg === undefined ? {} : { leg: leg as Leg }),
      fraction: numberIn(this.fraction),
    };
  }

  private get impulseNs(): number {
    const value = numberIn(this.strength);
    const profile = this.profile.value as Profile;
    return this.kind.value === 'force'
      ? impulseOf(value, numberIn(this.duration), profile)
      : value;
  }

  private robotChanged(): void {
    const { robot } = this.store;
    const links = robot === null || robot.links.length === 0 ? ['torso'] : robot.links;
    fillSelect(this.link, links, robot?.torsoLink ?? 'torso');
    if (robot !== null && robot.name !== this.sizedFor && Number.isFinite(robot.massKg)) {
      this.sizedFor = robot.name;
      this.link.value = robot.torsoLink;
      this.setDeltaV(defaultDeltaV, 0.1);
    }
    this.showEquals();
  }

  /** The same push told the other way. */
  private changeKind(): void {
    const value = numberIn(this.strength);
    const duration = numberIn(this.duration);
    const profile = this.profile.value as Profile;
    const other =
      this.kind.value === 'force'
        ? peakForce(value, duration, profile)
        : impulseOf(value, duration, profile);
    if (Number.isFinite(other)) this.strength.value = String(Number(other.toPrecision(4)));
    this.showKind();
    this.showEquals();
  }

  private showKind(): void {
    const force = this.kind.value === 'force';
    setText(this.unit, force ? 'N' : 'N s');
    setText(this.label, force ? 'Peak force' : 'Impulse');
  }

  private showTrigger(): void {
    const byPhase = this.trigger.value !== '' && this.trigger.value !== 'time';
    byId('fraction-field', HTMLElement).hidden = !byPhase;
    byId('at-s-field', HTMLElement).hidden = this.trigger.value !== 'time';
  }

  private showEquals(): void {
    const impulse = this.impulseNs;
    const force = peakForce(impulse, numberIn(this.duration), this.profile.value as Profile);
    const mass = this.store.robot?.massKg ?? Number.NaN;
    const parts =
      this.kind.value === 'force'
        ? [`${formatShort(impulse, 3)} N s`]
        : [`${formatNumber(force, 0)} N peak`];
    if (Number.isFinite(mass)) parts.push(`Δv ${formatNumber(deltaV(impulse, mass), 2)} m/s`);
    setText(this.equals, parts.join('  ·  '));
  }
}

function text(value: number | undefined): string {
  return value === undefined ? '' : String(value);
}

function asVector(parts: readonly number[]): Vector {
  const [x = Number.NaN, y = Number.NaN, z = Number.NaN] = parts;
  return [x, y, z];
}
