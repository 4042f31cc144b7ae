// Walking: a pad of two axes, the keys, a form, stepping in place, stop.

import type { Api, CommandAnswer } from '../api';
import { attempt } from '../attempt';
import { byId, formatNumber, numberIn, setText, showLines } from '../dom';
import type { Keys } from '../keys';
import type { Store } from '../store';
import type { Walk } from '../trial';

/** What the API takes at most (docs/api.md). */
const limits: Walk = { vx: 0.5, vy: 0.3, wz: 0.5 };
const keyStep = 0.05;
/** While the pad is dragged no more than one command in this time [ms]. */
const padPeriodMs = 150;

const clamp = (value: number, most: number): number => Math.min(most, Math.max(-most, value));
const round = (value: number): number => Number(value.toFixed(2)) + 0;

export class WalkPanel {
  private readonly answer = byId('walk-answer', HTMLElement);
  private readonly error = byId('walk-error', HTMLElement);
  private readonly pad = byId('walk-pad', HTMLElement);
  private readonly knob = byId('walk-knob', HTMLElement);
  private readonly inputs = {
    vx: byId('vx', HTMLInputElement),
    vy: byId('vy', HTMLInputElement),
    wz: byId('wz', HTMLInputElement),
  };
  private wanted: Walk = { vx: 0, vy: 0, wz: 0 };
  private held = false;
  private sending = false;
  /** Commands without an answer yet: what the server says of walking is from before them. */
  private unanswered = 0;
  private sendNext = false;

  constructor(
    store: Store,
    private readonly api: Api,
    keys: Keys,
    private readonly done: () => void,
  ) {
    byId('walk-in-place', HTMLButtonElement).addEventListener('click', () => this.inPlace());
    byId('walk-stop', HTMLButtonElement).addEventListener('click', () => this.stop());
    byId('walk-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      const { vx, vy, wz } = this.inputs;
      const velocity = { vx: numberIn(vx), vy: numberIn(vy), wz: numberIn(wz) };
      if (Object.values(velocity).some((value) => !Number.isFinite(value))) {
        setText(this.answer, '');
        showLines(this.error, ['Each of the three velocities must be a number.']);
        return;
      }
      this.wanted = velocity;
      void this.command('Walks', () => api.walk(velocity));
    });
    this.pad.addEventListener('pointerdown', (event) => this.drag(event));
    this.listen(keys);
    store.on('hello', () => {
      setText(this.answer, '');
      showLines(this.error, []);
    });
    store.on('simulation', () => {
      const { simulation } = store;
      if (simulation === null || this.held || this.sending || this.unanswered > 0) return;
      this.wanted = simulation.walk;
      this.showKnob();
    });
    this.showKnob();
  }

  private listen(keys: Keys): void {
    const steps: readonly (readonly [string, string, Partial<Walk>])[] = [
      ['w', 'Faster forward', { vx: keyStep }],
      ['s', 'Slower, then backward', { vx: -keyStep }],
      ['a', 'More to its left', { vy: keyStep }],
      ['d', 'More to its right', { vy: -keyStep }],
      ['q', 'Turn more to its left', { wz: keyStep }],
      ['e', 'Turn more to its right', { wz: -keyStep }],
    ];
    for (const [key, text, { vx = 0, vy = 0, wz = 0 }] of steps) {
      const run = (): void => {
        const { wanted } = this;
        this.go({ vx: wanted.vx + vx, vy: wanted.vy + vy, wz: wanted.wz + wz });
      };
      keys.add({ key, group: 'Walk', text, run });
    }
    keys.add({ key: 'z', group: 'Walk', text: 'Step in place', run: () => this.inPlace() });
    keys.add({ key: 'x', group: 'Walk', text: 'Stop', run: () => this.stop() });
  }

  private inPlace(): void {
    this.wanted = { vx: 0, vy: 0, wz: 0 };
    this.showKnob();
    void this.command('Steps in place', () => this.api.walk(this.wanted));
  }

  private stop(): void {
    this.wanted = { vx: 0, vy: 0, wz: 0 };
    this.showKnob();
    void this.command('Stops', () => this.api.stop());
  }

  /** Within what the API takes, in steps that can be read. */
  private go({ vx, vy, wz }: Walk): void {
    this.wanted = {
      vx: round(clamp(vx, limits.vx)),
      vy: round(clamp(vy, limits.vy)),
      wz: round(clamp(wz, limits.wz)),
    };
    this.inputs.vx.value = String(this.wanted.vx);
    this.inputs.vy.value = String(this.wanted.vy);
    this.inputs.wz.value = String(this.wanted.wz);
    this.showKnob();
    void this.sendWanted();
  }

  /** The newest wish only, one request at a time. */
  private async sendWanted(): Promise<void> {
    if (this.sending) {
      this.sendNext = true;
      return;
    }
    this.sending = true;
    do {
      this.sendNext = false;
      const wish = this.wanted;
      await this.command('Walks', () => this.api.walk(wish));
      await new Promise((resolve) => setTimeout(resolve, padPeriodMs));
    } while (this.sendNext);
    this.sending = false;
  }

  /** Up is forward, left is to the robot's left; let go it stays. */
  private drag(down: PointerEvent): void {
    if (down.button !== 0) return;
    const { pad } = this;
    const box = pad.getBoundingClientRect();
    this.held = true;
    const move = (event: PointerEvent): void => {
      const x = (2 * (event.clientX - box.left)) / box.width - 1;
      const y = (2 * (event.clientY - box.top)) / box.height - 1;
      const soft = (share: number): number => (Math.abs(share) < 0.06 ? 0 : share);
      this.go({ vx: -soft(y) * limits.vx, vy: -soft(x) * limits.vy, wz: this.wanted.wz });
    };
    const end = (): void => {
      this.held = false;
      pad.removeEventListener('pointermove', move);
      pad.removeEventListener('pointerup', end);
      pad.removeEventListener('pointercancel', end);
    };
    pad.setPointerCapture(down.pointerId);
    pad.addEventListener('pointermove', move);
    pad.addEventListener('pointerup', end);
    pad.addEventListener('pointercancel', end);
    move(down);
  }

  private showKnob(): void {
    const { vx, vy, wz } = this.wanted;
    this.knob.style.left = `${50 - (50 * vy) / limits.vy}%`;
    this.knob.style.top = `${50 - (50 * vx) / limits.vx}%`;
    setText(
      byId('walk-wanted', HTMLElement),
      `${formatNumber(vx, 2)} m/s forward, ${formatNumber(vy, 2)} m/s left, ${formatNumber(wz, 2)} rad/s`,
    );
  }

  private async command(words: string, send: () => Promise<CommandAnswer>): Promise<void> {
    setText(this.answer, '');
    this.unanswered += 1;
    await attempt(this.error, async () => {
      const { timeS } = await send();
      setText(this.answer, `${words} from ${formatNumber(timeS, 3)} s.`);
    });
    this.unanswered -= 1;
    this.done();
  }
}
