// The bar on top: in clear words, whether what is shown is happening now.

import { byId, formatNumber, setText } from '../dom';
import type { Condition, Store } from '../store';
import type { Stream } from '../stream';

const words: Readonly<Record<Condition, string>> = {
  connecting: 'Connecting…',
  live: 'Live',
  paused: 'Paused',
  fallen: 'Fallen',
  lost: 'Connection lost',
};

export class ConditionBar {
  private readonly condition = byId('condition', HTMLElement);
  private readonly text = byId('condition-text', HTMLElement);
  private readonly retry = byId('retry-now', HTMLButtonElement);
  private readonly robot = byId('bar-robot', HTMLElement);
  private readonly terrain = byId('bar-terrain', HTMLElement);
  private readonly verdict = byId('verdict', HTMLElement);
  private readonly walking = byId('bar-walking', HTMLElement);
  private readonly time = byId('bar-time', HTMLElement);
  private readonly speed = byId('bar-speed', HTMLElement);
  private readonly banner = byId('fall-banner', HTMLElement);
  private readonly reason = byId('fall-reason', HTMLElement);
  private readonly stale = byId('stale', HTMLElement);

  constructor(
    private readonly store: Store,
    stream: Stream,
    announce: (text: string) => void,
  ) {
    this.retry.addEventListener('click', () => stream.retryNow());
    store.on('condition', () => announce(this.sentence()));
  }

  update(topView: Readonly<Record<string, unknown>>): void {
    const { store } = this;
    const { condition, hello, simulation, frame } = store;
    if (this.condition.dataset['condition'] !== condition) {
      this.condition.dataset['condition'] = condition;
      document.body.dataset['condition'] = condition;
      document.title = `${words[condition]} · stagger`;
    }
    setText(this.text, this.sentence());
    this.retry.hidden = condition !== 'lost';
    const plant = hello?.plant === 'lipm' ? 'pendulum' : 'full body';
    setText(this.robot, hello === null ? '–' : `${hello.robot}, ${plant}`);
    byId('bar-ground', HTMLElement).hidden = store.terrain.kind === 'flat';
    setText(this.terrain, hello === null ? '–' : store.terrain.title);
    setText(
      this.walking,
      store.walkingState === '' ? '–' : store.walkingState.replaceAll('_', ' '),
    );
    setText(this.time, frame === null ? '–' : `${formatNumber(frame.t, 2)} s`);
    const speed = store.connection.kind === 'open' ? simulation?.realTimeFactor : undefined;
    setText(this.speed, speed === undefined ? '–' : `${formatNumber(speed, 2)} ×`);
    this.showVerdict(topView['capturable']);
    this.banner.hidden = condition !== 'fallen';
    setText(this.reason, simulation?.fallReason ?? '');
    this.stale.hidden = condition !== 'lost' || frame === null;
    setText(this.stale, frame === null ? '' : `As it was at ${formatNumber(frame.t, 2)} s`);
  }

  /** What the regions of the view from above say, in words. */
  private showVerdict(capturable: unknown): void {
    const verdict = capturable === true ? 'yes' : capturable === false ? 'no' : 'none';
    if (this.verdict.dataset['verdict'] === verdict) return;
    this.verdict.dataset['verdict'] = verdict;
    setText(
      this.verdict,
      verdict === 'yes'
        ? 'The next step can save it'
        : verdict === 'no'
          ? 'No step reaches far enough'
          : '',
    );
  }

  private sentence(): string {
    const { connection, condition, running } = this.store;
    if (connection.kind === 'lost') {
      const seconds = Math.max(0, Math.ceil((connection.retryAt - Date.now()) / 1000));
      return `Lost: ${connection.reason}. Reconnecting in ${seconds} s`;
    }
    return condition === 'fallen' && running === false ? 'Fallen, paused' : words[condition];
  }
}
