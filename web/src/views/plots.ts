// Measured against reference over the last seconds, with a line for each push, step and fall.

import uPlot from 'uplot';
import type { SeriesName, Store } from '../store';
import { windowSeconds } from '../store';
import { formatNumber, setText } from '../dom';
import type { Theme } from '../theme';

/** Redrawing more often than this shows nothing more [ms]. */
const redrawPeriodMs = 50;
const axisFont = 11;

interface PlotSpec {
  readonly id: string;
  readonly title: string;
  readonly measured: SeriesName;
  readonly reference?: SeriesName;
  /** Edges of what is allowed. */
  readonly limits?: readonly [SeriesName, SeriesName];
  /** The y axis shows at least this much [m]. */
  readonly leastSpan: number;
  readonly fromZero?: boolean;
  readonly labels?: boolean;
  /** Shows the time below; the plots of a column share it. */
  readonly times?: boolean;
}

const specs: readonly PlotSpec[] = [
  {
    id: 'dcm_error',
    title: 'DCM error, distance',
    measured: 'dcm_error',
    leastSpan: 0.02,
    fromZero: true,
    labels: true,
    times: true,
  },
  {
    id: 'dcm_x',
    title: 'DCM x',
    measured: 'dcm_x',
    reference: 'dcm_reference_x',
    leastSpan: 0.06,
  },
  {
    id: 'dcm_y',
    title: 'DCM y',
    measured: 'dcm_y',
    reference: 'dcm_reference_y',
    leastSpan: 0.06,
  },
  {
    id: 'com_x',
    title: 'CoM x',
    measured: 'com_x',
    reference: 'com_reference_x',
    leastSpan: 0.06,
  },
  {
    id: 'com_y',
    title: 'CoM y',
    measured: 'com_y',
    reference: 'com_reference_y',
    leastSpan: 0.06,
  },
  {
    id: 'zmp_x',
    title: 'ZMP x',
    measured: 'zmp_x',
    reference: 'zmp_reference_x',
    limits: ['polygon_min_x', 'polygon_max_x'],
    leastSpan: 0.06,
    times: true,
  },
  {
    id: 'zmp_y',
    title: 'ZMP y',
    measured: 'zmp_y',
    reference: 'zmp_reference_y',
    limits: ['polygon_min_y', 'polygon_max_y'],
    leastSpan: 0.06,
    times: true,
  },
];

interface Plot {
  readonly spec: PlotSpec;
  readonly host: HTMLElement;
  readonly readout: HTMLElement;
  uplot: uPlot;
}

