// Measured against reference over time: zoom, pan, a cursor with values, and a line for each push,
// step and fall.

import uPlot from 'uplot';
import { byId, formatNumber, setText } from '../dom';
import type { RingTable } from '../ring';
import type { Store } from '../store';
import type { Theme } from '../theme';
import { drawMarkers, drawNow, eventsWithin } from './markers';
import { overlaidColumn } from './overlay';
import type { Overlay } from './overlay';
import { plotGroups } from './plot_specs';
import type { Line, PlotGroup, PlotSpec, Role } from './plot_specs';
import type { TimeWindow } from './time_window';

/** Redrawing more often than this shows nothing more [ms]. */
const redrawPeriodMs = 50;
const axisFont = 11;

interface Plot {
  readonly spec: PlotSpec;
  readonly host: HTMLElement;
  readonly readout: HTMLElement;
  uplot: uPlot;
}

type Column = ArrayLike<number | null | undefined>;

/** Range of the y axis over all columns; NaN stands for a missing value. */
function rangeOf(spec: PlotSpec, columns: readonly Column[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const column of columns) {
    for (let i = 0; i < column.length; i += 1) {
      const value = column[i] ?? Number.NaN;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (low > high) return [0, spec.leastSpan];
  const bottom = spec.fromZero === true ? 0 : low;
  const missing = Math.max(0, spec.leastSpan - (high - bottom));
  const margin = (high - bottom + missing) * 0.06;
  if (spec.fromZero === true) return [0, high + missing + margin];
  return [bottom - missing / 2 - margin, high + missing / 2 + margin];
}

export class Plots {
  private plots: Plot[] = [];
  private groups: readonly PlotGroup[] = [];
  private groupId = 'balance';
  private readonly hidden = new Set<Role>();
  private readonly root = byId('plots', HTMLElement);
  private readonly tabs = byId('plot-groups', HTMLElement);
  private readonly observer = new ResizeObserver(() => this.resize());
  private overlay: Overlay | null = null;
  private frozen: { table: RingTable<string>; newest: number } | null = null;
  private lastDraw = 0;
  private drawnVersion = -1;
  private drawnEvents = 0;
  private dirty = true;
  private points = 0;
  private drawnTick: number | null = null;

  constructor(
    private readonly store: Store,
    private theme: Theme,
    private readonly window: TimeWindow,
  ) {
    this.choose(plotGroups([]));
    store.on('hello', () => {
      this.frozen = null;
      window.reset();
      this.choose(plotGroups(store.torqueJoints));
    });
    this.root.addEventListener('keydown', (event) => this.key(event));
  }

  /** uPlot keeps its colours from birth: a new theme means new plots. */
  setTheme(theme: Theme): void {
    this.theme = theme;
    this.rebuild();
  }

  redraw(): void {
    this.dirty = true;
  }

  /** Shows or hides all lines of that meaning. */
  toggle(role: Role, on: boolean): void {
    if (on) this.hidden.delete(role);
    else this.hidden.add(role);
    this.rebuild();
  }

  /** Lays another run over what is shown, or none. */
  setOverlay(overlay: Overlay | null): void {
    this.overlay = overlay;
    this.rebuild();
  }

  showGroup(id: string): void {
    if (!this.groups.some((group) => group.id === id)) return;
    this.groupId = id;
    this.showTabs();
    this.rebuild();
  }

  /** What is seen stays as it is while the simulation goes on. */
  get isFrozen(): boolean {
    return this.frozen !== null;
  }

  setFrozen(frozen: boolean): void {
    if (frozen && this.frozen === null) {
      const newest = this.newest;
      this.frozen = { table: this.store.series.copy(), newest };
      this.window.hold(newest);
    } else if (!frozen) {
      this.frozen = null;
      this.window.follow();
    }
    this.dirty = true;
  }

  get newest(): number {
    return this.frozen?.newest ?? this.store.series.last('t') ?? 0;
  }

  get oldest(): number {
    return this.table.view('t')[0] ?? 0;
  }

  /** What is drawn: the running table, or the one that was kept. */
  get table(): RingTable<string> {
    return this.frozen?.table ?? this.store.series;
  }

  get shown(): readonly { spec: PlotSpec; canvas: HTMLCanvasElement }[] {
    return this.plots.map(({ spec, uplot }) => ({ spec, canvas: uplot.ctx.canvas }));
  }

  update(nowMs: number): void {
    const { store } = this;
    const events = store.events.length;
    const news =
      this.dirty ||
      (this.frozen === null &&
        (store.version !== this.drawnVersion || events !== this.drawnEvents));
    if (!news || nowMs - this.lastDraw < redrawPeriodMs) return;
    this.lastDraw = nowMs;
    this.drawnVersion = store.version;
    this.drawnEvents = events;
    this.dirty = false;
    const { table } = this;
    const [start, end] = this.window.range(this.newest);
    const from = table.lowerBound('t', start);
    const to = table.lowerBound('t', end + 1e-9);
    const t = table.view('t', from, to);
    this.points = t.length;
    this.drawnTick = store.frame?.tick ?? null;
    for (const plot of this.plots) {
      const lines = this.linesOf(plot.spec);
      const { overlay } = this;
      const columns = lines.map(({ series, overlaid }) =>
        overlaid === true && overlay !== null
          ? overlaidColumn(overlay, series, t)
          : table.view(series, from, to),
      );
      plot.uplot.setData([t, ...columns]);
      this.showReadout(plot);
    }
  }

  /** What the plots hold now. */
  state(): Record<string, unknown> {
    const last: Record<string, number | null> = {};
    for (const { spec, uplot } of this.plots) {
      uplot.data.slice(1).forEach((column, i) => {
        const line = this.linesOf(spec)[i];
        if (line !== undefined) last[line.label] = column[column.length - 1] ?? null;
      });
    }
    return {
      drawn_tick: this.drawnTick,
      group: this.groupId,
      groups: this.groups.map(({ id }) => id),
      plots: this.plots.map(({ spec }) => spec.id),
      points: this.points,
      /** Whether what is drawn is what was asked for: a freeze is drawn a moment after its key. */
      current: !this.dirty,
      window: this.window.range(this.newest),
      following: this.window.following,
      frozen: this.isFrozen,
      hidden: [...this.hidden],
      capacity: this.store.series.capacity,
      last,
      cursor: this.plots[0]?.uplot.cursor.idx ?? null,
      markers: eventsWithin(this.store.events, this.window.range(this.newest)).length,
    };
  }

  private choose(groups: readonly PlotGroup[]): void {
    this.groups = groups;
    if (!groups.some(({ id }) => id === this.groupId)) this.groupId = groups[0]?.id ?? '';
    this.showTabs();
    this.rebuild();
  }

  private showTabs(): void {
    this.tabs.replaceChildren(
      ...this.groups.map(({ id, title }) => {
        const button = document.createElement('button');
        button.type = 'button';
        button.textContent = title;
        button.dataset['group'] = id;
        button.setAttribute('aria-pressed', String(id === this.groupId));
        button.addEventListener('click', () => this.showGroup(id));
        return button;
      }),
    );
  }

  private linesOf(spec: PlotSpec): Line[] {
    const lines = spec.lines.filter(({ role }) => !this.hidden.has(role));
    if (this.overlay === null) return lines;
    const other = spec.lines
      .filter(({ role }) => role === 'measured')
      .map(({ series, label }): Line => ({
        series,
        role: 'other',
        label: `other_${label}`,
        overlaid: true,
      }));
    return [...lines, ...other];
  }

  private rebuild(): void {
    this.observer.disconnect();
    for (const { uplot } of this.plots) uplot.destroy();
    const group = this.groups.find(({ id }) => id === this.groupId);
    const specs = group?.plots ?? [];
    // Two stand in a row; the lowest of them have the times for all above.
    const narrow = specs.filter(({ wide }) => wide !== true);
    this.plots = [];
    this.root.replaceChildren();
    specs.forEach((spec, i) => {
      const figure = document.createElement('figure');
      figure.className = `plot plot-${spec.id}${spec.wide === true ? ' wide' : ''}`;
      const caption = document.createElement('figcaption');
      const title = document.createElement('span');
      title.textContent = spec.title;
      const readout = document.createElement('span');
      readout.className = 'readout';
      caption.append(title, readout);
      const host = document.createElement('div');
      host.className = 'plot-host';
      host.setAttribute('role', 'img');
      host.setAttribute('aria-label', `${spec.title} [${spec.unit}] over time`);
      figure.append(caption, host);
      this.root.append(figure);
      const times = spec.wide === true || narrow.indexOf(spec) >= narrow.length - 2;
      this.plots.push({ spec, host, readout, uplot: this.make(spec, host, i === 0, times) });
      this.observer.observe(host);
    });
    this.dirty = true;
  }

  private make(spec: PlotSpec, host: HTMLElement, labels: boolean, times: boolean): uPlot {
    const { theme } = this;
    const font = `${axisFont}px ${theme.font}`;
    const axis: uPlot.Axis = {
      stroke: theme.muted,
      font,
      grid: { stroke: theme.line, width: 1 },
      ticks: { stroke: theme.line, width: 1, size: 4 },
    };
    const styles: Readonly<Record<Role, uPlot.Series>> = {
      measured: { stroke: theme.measured, width: 1.6 },
      reference: { stroke: theme.reference, width: 1.4, dash: [5, 4] },
      planned: { stroke: theme.planned, width: 1.4, dash: [5, 4] },
      limit: { stroke: theme.limit, width: 1 },
      other: { stroke: theme.muted, width: 1.2 },
    };
    const series: uPlot.Series[] = [
      {},
      ...this.linesOf(spec).map(({ role }) => ({ ...styles[role], points: { show: false } })),
    ];
    const uplot = new uPlot(
      {
        width: Math.max(80, host.clientWidth),
        height: Math.max(60, host.clientHeight),
        legend: { show: false },
        padding: [5, 16, 0, 0],
        cursor: {
          sync: { key: 'stagger' },
          drag: { x: false, y: false },
          y: false,
          points: { size: 6 },
        },
        scales: {
          x: { time: false, range: () => this.window.range(this.newest) },
          y: { range: (plot) => rangeOf(spec, plot.data.slice(1)) },
        },
        axes: [
          {
            ...axis,
            size: times ? 22 : 6,
            gap: 2,
            space: 60,
            ticks: { show: times },
            values: (_, ticks) =>
              ticks.map((v) => (times ? `${Number(v.toFixed(2))} s`.replace('-', '−') : '')),
          },
          {
            ...axis,
            size: 46,
            gap: 3,
            space: 20,
            values: (_, ticks) => ticks.map((v) => `${Number(v.toFixed(3))}`.replace('-', '−')),
          },
        ],
        series,
        hooks: {
          drawAxes: [
            (plot) => {
              drawMarkers(plot, this.store.events, this.theme, labels ? axisFont : null);
              drawNow(plot, this.store.frame?.t ?? Infinity, this.newest, this.theme);
            },
          ],
          setCursor: [(plot) => this.showReadoutOf(plot)],
        },
      },
      [[], ...series.slice(1).map(() => [])] as unknown as uPlot.AlignedData,
      host,
    );
    this.listen(uplot);
    return uplot;
  }

  /** The wheel zooms about the pointer, a drag pans, a double click goes back to now. */
  private listen(uplot: uPlot): void {
    const { over } = uplot;
    over.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        const about = uplot.posToVal(event.offsetX, 'x');
        this.window.zoom(Math.exp(event.deltaY * 0.0015), about, this.newest);
        this.dirty = true;
      },
      { passive: false },
    );
    over.addEventListener('dblclick', () => {
      this.window.reset();
      this.dirty = true;
    });
    over.addEventListener('pointerdown', (down) => {
      if (down.button !== 0) return;
      let before = down.clientX;
      const move = (event: PointerEvent): void => {
        const perPixel = this.window.span / Math.max(1, over.clientWidth);
        this.window.pan((before - event.clientX) * perPixel, this.oldest, this.newest);
        before = event.clientX;
        this.dirty = true;
      };
      const end = (): void => {
        over.removeEventListener('pointermove', move);
        over.removeEventListener('pointerup', end);
        over.removeEventListener('pointercancel', end);
      };
      over.setPointerCapture(down.pointerId);
      over.addEventListener('pointermove', move);
      over.addEventListener('pointerup', end);
      over.addEventListener('pointercancel', end);
    });
  }

  /** With the plots focused: arrows move the cursor, plus and minus zoom. */
  private key(event: KeyboardEvent): void {
    const [first] = this.plots;
    if (first === undefined || event.target !== this.root) return;
    const { uplot } = first;
    const count = uplot.data[0].length;
    const now = uplot.cursor.idx ?? count - 1;
    const jump = event.shiftKey ? 50 : 5;
    const to = { ArrowLeft: now - jump, ArrowRight: now + jump, Home: 0, End: count - 1 }[event.key];
    if (to !== undefined && count > 0) {
      const index = Math.min(count - 1, Math.max(0, to));
      const t = uplot.data[0][index] ?? 0;
      for (const plot of this.plots) {
        plot.uplot.setCursor({ left: plot.uplot.valToPos(t, 'x'), top: 1 });
      }
    } else if (event.key === '+' || event.key === '-') {
      this.window.zoom(event.key === '+' ? 0.8 : 1.25, null, this.newest);
      this.dirty = true;
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    const spoken = this.plots.map(
      ({ spec, readout }) => `${spec.title} ${readout.textContent ?? ''}`,
    );
    setText(byId('plot-spoken', HTMLElement), spoken.slice(0, 3).join('; '));
  }

  private showReadoutOf(uplot: uPlot): void {
    const plot = this.plots.find((candidate) => candidate.uplot === uplot);
    if (plot !== undefined) this.showReadout(plot);
  }

  /** The numbers under the cursor, else the newest. */
  private showReadout({ uplot, readout, spec }: Plot): void {
    const [t] = uplot.data;
    const { idx } = uplot.cursor;
    const held = idx !== null && idx !== undefined;
    const index = held ? idx : t.length - 1;
    const numbers = this.linesOf(spec)
      .map(({ role }, i) => ({ role, value: uplot.data[i + 1]?.[index] ?? undefined }))
      .filter(({ role }) => role !== 'limit')
      .map(({ value }) => formatNumber(value, spec.digits ?? 3));
    const when = held ? `at ${formatNumber(t[index], 2)} s: ` : '';
    setText(readout, `${when}${numbers.join(' / ')} ${spec.unit}`);
  }

  private resize(): void {
    for (const { uplot, host } of this.plots) {
      const { clientWidth, clientHeight } = host;
      if (clientWidth < 40 || clientHeight < 40) continue;
      if (uplot.width !== clientWidth || uplot.height !== clientHeight) {
        uplot.setSize({ width: clientWidth, height: clientHeight });
      }
    }
  }
}
