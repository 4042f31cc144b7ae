// The push panel: an arrow pad around the impulse, the arrow keys, and what became of the pushes.

import type { Api, PushResource } from '../api';
import { linesOf } from '../api';
import { byId, fillSelect, formatNumber, formatShort, numberIn, setText, showLines } from '../dom';
import {
  buildPush,
  deltaV,
  directionName,
  directionOfKey,
  directions,
  missingNumber,
  peakForce,
} from '../push_request';
import type { Direction, Leg, Phase, Profile, PushChoice, PushTrigger } from '../push_request';
import type { Store } from '../store';

const listedPushes = 6;

function isDirection(name: string | undefined): name is Direction {
  return name !== undefined && name in directions;
}

/** Whether a key pressed there belongs to what has the focus: typing, choosing, scrolling. */
function usesArrows(target: EventTarget | null): boolean {
  return (
    target instanceof Element &&
    target.closest('input:not([type=checkbox]), select, textarea, ol') !== null
  );
}

export class PushPanel {
  private readonly impulse = byId('impulse', HTMLInputElement);
  private readonly duration = byId('duration', HTMLInputElement);
  private readonly link = byId('link', HTMLSelectElement);
  private readonly profile = byId('profile', HTMLSelectElement);
  private readonly trigger = byId('trigger', HTMLSelectElement);
  private readonly fraction = byId('fraction', HTMLInputElement);
  private readonly angle = byId('angle', HTMLInputElement);
  private readonly arrowKeys = byId('arrow-keys', HTMLInputElement);
  private readonly equals = byId('push-equals', HTMLElement);
  private readonly answer = byId('push-answer', HTMLElement);
  private readonly error = byId('push-error', HTMLElement);
  private readonly rows = byId('pushes', HTMLTableSectionElement);
  private readonly empty = byId('pushes-empty', HTMLElement);
  private pushes: readonly PushResource[] = [];
  private reading = false;
  private readAgain = false;

  constructor(
    private readonly store: Store,
    private readonly api: Api,
  ) {
    for (const button of document.querySelectorAll<HTMLButtonElement>('[data-direction]')) {
      const direction = button.dataset['direction'];
      if (isDirection(direction)) {
        button.addEventListener('click', () => void this.push(directions[direction]));
      }
    }
    byId('push-angle', HTMLButtonElement).addEventListener(
      'click',
      () => void this.push(numberIn(this.angle)),
    );
    for (const input of [this.impulse, this.duration, this.profile]) {
      input.addEventListener('input', () => this.showEquals());
    }
    this.trigger.addEventListener('change', () => {
      this.fraction.disabled = this.trigger.value === '';
    });
    document.addEventListener('keydown', (event) => this.key(event));
    store.on('robot', () => this.robotChanged());
    store.on('hello', () => {
      setText(this.answer, '');
      showLines(this.error, []);
      this.show([]);
      void this.readPushes();
    });
    store.on('event', () => {
      const kind = store.events[store.events.length - 1]?.kind ?? '';
      if (kind.startsWith('push')) void this.readPushes();
    });
    // What an active push has delivered so far changes without an event.
    store.on('simulation', () => {
      if (this.pushes.some((push) => push.state === 'active')) void this.readPushes();
    });
    this.showEquals();
  }

  /** What is on the list, for tests. */
  state(): Record<string, unknown> {
    return { listed: this.pushes.map(({ id, state, impulseNs }) => ({ id, state, impulseNs })) };
  }

  private choice(directionDeg: number): PushChoice {
    return {
      link: this.link.value,
      directionDeg,
      impulseNs: numberIn(this.impulse),
      durationS: numberIn(this.duration),
      profile: this.profile.value as Profile,
      trigger: this.chosenTrigger(),
    };
  }

  private chosenTrigger(): PushTrigger | null {
    const [phase, leg] = this.trigger.value.split(' ');
    if (phase === undefined || phase === '') return null;
    return {
      phase: phase as Phase,
      ...(leg === undefined ? {} : { leg: leg as Leg }),
      fraction: numberIn(this.fraction),
    };
  }

