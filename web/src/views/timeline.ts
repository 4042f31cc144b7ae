// The last minute at one glance: which foot stood, every push, step and fall, and the piece of it
// that the plots show.

import type { Store } from '../store';
import { historySeconds } from '../store';
import type { Theme } from '../theme';
import { eventsWithin, markerColour } from './markers';
import type { Plots } from './plots';
import type { TimeWindow } from './time_window';

const redrawPeriodMs = 100;
const barHeight = 6;
const markEveryS = 10;

export class Timeline {
  private readonly context: CanvasRenderingContext2D;
  private lastDraw = 0;
  private dirty = true;
  private drawnVersion = -1;
  private range: [number, number] = [0, historySeconds];
  private drawn: Record<string, unknown> = {};

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly store: Store,
    private theme: Theme,
    private readonly window: TimeWindow,
    private readonly plots: Plots,
  ) {
    const context = canvas.getContext('2d');
    if (context === null) throw new Error('this browser has no 2D canvas');
    this.context = context;
    new ResizeObserver(() => (this.dirty = true)).observe(canvas);
    const go = (event: PointerEvent): void => {
      const share = event.offsetX / Math.max(1, canvas.clientWidth);
      const [from, to] = this.range;
      window.centreOn(from + share * (to - from), plots.newest);
      plots.redraw();
      this.dirty = true;
    };
    canvas.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      canvas.setPointerCapture(event.pointerId);
      go(event);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons === 1) go(event);
    });
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.dirty = true;
  }

  update(nowMs: number): void {
    const news = this.dirty || this.store.version !== this.drawnVersion;
    if (!news || nowMs - this.lastDraw < redrawPeriodMs) return;
    this.lastDraw = nowMs;
    this.drawnVersion = this.store.version;
    this.dirty = false;
    this.draw();
  }

  state(): Record<string, unknown> {
    return this.drawn;
  }

  private draw(): void {
    const { canvas, context: c, theme, store, plots } = this;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const { clientWidth: width, clientHeight: height } = canvas;
    const wanted = Math.max(1, Math.round(width * ratio));
    if (canvas.width !== wanted) canvas.width = wanted;
    const tall = Math.max(1, Math.round(height * ratio));
    if (canvas.height !== tall) canvas.height = tall;
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, width, height);
    const { newest, table } = plots;
    const end = Math.max(historySeconds, newest);
    this.range = [end - historySeconds, end];
    const [from] = this.range;
    const x = (t: number): number => ((t - from) / historySeconds) * width;

    // How far it goes, with a mark every ten seconds.
    c.fillStyle = theme.line;
    c.fillRect(0, height - 1, width, 1);
    for (let s = Math.ceil(from / markEveryS) * markEveryS; s <= end; s += markEveryS) {
      c.fillRect(Math.min(width - 1, x(s)), height - 5, 1, 5);
    }

    // The standing foot: left above, right below the middle; both: both.
    const t = table.view('t');
    const stance = table.view('stance');
    const middle = height / 2;
    c.fillStyle = theme.measured;
    c.globalAlpha = 0.45;
    for (let i = 0; i + 1 < t.length; ) {
      const foot = stance[i] ?? Number.NaN;
      let j = i + 1;
      while (j < t.length && stance[j] === foot) j += 1;
      const left = x(t[i] ?? 0);
      const wide = Math.max(0.5, x(t[Math.min(j, t.length - 1)] ?? 0) - left);
      if (foot === 0 || foot === 1) c.fillRect(left, middle - barHeight - 1, wide, barHeight);
      if (foot === 0 || foot === 2) c.fillRect(left, middle + 1, wide, barHeight);
      i = j;
    }
    c.globalAlpha = 1;

    const events = eventsWithin(store.events, this.range);
    for (const { t: at, kind } of events) {
      if (kind === 'step') continue;
      c.fillStyle = markerColour(kind, theme);
      c.fillRect(x(at) - 1, 2, 2, height - 4);
      c.beginPath();
      c.arc(x(at), 4, 3.2, 0, 2 * Math.PI);
      c.fill();
    }

    const [start, stop] = this.window.range(newest);
    c.strokeStyle = theme.ink;
    c.lineWidth = 1.2;
    const left = Math.max(0.6, x(start));
    c.globalAlpha = 0.07;
    c.fillStyle = theme.ink;
    c.fillRect(left, 0.6, Math.min(width - 0.6, x(stop)) - left, height - 1.2);
    c.globalAlpha = 0.6;
    c.strokeRect(left, 0.6, Math.min(width - 0.6, x(stop)) - left, height - 1.2);
    c.globalAlpha = 1;
    this.drawn = { range: this.range, events: events.length, window: [start, stop] };
  }
}
