// What saved the robot from its last push, or did not, live or in a recording; and what a live push does
// without each of the strategies, tried in worlds of their own.

import type { Api, TrialResult } from '../api';
import { Problem, linesOf } from '../api';
import { byId, formatNumber, formatShort, setText, showLines } from '../dom';
import type { PushStory, SavingStep } from '../explain';
import type { PushResource } from '../push_body';
import { directionName, pushAgain } from '../push_request';
import type { Store } from '../store';
import { trialJson, trialLike, trialLink } from '../trial';
import type { TrialSpec } from '../trial';

const periodMs = 200;
const settleS = 3;
const observeS = 4;
/** The server does one trial at a time [ms]. */
const retryMs = 500;

const centimetres = (metres: number): string => `${formatNumber(100 * metres, 1)} cm`;

interface Row {
  readonly name: string;
  readonly without: string | null;
  readonly spec: TrialSpec;
  result: TrialResult | null;
}

export class ExplainPanel {
  private readonly card = byId('explain-panel', HTMLElement);
  private readonly title = byId('explain-title', HTMLElement);
  private readonly verdict = byId('explain-verdict', HTMLElement);
  private readonly list = byId('explain-list', HTMLElement);
  private readonly compare = byId('explain-compare', HTMLButtonElement);
  private readonly table = byId('explain-trials', HTMLTableElement);
  private readonly progress = byId('explain-progress', HTMLElement);
  private readonly error = byId('explain-error', HTMLElement);
  private told: PushStory | null = null;
  private toldVersion = -1;
  private rows: readonly Row[] = [];
  private busy = false;
  private lastDraw = 0;

  constructor(
    private readonly live: Store,
    private readonly shown: Store,
    private readonly api: Api,
  ) {
    this.compare.addEventListener('click', () => void this.compareAll());
    live.on('event', () => {
      if (live.events[live.events.length - 1]?.kind !== 'push_started' || this.busy) return;
      this.rows = [];
      this.showTrials();
    });
  }

  update(nowMs: number): void {
    const { story, version } = this.shown;
    this.card.hidden = story === null;
    this.compare.disabled = this.busy || pushOf(this.live) === null;
    const due = nowMs - this.lastDraw >= periodMs && version !== this.toldVersion;
    if (story === null || (story === this.told && !due)) return;
    this.lastDraw = nowMs;
    this.told = story;
    this.toldVersion = version;
    this.show(story);
  }

  state(): Record<string, unknown> {
    const { story } = this.shown;
    return {
      push: story?.id ?? null,
      ending: story?.ending ?? null,
      steps: story?.steps ?? [],
      steps_to_recover: story?.stepsToRecover ?? null,
      recovery_s: story?.recoveryS ?? null,
      margin_m: story?.marginM ?? null,
      trigger: story?.trigger ?? null,
      busy: this.busy,
      trials: this.rows.map(({ name, spec, result }) => ({ name, spec: trialJson(spec), result })),
    };
  }

  private titleOf({ id, impulseNs }: PushStory): string {
    const push = pushOf(this.shown);
    const way = push === null ? '' : ` ${directionName(push.directionDeg)}`;
    return `Push ${id}: ${formatShort(impulseNs, 3)} N s${way}`;
  }

  private show(story: PushStory): void {
    setText(this.title, this.titleOf(story));
    setText(this.verdict, this.verdictOf(story));
    this.verdict.dataset['verdict'] =
      story.ending === 'recovered' ? 'yes' : story.ending === 'fell' ? 'no' : 'none';
    const acts = (name: string): string => (story.strategies[name] === false ? ' (off)' : '');
    const lines: [string, string][] = [
      [`Ankle${acts('ankle')}`, this.ankle(story)],
      [`Hip${acts('hip')}`, this.hip(story)],
      [`Step${acts('step')}`, places(story.steps)],
      [`Time${acts('time')}`, times(story.steps)],
    ];
    if (story.marginM !== null) {
      const { marginM } = story;
      lines.push([
        'Margin left',
        marginM >= 0
          ? `${centimetres(marginM)} at the least; at 0 no step saves it`
          : `none: a step was ${centimetres(-marginM)} short at the worst`,
      ]);
    }
    const shown = Array.from(this.list.children);
    lines.forEach(([name, text], i) => {
      let row = shown[i];
      if (row === undefined) {
        row = document.createElement('div');
        row.append(document.createElement('dt'), document.createElement('dd'));
        this.list.append(row);
      }
      const [term, value] = Array.from(row.children);
      if (term !== undefined) setText(term, name);
      if (value !== undefined) setText(value, text);
    });
    for (const row of shown.slice(lines.length)) row.remove();
  }

  private verdictOf(story: PushStory): string {
    const { stepsToRecover: steps } = story;
    switch (story.ending) {
      case 'watching':
        return 'Under way…';
      case 'pushed again':
        return 'Another push came before it was back.';
      case 'recovered':
        return (
          `Recovered ${steps === 0 ? 'without a step of its own' : steps === 1 ? 'with the first step' : `after ${steps} steps`}, ` +
          `${formatNumber(story.recoveryS, 2)} s after the push.`
        );
      case 'fell': {
        const after = (story.fallS ?? story.startS) - story.startS;
        const why = story.fallWords.replace(/^the robot has fallen: /, '');
        const since =
          story.lostS === null
            ? ''
            : ` No step reached far enough from ${formatNumber(story.lostS - story.startS, 2)} s on.`;
        return `Fell after ${formatNumber(after, 2)} s: ${why}.${since}`;
      }
    }
  }

