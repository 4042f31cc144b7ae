// A list of steps to walk: put down by clicks on the view from above, or typed; then walked as one.

import type { Api } from '../api';
import { attempt } from '../attempt';
import { byId, formatNumber, numberIn, setText, showLines, smallButton } from '../dom';
import type { Store } from '../store';
import type { GroundCanvas } from '../views/ground_canvas';
import type { TopView } from '../views/top_view';
import { soleCorners } from '../views/transform';
import type { Point } from '../views/transform';

export interface ListedStep {
  readonly side: 'left' | 'right';
  readonly x: number;
  readonly y: number;
  readonly yaw_deg: number;
}

const mostSteps = 64;

/** The step that follows: the other foot; the first one is that on whose side it is put down. */
export function nextSide(
  steps: readonly ListedStep[],
  place: Point,
  middle: Point,
  heading: number,
): ListedStep['side'] {
  const last = steps[steps.length - 1];
  if (last !== undefined) return last.side === 'left' ? 'right' : 'left';
  const [dx, dy] = [place.x - middle.x, place.y - middle.y];
  return -Math.sin(heading) * dx + Math.cos(heading) * dy >= 0 ? 'left' : 'right';
}

export class StepsPanel {
  private readonly section = byId('steps-details', HTMLDetailsElement);
  private readonly rows = byId('steps', HTMLTableSectionElement);
  private readonly error = byId('steps-error', HTMLElement);
  private steps: ListedStep[] = [];

  constructor(
    private readonly store: Store,
    private readonly api: Api,
    private readonly view: TopView,
    private readonly done: () => void,
  ) {
    this.section.addEventListener('toggle', () => this.arm());
    byId('step-add', HTMLButtonElement).addEventListener('click', () => {
      this.add({
        x: numberIn(byId('step-x', HTMLInputElement)),
        y: numberIn(byId('step-y', HTMLInputElement)),
      });
    });
    byId('steps-undo', HTMLButtonElement).addEventListener('click', () => {
      this.steps.pop();
      this.show();
    });
    byId('steps-walk', HTMLButtonElement).addEventListener('click', () => void this.walk());
    view.overlays.push((ground) => this.draw(ground));
    store.on('hello', () => {
      this.steps = [];
      this.show();
    });
    // A server that takes lists of steps tells of its parameters, too.
    store.on('simulation', () => {
      this.section.hidden = store.simulation?.parameters === null;
    });
    this.show();
  }

  state(): Record<string, unknown> {
    return { listed: this.steps, taking: this.view.onClick !== null };
  }

  private arm(): void {
    this.view.onClick = this.section.open ? (place) => this.add(place) : null;
    this.view.redraw();
  }

  private add(place: Point): void {
    if (!Number.isFinite(place.x) || !Number.isFinite(place.y)) {
      showLines(this.error, ['A step needs x and y.']);
      return;
    }
    if (this.steps.length >= mostSteps) {
      showLines(this.error, [`A list has at most ${mostSteps} steps.`]);
      return;
    }
    const { heading } = this.store;
    const [left, right] = [this.store.values('left_foot'), this.store.values('right_foot')];
    const middle = {
      x: ((left[0] ?? 0) + (right[0] ?? 0)) / 2,
      y: ((left[1] ?? 0) + (right[1] ?? 0)) / 2,
    };
    const side = nextSide(this.steps, place, middle, heading);
    const round = (value: number): number => Number(value.toFixed(3));
    const typed = numberIn(byId('step-yaw', HTMLInputElement));
    const yaw = Number.isFinite(typed) ? typed : (heading * 180) / Math.PI;
    this.steps.push({ side, x: round(place.x), y: round(place.y), yaw_deg: Number(yaw.toFixed(1)) });
    showLines(this.error, []);
    this.show();
  }

  private async walk(): Promise<void> {
    if (!(await attempt(this.error, () => this.api.walkSteps(this.steps)))) return;
    this.steps = [];
    this.show();
    this.done();
  }

  private show(): void {
    this.rows.replaceChildren(
      ...this.steps.map(({ side, x, y, yaw_deg: yaw }, i) => {
        const row = document.createElement('tr');
        for (const text of [
          `${i + 1}. ${side}`,
          formatNumber(x, 3),
          formatNumber(y, 3),
          `${formatNumber(yaw, 1)}°`,
        ]) {
          row.insertCell().textContent = text;
        }
        row.insertCell().append(this.turnButton(i));
        return row;
      }),
    );
    const none = this.steps.length === 0;
    byId('steps-walk', HTMLButtonElement).disabled = none;
    byId('steps-undo', HTMLButtonElement).disabled = none;
    setText(byId('steps-count', HTMLElement), none ? 'None yet.' : `${this.steps.length} of 64`);
    this.view.redraw();
  }

  /** The feet go in turn: a step can be turned, and the last one taken back. */
  private turnButton(i: number): HTMLButtonElement {
    const turn = (): void => {
      this.steps = this.steps.map((step, k) =>
        k === i ? { ...step, yaw_deg: Number((step.yaw_deg + 15).toFixed(1)) } : step,
      );
      this.show();
      this.rows.rows[i]?.querySelector('button')?.focus();
    };
    return smallButton('↶ 15°', turn, `Turn step ${i + 1} by 15° to the left`);
  }

  private draw(ground: GroundCanvas): void {
    const sole = this.store.robot?.sole ?? { lengthM: 0.15, widthM: 0.075 };
    this.steps.forEach(({ x, y, yaw_deg: yaw }, i) => {
      const foot = { x, y, yaw: (yaw * Math.PI) / 180 };
      ground.outline(soleCorners(foot, sole.lengthM, sole.widthM), ground.theme.planned, 2);
      ground.words(String(i + 1), foot, ground.theme.planned);
    });
  }
}
