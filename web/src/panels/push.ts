// Pushing: the pad, the form, the arrow keys, again, trains, and what became of the pushes.

import type { Api } from '../api';
import { linesOf } from '../api';
import { attempt } from '../attempt';
import { byId, formatNumber, formatShort, keepRows, numberIn, setText, showLines } from '../dom';
import type { Keys } from '../keys';
import type { PushResource } from '../push_body';
import type { PushForm } from '../push_form';
import {
  buildPush,
  curlOf,
  deltaV,
  directionName,
  directions,
  missingNumber,
} from '../push_request';
import type { Direction, PushBody, PushChoice } from '../push_request';
import { Reading } from '../reading';
import { SpringPull } from '../spring';
import type { Store } from '../store';
import type { AimListener, Grip } from '../views/aim';
import { PushRow } from './push_row';

const listedPushes = 6;
/** The server gives no more at once. */
const mostPushes = 1000;
const mostOfATrain = 100;

function isDirection(name: string | undefined): name is Direction {
  return name !== undefined && name in directions;
}

/** As part of a sentence. */
function directionWords(degrees: number): string {
  const name = directionName(degrees);
  return isDirection(name) ? (/left|right/.test(name) ? `to its ${name}` : name) : `at ${name}`;
}

export class PushPanel implements AimListener {
  private readonly arrowKeys = byId('arrow-keys', HTMLInputElement);
  private readonly answer = byId('push-answer', HTMLElement);
  private readonly error = byId('push-error', HTMLElement);
  private readonly list = byId('pushes', HTMLTableSectionElement);
  private readonly empty = byId('pushes-empty', HTMLElement);
  private readonly again = byId('push-again', HTMLButtonElement);
  private readonly card = byId('aim-card', HTMLElement);
  private last: PushBody | null = null;
  private aimedAt: PushBody | null = null;
  private spring: SpringPull | null = null;
  private readonly rows = new Map<string, PushRow>();
  private readonly reading: Reading<PushResource[]>;
  /** The aim's arrow in the picture is to go. */
  onAimDone: () => void = () => undefined;

