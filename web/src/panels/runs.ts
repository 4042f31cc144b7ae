// Recordings: the list, what is written beside them, and their replay in the same views, one alone or
// two that are aligned where they were pushed.

import type { Api } from '../api';
import { linesOf } from '../api';
import { attempt } from '../attempt';
import { byId, formatNumber, keepRows, setText, showLines } from '../dom';
import { parseRecorded } from '../recording';
import type { RecordingInfo, RecordingList } from '../recording';
import { Reading } from '../reading';
import { Replay } from '../replay';
import { rateHz, topics } from '../store';
import type { Store } from '../store';
import type { GroundCanvas } from '../views/ground_canvas';
import type { Plots } from '../views/plots';
import type { TimeWindow } from '../views/time_window';
import type { TopView } from '../views/top_view';
import { footFrom, pointFrom, soleCorners } from '../views/transform';
import { RunRow, runTitle } from './run_row';

const periodMs = 2000;
/** More frames than the plots hold are not asked for. */
const mostFrames = 6000;
const tickHz = 1000;

export interface RunViews {
  readonly topView: TopView;
  readonly plots: Plots;
  readonly times: TimeWindow;
}

export class RunsPanel {
  private readonly panel = byId('runs-panel', HTMLElement);
  private readonly list = byId('runs', HTMLUListElement);
  private readonly error = byId('runs-error', HTMLElement);
  private readonly card = byId('replay-card', HTMLElement);
  private readonly slider = byId('replay-time', HTMLInputElement);
  private readonly shownTime = byId('replay-shown', HTMLElement);
  private readonly playButton = byId('replay-play', HTMLButtonElement);
  private readonly overText = byId('replay-over', HTMLElement);
  private readonly rows = new Map<string, RunRow>();
  private items: readonly RecordingInfo[] = [];
  private readonly reading: Reading<RecordingList>;
  private replay: Replay | null = null;
  private other: Replay | null = null;
  private playing = false;
  private playedMs = 0;
  private loading = 0;
  /** The views change what they show. */
  onReplay: (replaying: boolean) => void = () => undefined;
  /** Another run is laid over it; null: none. */
  onOther: (other: Store | null) => void = () => undefined;

  constructor(
    private readonly live: Store,
    private readonly shown: Store,
    private readonly api: Api,
    private readonly views: RunViews,
  ) {
    const tag = byId('runs-tag', HTMLInputElement);
    this.reading = new Reading(
      () => api.recordings(tag.value.trim()),
      ({ items, warning }) => {
        this.items = items;
        setText(byId('runs-warning', HTMLElement), warning);
        this.show();
      },
    );
    byId('record-now', HTMLButtonElement).addEventListener('click', () => this.record('now'));
    byId('record-push', HTMLButtonElement).addEventListener('click', () => this.record('push'));
    tag.addEventListener('input', () => this.reading.replace());
    byId('replay-close', HTMLButtonElement).addEventListener('click', () => this.close());
    this.playButton.addEventListener('click', () => this.setPlaying(!this.playing));
    this.slider.addEventListener('input', () => {
      this.setPlaying(false);
      this.seek(this.slider.valueAsNumber);
    });
    views.topView.overlays.push((ground) => this.drawOther(ground));
    // What is live is shown, unless a run is replayed.
    for (const topic of topics) {
      live.on(topic, () => {
        if (this.replay === null) shown.mirror(live, topic);
      });
    }
    live.on('connection', () => this.reading.refresh());
    setInterval(() => {
      if (!this.panel.hidden && !document.hidden) this.reading.look();
    }, periodMs);
    new MutationObserver(() => {
      if (!this.panel.hidden) this.reading.look();
    }).observe(this.panel, { attributes: true, attributeFilter: ['hidden'] });
  }

  get replaying(): boolean {
    return this.replay !== null;
  }

  get otherStore(): Store | null {
    return this.other?.store ?? null;
  }

  /** A live frame has come. */
  look(): void {
    if (this.replay === null) this.shown.mirror(this.live);
  }

  update(nowMs: number): void {
    const { replay } = this;
    const passed = (nowMs - this.playedMs) / 1000;
    this.playedMs = nowMs;
    if (replay === null || !this.playing) return;
    const t = this.slider.valueAsNumber + passed;
    this.seek(t);
    if (t >= replay.endS) this.setPlaying(false);
  }

  state(): Record<string, unknown> {
    return {
      listed: this.items.map(({ id, state, note, tags }) => ({ id, state, note, tags })),
      replayed: this.replay?.info.id ?? null,
      t: this.replay?.timeS ?? null,
      over: this.other?.info.id ?? null,
      shift: this.shift,
      playing: this.playing,
    };
  }

  /** What is added to the other run's times so that both are pushed at once [s]. */
  private get shift(): number {
    return (this.replay?.pushS ?? 0) - (this.other?.pushS ?? 0);
  }