  private async push(directionDeg: number): Promise<void> {
    const choice = this.choice(directionDeg);
    const missing = missingNumber(choice);
    setText(this.answer, '');
    if (missing !== null) {
      showLines(this.error, [missing]);
      return;
    }
    try {
      const push = await this.api.push(buildPush(choice));
      showLines(this.error, []);
      const when =
        push.state === 'scheduled' && choice.trigger !== null ? ' waits for its phase' : '';
      setText(
        this.answer,
        `Push ${push.id}: ${formatShort(choice.impulseNs, 3)} N s ` +
          `${directionName(directionDeg)}${when}.`,
      );
    } catch (error) {
      showLines(this.error, linesOf(error));
    }
    void this.readPushes();
  }

  private key(event: KeyboardEvent): void {
    const direction = directionOfKey(event.key);
    if (direction === null || !this.arrowKeys.checked) return;
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (usesArrows(event.target)) return;
    event.preventDefault();
    if (!event.repeat) void this.push(directions[direction]);
  }

  private robotChanged(): void {
    const { robot } = this.store;
    const links = robot === null || robot.links.length === 0 ? ['torso'] : robot.links;
    fillSelect(this.link, links, robot?.torsoLink ?? 'torso');
    this.showEquals();
  }

  private showEquals(): void {
    const impulse = numberIn(this.impulse);
    const duration = numberIn(this.duration);
    const mass = this.store.robot?.massKg ?? Number.NaN;
    const force = peakForce(impulse, duration, this.profile.value as Profile);
    const parts = [`${formatNumber(force, 0)} N peak`];
    if (Number.isFinite(mass)) parts.push(`Δv ${formatNumber(deltaV(impulse, mass), 2)} m/s`);
    setText(this.equals, parts.join('  ·  '));
  }

  /** One request at a time; news that comes meanwhile asks once more. */
  private async readPushes(): Promise<void> {
    if (this.reading) {
      this.readAgain = true;
      return;
    }
    this.reading = true;
    const session = this.store.hello?.sessionId;
    try {
      const pushes = await this.api.pushes(listedPushes);
      if (session === this.store.hello?.sessionId) this.show(pushes);
    } catch {
      // The connection's own state tells that the server is away; the list stays as it was.
    } finally {
      this.reading = false;
      if (this.readAgain) {
        this.readAgain = false;
        void this.readPushes();
      }
    }
  }

  private show(pushes: readonly PushResource[]): void {
    this.pushes = pushes;
    this.empty.hidden = pushes.length > 0;
    this.rows.replaceChildren(...pushes.map((push) => this.row(push)));
  }

  private row(push: PushResource): HTMLTableRowElement {
    const row = document.createElement('tr');
    row.className = `state-${push.state}`;
    const what = row.insertCell();
    what.textContent =
      `${push.id}. ${formatShort(push.impulseNs, 3)} N s ${directionName(push.directionDeg)}` +
      (push.link === (this.store.robot?.torsoLink ?? 'torso') ? '' : `, ${push.link}`);
    row.insertCell().textContent = push.state;
    const last = row.insertCell();
    if (push.state === 'scheduled') {
      const cancel = document.createElement('button');
      cancel.type = 'button';
      cancel.className = 'small';
      cancel.textContent = 'Cancel';
      cancel.setAttribute('aria-label', `Cancel push ${push.id}`);
      cancel.addEventListener('click', () => void this.cancel(push.id));
      last.append(cancel);
    } else {
      last.textContent = `${formatNumber(push.deliveredNs, 2)} N s`;
      last.title = 'Impulse that has acted on the robot';
    }
    return row;
  }

  private async cancel(id: number): Promise<void> {
    try {
      await this.api.cancelPush(id);
      showLines(this.error, []);
    } catch (error) {
      showLines(this.error, linesOf(error));
    }
    void this.readPushes();
  }
}