  private ankle({ ankle }: PushStory): string {
    if (ankle === null) return 'the ZMP stayed at its reference';
    const { shiftM, roomM } = ankle;
    const share = Math.min(100, (100 * shiftM) / Math.max(roomM, 1e-6));
    return `moved the ZMP by ${centimetres(shiftM)} of ${centimetres(roomM)} (${share.toFixed(0)} %)`;
  }

  private hip({ hipNms }: PushStory): string {
    if (this.shown.hello?.plant === 'lipm') return 'a point has no angular momentum';
    return `angular momentum changed by ${formatNumber(hipNms, 2)} N m s at most`;
  }

  /** The push in a fresh world, at the same phase of the gait, with all strategies and without each. */
  private async compareAll(): Promise<void> {
    const { story } = this.live;
    const push = pushOf(this.live);
    if (story === null || push === null || this.busy) return;
    const again = pushAgain(push.spec, story.trigger);
    const now = trialLike(this.live, again, settleS, observeS);
    if (now === null) return;
    // Since then it may have fallen, or have been told to walk otherwise.
    const spec = { ...now, walk: story.stood ? null : (story.walk ?? { vx: 0, vy: 0, wz: 0 }) };
    this.rows = [
      { name: 'as it is', without: null, spec, result: null },
      ...spec.strategies.map((name) => ({
        name: `without ${name}`,
        without: name,
        spec: { ...spec, strategies: spec.strategies.filter((other) => other !== name) },
        result: null,
      })),
    ];
    this.busy = true;
    showLines(this.error, []);
    this.showTrials();
    try {
      for (const row of this.rows) {
        setText(this.progress, `Trying ${row.name}…`);
        row.result = await this.trial(row.spec);
        this.showTrials();
      }
      const when = story.trigger === null ? '' : ', at the same phase of the gait';
      setText(this.progress, `In fresh worlds${when}. A press on an outcome shows it here.`);
    } catch (error) {
      setText(this.progress, '');
      showLines(this.error, linesOf(error));
    }
    this.busy = false;
    this.showTrials();
  }

  private async trial(spec: TrialSpec): Promise<TrialResult> {
    for (;;) {
      try {
        return await this.api.trial(trialJson(spec));
      } catch (error) {
        if (!(error instanceof Problem && error.status === 503)) throw error;
        await new Promise((resolve) => setTimeout(resolve, retryMs));
      }
    }
  }

  private showTrials(): void {
    this.table.hidden = this.rows.length === 0;
    if (this.rows.length === 0) setText(this.progress, '');
    const body = this.table.tBodies[0];
    body?.replaceChildren(
      ...this.rows.map(({ name, spec, result }) => {
        const row = document.createElement('tr');
        const head = document.createElement('th');
        head.scope = 'row';
        head.textContent = name;
        const outcome = document.createElement('td');
        if (result === null) {
          outcome.textContent = '…';
        } else {
          const link = document.createElement('a');
          link.href = trialLink(window.location.href, spec);
          link.textContent = result.outcome;
          link.title = 'Watch it: resets this world';
          outcome.append(link);
          outcome.className = `outcome-${result.outcome}`;
        }
        const steps = document.createElement('td');
        steps.textContent = result === null ? '' : formatNumber(result.stepsToRecover ?? NaN, 0);
        const time = document.createElement('td');
        time.textContent = result === null ? '' : formatNumber(result.recoveryTimeS ?? NaN, 2);
        row.append(head, outcome, steps, time);
        return row;
      }),
    );
  }
}

/** The push that is told of, once the list of pushes has come. */
function pushOf({ pushes, story }: Store): PushResource | null {
  return pushes.find(({ id }) => id === story?.id) ?? null;
}

const place = (x: number, y: number): string => `(${formatNumber(x, 2)}, ${formatNumber(y, 2)})`;
const mostListed = 3;

function more(steps: readonly SavingStep[]): string {
  return steps.length > mostListed ? `; and ${steps.length - mostListed} more` : '';
}

function places(steps: readonly SavingStep[]): string {
  const moved = steps.filter(({ movedM }) => movedM > 0.02);
  if (moved.length === 0) return 'all within 2 cm of their plan';
  const told = moved.slice(0, mostListed).map(
    ({ side, planned, landed, movedM }) =>
      `${side} ${place(planned.x, planned.y)} → ${place(landed.x, landed.y)} m, moved ${centimetres(movedM)}`,
  );
  return told.join('; ') + more(moved);
}

function times(steps: readonly SavingStep[]): string {
  const moved = steps.filter(({ plannedS, actualS }) => Math.abs(actualS - plannedS) > 0.02);
  if (moved.length === 0) return 'all within 20 ms of their plan';
  const told = moved.slice(0, mostListed).map(
    ({ side, plannedS, actualS }) =>
      `${side} ${formatNumber(plannedS, 2)} → ${formatNumber(actualS, 2)} s`,
  );
  return told.join('; ') + more(moved);
}