/** Range of the y axis over all columns; NaN stands for a missing value. */
function rangeOf(
  spec: PlotSpec,
  columns: readonly ArrayLike<number | null | undefined>[],
): [number, number] {
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
  private theme: Theme;
  private window: [number, number] = [0, windowSeconds];
  private lastDraw = 0;
  private drawnVersion = -1;
  private drawnEvents = 0;
  private dirty = true;
  private points = 0;
  private drawnTick: number | null = null;

  constructor(
    root: HTMLElement,
    private readonly store: Store,
    theme: Theme,
  ) {
    this.theme = theme;
    for (const spec of specs) {
      const figure = document.createElement('figure');
      figure.className = `plot plot-${spec.id}`;
      const caption = document.createElement('figcaption');
      const title = document.createElement('span');
      title.textContent = spec.title;
      const readout = document.createElement('span');
      readout.className = 'readout';
      caption.append(title, readout);
      const host = document.createElement('div');
      host.className = 'plot-host';
      host.setAttribute('role', 'img');
      host.setAttribute(
        'aria-label',
        `${spec.title} over the last ${windowSeconds} seconds; the numbers are in the value table`,
      );
      figure.append(caption, host);
      root.append(figure);
      this.plots.push({ spec, host, readout, uplot: this.make(spec, host) });
    }
    const observer = new ResizeObserver(() => this.resize());
    for (const { host } of this.plots) observer.observe(host);
  }

  /** uPlot keeps its colours from birth: a new theme means new plots. */
  setTheme(theme: Theme): void {
    this.theme = theme;
    for (const plot of this.plots) {
      plot.uplot.destroy();
      plot.uplot = this.make(plot.spec, plot.host);
    }
    this.dirty = true;
  }

  update(nowMs: number): void {
    const { store } = this;
    const events = store.events.length;
    const news = this.dirty || store.version !== this.drawnVersion || events !== this.drawnEvents;
    if (!news || nowMs - this.lastDraw < redrawPeriodMs) return;
    this.lastDraw = nowMs;
    this.drawnVersion = store.version;
    this.drawnEvents = events;
    this.dirty = false;
    const end = store.series.last('t') ?? 0;
    this.window = [Math.max(0, end - windowSeconds), Math.max(windowSeconds, end)];
    const from = store.series.lowerBound('t', this.window[0]);
    const t = store.series.view('t', from);
    this.points = t.length;
    this.drawnTick = store.frame?.tick ?? null;
    for (const plot of this.plots) {
      const names = this.columns(plot.spec);
      plot.uplot.setData([t, ...names.map((name) => store.series.view(name, from))]);
      this.showReadout(plot);
    }
  }

  /** What the plots hold now. */
  state(): Record<string, unknown> {
    const last: Record<string, number | null> = {};
    for (const { spec, uplot } of this.plots) {
      uplot.data.slice(1).forEach((column, i) => {
        const name = this.columns(spec)[i];
        if (name !== undefined) last[name] = column[column.length - 1] ?? null;
      });
    }
    return {
      drawn_tick: this.drawnTick,
      points: this.points,
      window: [...this.window],
      capacity: this.store.series.capacity,
      last,
      markers: this.markers().length,
    };
  }

  private columns(spec: PlotSpec): SeriesName[] {
    return [
      spec.measured,
      ...(spec.reference === undefined ? [] : [spec.reference]),
      ...(spec.limits ?? []),
    ];
  }

  private make(spec: PlotSpec, host: HTMLElement): uPlot {
    const { theme } = this;
    const font = `${axisFont}px ${theme.font}`;
    const axis: uPlot.Axis = {
      stroke: theme.muted,
      font,
      grid: { stroke: theme.line, width: 1 },
      ticks: { stroke: theme.line, width: 1, size: 4 },
    };
    const line = (colour: string, width: number, dash?: number[]): uPlot.Series => ({
      stroke: colour,
      width,
      points: { show: false },
      ...(dash === undefined ? {} : { dash }),
    });
    const series: uPlot.Series[] = [{}, line(theme.measured, 1.6)];
    if (spec.reference !== undefined) series.push(line(theme.reference, 1.4, [5, 4]));
    if (spec.limits !== undefined) series.push(line(theme.limit, 1), line(theme.limit, 1));
    return new uPlot(
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
          x: { time: false, range: () => this.window },
          y: { range: (plot) => rangeOf(spec, plot.data.slice(1)) },
        },
        axes: [
          {
            ...axis,
            size: spec.times === true ? 22 : 6,
            gap: 2,
            space: 60,
            ticks: { show: spec.times === true },
            values: (_, ticks) => ticks.map((v) => (spec.times === true ? `${v} s` : '')),
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
          drawAxes: [(plot) => this.drawMarkers(plot, spec.labels === true)],
          setCursor: [(plot) => this.showReadoutOf(plot)],
        },
      },
      [[], ...series.slice(1).map(() => [])] as unknown as uPlot.AlignedData,
      host,
    );
  }

  private markers(): { t: number; kind: string; text: string }[] {
    const kinds = ['push_started', 'fall', 'step'];
    return this.store.events.filter(
      (event) =>
        kinds.includes(event.kind) && event.t >= this.window[0] && event.t <= this.window[1],
    );
  }

  private drawMarkers(plot: uPlot, labels: boolean): void {
    const { ctx: c, bbox } = plot;
    const ratio = uPlot.pxRatio;
    c.save();
    c.beginPath();
    c.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    c.clip();
    for (const { t, kind } of this.markers()) {
      const x = plot.valToPos(t, 'x', true);
      const colour =
        kind === 'fall' ? this.theme.limit : kind === 'step' ? this.theme.muted : this.theme.ink;
      c.strokeStyle = colour;
      c.lineWidth = (kind === 'step' ? 1 : 1.6) * ratio;
      c.setLineDash(kind === 'step' ? [2 * ratio, 4 * ratio] : []);
      c.globalAlpha = kind === 'step' ? 0.6 : 0.9;
      c.beginPath();
      c.moveTo(x, bbox.top);
      c.lineTo(x, bbox.top + bbox.height);
      c.stroke();
      if (labels && kind !== 'step') {
        c.globalAlpha = 1;
        c.fillStyle = colour;
        c.font = `600 ${axisFont * ratio}px ${this.theme.font}`;
        c.textAlign = 'left';
        c.textBaseline = 'top';
        // A fall is often close behind its push: its word stands a line lower.
        const row = kind === 'fall' ? 1 : 0;
        const y = bbox.top + (2 + row * (axisFont + 2)) * ratio;
        c.fillText(kind === 'fall' ? 'fall' : 'push', x + 4 * ratio, y);
      }
    }
    c.restore();
  }

  private showReadoutOf(uplot: uPlot): void {
    const plot = this.plots.find((candidate) => candidate.uplot === uplot);
    if (plot !== undefined) this.showReadout(plot);
  }

  /** The numbers under the cursor, else the newest. */
  private showReadout({ uplot, readout, spec }: Plot): void {
    const [t] = uplot.data;
    const index = uplot.cursor.idx ?? t.length - 1;
    const measured = uplot.data[1]?.[index] ?? undefined;
    const when =
      uplot.cursor.idx === null || uplot.cursor.idx === undefined
        ? ''
        : `at ${formatNumber(t[index], 2)} s: `;
    let text = `${when}${formatNumber(measured, 3)}`;
    if (spec.reference !== undefined) {
      text += ` / ${formatNumber(uplot.data[2]?.[index] ?? undefined, 3)}`;
    }
    setText(readout, `${text} m`);
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