  constructor(
    private readonly store: Store,
    private readonly api: Api,
    private readonly form: PushForm,
    keys: Keys,
  ) {
    this.reading = new Reading(
      () => api.pushes(this.wantedPushes),
      (pushes) => store.setPushes(pushes),
    );
    for (const button of document.querySelectorAll<HTMLButtonElement>('[data-direction]')) {
      const direction = button.dataset['direction'];
      if (isDirection(direction)) {
        button.addEventListener('click', () => void this.push(form.choice(directions[direction])));
      }
    }
    for (const button of document.querySelectorAll<HTMLButtonElement>('[data-delta-v]')) {
      const { deltaV: dv = '', duration = '' } = button.dataset;
      button.addEventListener('click', () => form.setDeltaV(Number(dv), Number(duration)));
    }
    byId('push-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      void this.train();
    });
    this.again.addEventListener('click', () => void this.repeat());
    byId('aim-apply', HTMLButtonElement).addEventListener('click', () => void this.applyAim());
    byId('aim-cancel', HTMLButtonElement).addEventListener('click', () => this.dropAim());
    this.listen(keys);
    store.on('hello', () => {
      setText(this.answer, '');
      showLines(this.error, []);
      this.dropAim();
      this.show();
      this.reading.replace();
    });
    store.on('pushes', () => this.show());
    store.on('event', () => {
      const kind = store.events[store.events.length - 1]?.kind ?? '';
      if (kind.startsWith('push')) this.reading.refresh();
    });
    // What an active push has delivered so far changes without an event.
    store.on('simulation', () => {
      if (store.pushes.some((push) => push.state === 'active')) this.reading.refresh();
    });
  }

  /** What is on the list and what is aimed at, for tests. */
  state(): Record<string, unknown> {
    return {
      listed: this.store.pushes.slice(0, listedPushes).map(({ id, state, impulseNs }) => ({ id, state, impulseNs })),
      aimed: this.aimedAt,
      spring:
        this.spring === null
          ? null
          : { pushes: this.spring.pieces, impulse_ns: this.spring.impulseNs },
    };
  }

  /** The push of the form, or null when it has no numbers yet; for links and curl. */
  body(): PushBody | null {
    const choice = this.form.choice();
    return missingNumber(choice) === null ? buildPush(choice) : null;
  }

  /** Every push of the last spring, else the form's, as commands for a terminal. */
  curl(): string {
    const { origin } = window.location;
    if (this.spring !== null && this.spring.pieces.length > 0) {
      return this.spring.pieces.map(({ body }) => curlOf(origin, body)).join('\n');
    }
    const body = this.aimedAt ?? this.body();
    return body === null ? '' : curlOf(origin, body);
  }

  aimed(grip: Grip, directionDeg: number, impulseNs: number): void {
    const choice: PushChoice = {
      ...this.form.choice(directionDeg),
      ...(grip.link === null ? {} : { link: grip.link }),
      point: grip.point,
      strength: { impulseNs },
      when: 'now',
    };
    this.spring = null;
    this.aimedAt = buildPush(choice);
    this.form.fill(this.aimedAt);
    const mass = this.store.robot?.massKg ?? Number.NaN;
    const place = grip.point === null ? 'the centre of mass' : `(${grip.point.join(', ')}) m`;
    setText(
      byId('aim-text', HTMLElement),
      `${impulseNs} N s ${directionWords(directionDeg)} over ${choice.durationS} s, ` +
        `Δv ${formatNumber(deltaV(impulseNs, mass), 2)} m/s`,
    );
    setText(byId('aim-place', HTMLElement), `on ${choice.link} at ${place}`);
    this.card.hidden = false;
    byId('aim-apply', HTMLButtonElement).focus();
  }

  springBegan(grip: Grip): void {
    this.dropAim();
    showLines(this.error, []);
    this.spring = new SpringPull(this.api, grip, (error) => {
      showLines(this.error, linesOf(error));
    });
  }

  springPulls(force: readonly [number, number, number]): void {
    this.spring?.pull(force);
  }

  springEnded(): void {
    const { spring } = this;
    if (spring === null) return;
    void spring.end().then(() => {
      const { pieces } = spring;
      setText(
        this.answer,
        pieces.length === 0
          ? ''
          : `Spring: ${pieces.length} pushes in a row, ` +
              `${formatShort(spring.impulseNs, 2)} N s. “Copy as curl” has them all.`,
      );
      this.reading.refresh();
    });
  }

  private listen(keys: Keys): void {
    const arrows: readonly (readonly [string, Direction, string])[] = [
      ['ArrowUp', 'forward', '↑'],
      ['ArrowLeft', 'left', '←'],
      ['ArrowRight', 'right', '→'],
      ['ArrowDown', 'backward', '↓'],
    ];
    for (const [key, direction, shown] of arrows) {
      const run = (): void => void this.push(this.form.choice(directions[direction]));
      const words = direction === 'left' || direction === 'right' ? `to its ${direction}` : direction;
      keys.add({ key, shown, group: 'Push', text: `Push ${words}`, run, on: () => this.arrowKeys.checked });
    }
    keys.add({ key: 'p', group: 'Push', text: 'The same push again', run: () => void this.repeat() });
    keys.add({ key: '+', group: 'Push', text: 'Stronger', run: () => this.form.scale(1.25) });
    keys.add({ key: '-', group: 'Push', text: 'Weaker', run: () => this.form.scale(0.8) });
    keys.add({
      key: 'Escape',
      group: 'Push',
      text: 'Drop the aimed push',
      run: () => this.dropAim(),
      on: () => this.aimedAt !== null,
    });
  }

  private async applyAim(): Promise<void> {
    const body = this.aimedAt;
    this.dropAim();
    if (body !== null) await this.send(body);
  }

  private dropAim(): void {
    this.aimedAt = null;
    this.card.hidden = true;
    this.onAimDone();
  }

  private async push(choice: PushChoice): Promise<void> {
    const missing = missingNumber(choice);
    setText(this.answer, '');
    if (missing !== null) {
      showLines(this.error, [missing]);
      return;
    }
    this.spring = null;
    await this.send(buildPush(choice));
  }

  private async repeat(): Promise<void> {
    if (this.last !== null) await this.send(this.last);
  }

  private async send(body: PushBody): Promise<PushResource | null> {
    let push: PushResource | null = null;
    await attempt(this.error, async () => {
      push = await this.api.push(body);
      this.last = body;
      this.again.disabled = false;
      const waits = body.trigger !== undefined || body.at_s !== undefined;
      const until =
        push.state === 'scheduled' && waits
          ? body.trigger !== undefined
            ? ' waits for its phase'
            : ` waits for ${body.at_s ?? 0} s`
          : '';
      setText(
        this.answer,
        `Push ${push.id}: ${formatShort(push.impulseNs, 3)} N s ` +
          `${directionName(push.directionDeg)}${until}.`,
      );
    });
    this.reading.refresh();
    return push;
  }

  /** The form's push, once or in a train: every further one at its own exact time. */
  private async train(): Promise<void> {
    const count = numberIn(byId('train-count', HTMLInputElement));
    const every = numberIn(byId('train-every', HTMLInputElement));
    const choice = this.form.choice();
    if (!Number.isInteger(count) || count < 1 || count > mostOfATrain) {
      showLines(this.error, [`The number of pushes must be whole, 1 to ${mostOfATrain}.`]);
      return;
    }
    if (count === 1) {
      await this.push(choice);
      return;
    }
    if (!(every > 0)) {
      showLines(this.error, ['The time between pushes must be more than 0 s.']);
      return;
    }
    if (choice.when !== 'now' && 'phase' in choice.when) {
      showLines(this.error, ['A train goes by time: choose at once or a time, not a phase.']);
      return;
    }
    const missing = missingNumber(choice);
    if (missing !== null) {
      showLines(this.error, [missing]);
      return;
    }
    const first = await this.send(buildPush(choice));
    if (first === null) return;
    const startS = choice.when === 'now' ? first.tick * 0.001 : choice.when.atS;
    for (let i = 1; i < count; i += 1) {
      const atS = Number((startS + i * every).toFixed(3));
      if ((await this.send(buildPush({ ...choice, when: { atS } }))) === null) return;
    }
    this.last = buildPush(choice);
    setText(this.answer, `A train of ${count} pushes, one every ${every} s.`);
  }

  /** Those that are listed, and on to the one that is told of: of a train it is the oldest that begins. */
  private get wantedPushes(): number {
    const { pushes, story } = this.store;
    const [newest] = pushes;
    const since = newest === undefined || story === null ? 0 : newest.id - story.id + 1;
    return Math.min(mostPushes, Math.max(listedPushes, since));
  }

  private show(): void {
    const pushes = this.store.pushes.slice(0, listedPushes);
    this.empty.hidden = pushes.length > 0;
    const torso = this.store.robot?.torsoLink ?? 'torso';
    keepRows(
      this.list,
      this.rows,
      pushes.map((push) => ({ id: String(push.id), push })),
      ({ push }) => new PushRow(push, () => void this.cancel(push.id)),
      (row, { push }) => row.update(push, torso),
    );
  }

  private async cancel(id: number): Promise<void> {
    await attempt(this.error, () => this.api.cancelPush(id));
    this.reading.refresh();
  }
}