  private show(): void {
    keepRows(
      this.list,
      this.rows,
      this.items,
      (info) =>
        new RunRow(info, {
          replay: (run) => void this.open(run),
          layOver: (run) => void this.layOver(run),
          stop: (run) => void this.act(() => this.api.stopRecording(run.id)),
          remove: (run) => void this.act(() => this.api.deleteRecording(run.id)),
          change: (run, change) => void this.act(() => this.api.changeRecording(run.id, change)),
        }),
      (row, info) => row.update(info, this.replay?.info.id ?? null, this.other?.info.id ?? null),
    );
    byId('runs-empty', HTMLElement).hidden = this.items.length > 0;
  }

  private record(when: 'now' | 'push'): void {
    void this.act(() => this.api.record(when));
  }

  private async act(run: () => Promise<unknown>): Promise<void> {
    if (await attempt(this.error, run)) this.reading.replace();
  }

  private async load(info: RecordingInfo): Promise<Replay | null> {
    this.loading += 1;
    const { loading } = this;
    showLines(this.error, []);
    try {
      const every = Math.max(tickHz / rateHz, Math.ceil(info.ticks / mostFrames));
      const [text, robot] = await Promise.all([
        this.api.recordingLines(info.id, every),
        this.api.robot(info.robot),
      ]);
      if (loading !== this.loading) return null;
      const recorded = parseRecorded(text, this.live.hello?.states ?? []);
      if (recorded === null) throw new Error('This recording has no frames.');
      return new Replay(info, recorded, robot);
    } catch (error) {
      showLines(this.error, linesOf(error));
      return null;
    }
  }

  private async open(info: RecordingInfo): Promise<void> {
    const replay = await this.load(info);
    if (replay === null) return;
    this.setOther(null);
    this.replay = replay;
    this.slider.min = String(replay.startS);
    this.slider.max = String(replay.endS);
    this.card.hidden = false;
    setText(byId('replay-title', HTMLElement), `Replay: ${runTitle(info)}`);
    setText(this.overText, '');
    this.shown.mirror(replay.store, 'hello', 'robot', 'running', 'condition');
    this.onReplay(true);
    this.setPlaying(false);
    this.seek(Math.max(replay.startS, replay.pushS - 0.5));
    this.show();
    this.slider.focus();
  }

  private async layOver(info: RecordingInfo): Promise<void> {
    if (this.other?.info.id === info.id) {
      this.setOther(null);
      return;
    }
    const other = await this.load(info);
    if (other !== null && this.replay !== null) this.setOther(other);
  }

  private setOther(other: Replay | null): void {
    this.other = other;
    const { shift } = this;
    this.seekOther();
    this.onOther(this.otherStore);
    this.views.plots.setOverlay(other === null ? null : { table: other.store.series, shift });
    setText(
      this.overText,
      other === null ? '' : `Over it, in grey and aligned at the push: ${runTitle(other.info)}`,
    );
    this.views.topView.redraw();
    this.show();
  }

  private close(): void {
    this.replay = null;
    this.setOther(null);
    this.card.hidden = true;
    this.setPlaying(false);
    this.shown.mirror(this.live, ...topics);
    this.onReplay(false);
  }

  private setPlaying(playing: boolean): void {
    const { replay } = this;
    this.playing = playing && replay !== null;
    if (this.playing && replay !== null && replay.timeS >= replay.endS) this.seek(replay.startS);
    setText(this.playButton, this.playing ? 'Stop' : 'Play');
  }

  private seek(t: number): void {
    const { replay } = this;
    if (replay === null) return;
    const to = Math.min(replay.endS, Math.max(replay.startS, t));
    replay.seek(to);
    this.seekOther();
    this.slider.value = String(to);
    const since = to - replay.pushS;
    const words =
      `${formatNumber(to, 2)} s, ` +
      `${formatNumber(Math.abs(since), 2)} s ${since < 0 ? 'before' : 'after'} the push.`;
    setText(this.shownTime, words);
    this.slider.setAttribute('aria-valuetext', words);
    this.shown.mirror(replay.store);
    const { times, plots } = this.views;
    const [from, until] = times.range(plots.newest);
    if (to < from || to > until) times.centreOn(to, plots.newest);
    plots.redraw();
  }

  /** The other run at the same time from the push on. */
  private seekOther(): void {
    if (this.replay !== null) this.other?.seek(this.replay.timeS - this.shift);
  }

  /** The other run in the view from above. */
  private drawOther(ground: GroundCanvas): void {
    const { other } = this;
    const frame = other?.store.frame ?? null;
    if (other === null || frame === null) return;
    const { muted } = ground.theme;
    const sole = other.store.robot?.sole ?? { lengthM: 0.15, widthM: 0.075 };
    for (const name of ['left_foot', 'right_foot']) {
      const foot = footFrom(frame.v[name] ?? []);
      if (foot !== null) {
        ground.outline(soleCorners(foot, sole.lengthM, sole.widthM), muted, 1.6, [6, 3]);
      }
    }
    ground.disc(pointFrom(frame.v['com'] ?? []), muted, true);
    ground.diamond(pointFrom(frame.v['dcm'] ?? []), muted, true);
  }
}
