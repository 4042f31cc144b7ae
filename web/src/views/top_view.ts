// The ground from above: feet, steps to come, support polygon, CoM, DCM and ZMP with references.

import type { Store } from '../store';
import type { Theme } from '../theme';
import type { Point } from './transform';
import { GroundTransform, lag, scaleBarLength, soleCorners } from './transform';

const trailSeconds = 3;
/** Follows the middle of the feet with this time constant, so that the sway stays visible [s]. */
const followTau = 0.5;

interface Foot {
  readonly x: number;
  readonly y: number;
  readonly yaw: number;
}

function footFrom(values: readonly number[]): Foot | null {
  const [x, y, , yaw] = values;
  return x === undefined || y === undefined || yaw === undefined ? null : { x, y, yaw };
}

function pointFrom(values: readonly number[]): Point | null {
  const [x, y] = values;
  return x === undefined || y === undefined ? null : { x, y };
}

/** Steps of a list of x, y, yaw, side. */
export function stepsFrom(values: readonly number[]): (Foot & { side: number })[] {
  const steps: (Foot & { side: number })[] = [];
  for (let i = 0; i + 3 < values.length; i += 4) {
    const [x = 0, y = 0, yaw = 0, side = 0] = values.slice(i, i + 4);
    steps.push({ x, y, yaw, side });
  }
  return steps;
}

export function polygonFrom(values: readonly number[]): Point[] {
  const points: Point[] = [];
  for (let i = 0; i + 1 < values.length; i += 2) {
    points.push({ x: values[i] ?? 0, y: values[i + 1] ?? 0 });
  }
  return points;
}

export class TopView {
  private readonly context: CanvasRenderingContext2D;
  private centre: Point | null = null;
  /** Width of what is seen, in lengths of the robot's CoM height. */
  private span = 1.05;
  private width = 0;
  private height = 0;
  private ratio = 1;
  private dirty = true;
  private drawnVersion = -1;
  private lastTime = 0;
  private drawn: Record<string, unknown> = {};

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly store: Store,
    private theme: Theme,
  ) {
    const context = canvas.getContext('2d');
    if (context === null) throw new Error('this browser has no 2D canvas');
    this.context = context;
    store.on('hello', () => (this.centre = null));
    new ResizeObserver(() => (this.dirty = true)).observe(canvas);
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.dirty = true;
  }

  zoom(factor: number): void {
    this.span = Math.min(8, Math.max(0.3, this.span / factor));
    this.dirty = true;
  }

  /** Draws when there is something new. */
  update(nowMs: number): void {
    const dt = Math.min(0.1, Math.max(0, (nowMs - this.lastTime) / 1000));
    this.lastTime = nowMs;
    const moving = this.follow(dt);
    if (!moving && !this.dirty && this.drawnVersion === this.store.version) return;
    this.dirty = false;
    this.drawnVersion = this.store.version;
    this.fit();
    this.draw();
  }

  /** What is on the canvas now, in world and canvas coordinates. */
  state(): Record<string, unknown> {
    return this.drawn;
  }

  private follow(dt: number): boolean {
    const left = footFrom(this.store.values('left_foot'));
    const right = footFrom(this.store.values('right_foot'));
    if (left === null || right === null) return false;
    const target = { x: (left.x + right.x) / 2, y: (left.y + right.y) / 2 };
    if (this.centre === null) {
      this.centre = target;
      return true;
    }
    const far = Math.hypot(target.x - this.centre.x, target.y - this.centre.y);
    if (far < 1e-4) return false;
    this.centre = {
      x: lag(this.centre.x, target.x, dt, followTau),
      y: lag(this.centre.y, target.y, dt, followTau),
    };
    return true;
  }

  private fit(): void {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === this.width && clientHeight === this.height && ratio === this.ratio) return;
    this.width = clientWidth;
    this.height = clientHeight;
    this.ratio = ratio;
    this.canvas.width = Math.max(1, Math.round(clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(clientHeight * ratio));
  }

  private draw(): void {
    const { context: c, store, theme } = this;
    c.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    c.fillStyle = theme.surface;
    c.fillRect(0, 0, this.width, this.height);
    const unit = store.robot?.comHeightM ?? 1;
    const pixelsPerMetre = Math.min(this.width, this.height) / (this.span * unit);
    const centre = this.centre ?? { x: 0, y: 0 };
    const view = new GroundTransform(centre, pixelsPerMetre, this.width, this.height);
    this.drawGrid(view);
    this.drawn = { frame: null, centre, pixels_per_metre: pixelsPerMetre };
    if (store.frame === null) {
      this.drawScale(view);
      return;
    }
    const sole = store.robot?.sole ?? { lengthM: 0.15, widthM: 0.075 };
    const corners = (foot: Foot): Point[] => soleCorners(foot, sole.lengthM, sole.widthM);

    const polygon = polygonFrom(store.values('support_polygon'));
    const left = footFrom(store.values('left_foot'));
    const right = footFrom(store.values('right_foot'));
    const preview = stepsFrom(store.values('preview'));
    const walking = store.walkingState !== 'idle' && preview.length > 0;
    const planned = walking ? stepsFrom(store.values('planned_step'))[0] : undefined;
    const adjusted = walking ? stepsFrom(store.values('adjusted_step'))[0] : undefined;

    // Steps to come, the far ones fainter; [0] is the adjusted next step and drawn below.
    preview.slice(1).forEach((step, i) => {
      c.globalAlpha = 0.55 - 0.12 * i;
      this.outline(view, corners(step), theme.planned, 1.2, [4, 4]);
    });
    c.globalAlpha = 1;
    for (const name of ['left_foot_target', 'right_foot_target'] as const) {
      const target = footFrom(store.values(name));
      if (target !== null) this.outline(view, corners(target), theme.reference, 1.2, [3, 3]);
    }
    for (const foot of [left, right]) {
      if (foot === null) continue;
      this.fill(view, corners(foot), theme.measured, 0.14);
      this.outline(view, corners(foot), theme.measured, 1.6);
      this.toe(view, foot, sole.lengthM);
    }
    if (left !== null) this.footName(view, left, 'L', sole.lengthM);
    if (right !== null) this.footName(view, right, 'R', sole.lengthM);
    if (polygon.length > 2) {
      this.fill(view, polygon, theme.limit, 0.05);
      this.outline(view, polygon, theme.limit, 1.2);
    }
    if (planned !== undefined) this.outline(view, corners(planned), theme.planned, 1.4, [4, 4]);
    if (adjusted !== undefined) {
      this.fill(view, corners(adjusted), theme.planned, 0.16);
      this.outline(view, corners(adjusted), theme.planned, 2);
      if (planned !== undefined) this.link(view, planned, adjusted);
    }

    this.trail(view, 'com_x', 'com_y');
    this.trail(view, 'dcm_x', 'dcm_y');
    const push = store.values('push_force');
    const point = store.values('push_point');
    const pushed = Math.hypot(push[0] ?? 0, push[1] ?? 0) > 0;
    if (pushed) this.pushArrow(view, point, push, unit);

    const marks = {
      com: pointFrom(store.values('com')),
      com_reference: pointFrom(store.values('com_reference')),
      dcm: pointFrom(store.values('dcm')),
      dcm_reference: pointFrom(store.values('dcm_reference')),
      zmp: pointFrom(store.values('zmp')),
      zmp_reference: pointFrom(store.values('zmp_reference')),
      zmp_command: pointFrom(store.values('zmp_command')),
    };
    this.square(view, marks.zmp_reference, theme.reference, false);
    this.plus(view, marks.zmp_command, theme.reference);
    this.square(view, marks.zmp, theme.measured, true);
    this.disc(view, marks.com_reference, theme.reference, false);
    this.disc(view, marks.com, theme.measured, true);
    this.diamond(view, marks.dcm_reference, theme.reference, false);
    this.diamond(view, marks.dcm, theme.measured, true);
    this.drawScale(view);

    const onCanvas = (p: Point | null): Point | null => (p === null ? null : view.toCanvas(p));
    this.drawn = {
      tick: store.frame.tick,
      t: store.frame.t,
      centre,
      pixels_per_metre: pixelsPerMetre,
      width: this.width,
      height: this.height,
      feet: { left, right },
      planned_step: planned ?? null,
      adjusted_step: adjusted ?? null,
      preview_steps: preview.length,
      support_polygon: polygon,
      marks,
      marks_px: Object.fromEntries(
        Object.entries(marks).map(([name, mark]) => [name, onCanvas(mark)]),
      ),
      trail_points: this.trailStart().count,
      push_arrow: pushed,
    };
  }

  private trailStart(): { from: number; count: number } {
    const { series } = this.store;
    const from = series.lowerBound('t', (series.last('t') ?? 0) - trailSeconds);
    return { from, count: series.length - from };
  }

  private path(view: GroundTransform, points: readonly Point[]): void {
    this.context.beginPath();
    points.forEach((point, i) => {
      const { x, y } = view.toCanvas(point);
      if (i === 0) this.context.moveTo(x, y);
      else this.context.lineTo(x, y);
    });
  }

  private outline(
    view: GroundTransform,
    points: readonly Point[],
    colour: string,
    width: number,
    dash: number[] = [],
  ): void {
    const c = this.context;
    this.path(view, points);
    c.closePath();
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.setLineDash(dash);
    c.stroke();
    c.setLineDash([]);
  }

  private fill(
    view: GroundTransform,
    points: readonly Point[],
    colour: string,
    alpha: number,
  ): void {
    const c = this.context;
    this.path(view, points);
    c.closePath();
    c.fillStyle = colour;
    c.globalAlpha = alpha;
    c.fill();
    c.globalAlpha = 1;
  }

  /** A short line from the middle of the sole to its toe: which way the foot looks. */
  private toe(view: GroundTransform, foot: Foot, length: number): void {
    const along = (d: number): Point => ({
      x: foot.x + Math.cos(foot.yaw) * d,
      y: foot.y + Math.sin(foot.yaw) * d,
    });
    this.path(view, [along(length * 0.36), along(length * 0.5)]);
    this.context.strokeStyle = this.theme.measured;
    this.context.lineWidth = 2.5;
    this.context.stroke();
  }

  private footName(view: GroundTransform, foot: Foot, name: string, length: number): void {
    const c = this.context;
    const { x, y } = view.toCanvas({
      x: foot.x - Math.cos(foot.yaw) * length * 0.36,
      y: foot.y - Math.sin(foot.yaw) * length * 0.36,
    });
    c.fillStyle = this.theme.measured;
    c.font = `600 11px ${this.theme.font}`;
    c.textAlign = 'center';
    c.textBaseline = 'middle';
    c.fillText(name, x, y);
  }

  private link(view: GroundTransform, from: Point, to: Point): void {
    if (Math.hypot(to.x - from.x, to.y - from.y) < 0.005) return;
    const c = this.context;
    this.path(view, [from, to]);
    c.strokeStyle = this.theme.planned;
    c.lineWidth = 1.4;
    c.stroke();
  }

  private trail(view: GroundTransform, xName: 'com_x' | 'dcm_x', yName: 'com_y' | 'dcm_y'): void {
    const { from, count } = this.trailStart();
    if (count < 2) return;
    const c = this.context;
    const xs = this.store.series.view(xName, from);
    const ys = this.store.series.view(yName, from);
    c.strokeStyle = this.theme.measured;
    c.lineWidth = xName === 'com_x' ? 1.6 : 1;
    c.lineJoin = 'round';
    // In a few pieces, so that the older part can be fainter.
    const pieces = 6;
    for (let piece = 0; piece < pieces; piece += 1) {
      const begin = Math.floor((count * piece) / pieces);
      const end = Math.min(count - 1, Math.floor((count * (piece + 1)) / pieces));
      c.globalAlpha = 0.08 + (0.45 * (piece + 1)) / pieces;
      c.beginPath();
      for (let i = begin; i <= end; i += 1) {
        const { x, y } = view.toCanvas({ x: xs[i] ?? 0, y: ys[i] ?? 0 });
        if (i === begin) c.moveTo(x, y);
        else c.lineTo(x, y);
      }
      c.stroke();
    }
    c.globalAlpha = 1;
  }

  private pushArrow(
    view: GroundTransform,
    point: readonly number[],
    force: readonly number[],
    unit: number,
  ): void {
    const c = this.context;
    const [fx = 0, fy = 0] = force;
    const size = Math.hypot(fx, fy);
    const length = 0.3 * unit;
    const tip = view.toCanvas({ x: point[0] ?? 0, y: point[1] ?? 0 });
    const tail = view.toCanvas({
      x: (point[0] ?? 0) - (fx / size) * length,
      y: (point[1] ?? 0) - (fy / size) * length,
    });
    const angle = Math.atan2(tip.y - tail.y, tip.x - tail.x);
    c.strokeStyle = this.theme.ink;
    c.fillStyle = this.theme.ink;
    c.lineWidth = 3;
    c.beginPath();
    c.moveTo(tail.x, tail.y);
    c.lineTo(tip.x - 8 * Math.cos(angle), tip.y - 8 * Math.sin(angle));
    c.stroke();
    c.beginPath();
    c.moveTo(tip.x, tip.y);
    c.lineTo(tip.x - 12 * Math.cos(angle - 0.5), tip.y - 12 * Math.sin(angle - 0.5));
    c.lineTo(tip.x - 12 * Math.cos(angle + 0.5), tip.y - 12 * Math.sin(angle + 0.5));
    c.closePath();
    c.fill();
    c.font = `600 12px ${this.theme.font}`;
    c.textAlign = 'center';
    c.textBaseline = 'middle';
    c.fillText(
      `${size.toFixed(0)} N`,
      tail.x - 22 * Math.cos(angle),
      tail.y - 12 * Math.sin(angle),
    );
  }

  private mark(
    view: GroundTransform,
    point: Point | null,
    colour: string,
    filled: boolean,
    shape: (x: number, y: number) => void,
  ): void {
    if (point === null) return;
    const c = this.context;
    const { x, y } = view.toCanvas(point);
    c.beginPath();
    shape(x, y);
    if (filled) {
      // A rim in the background's colour keeps marks apart that lie on one another.
      c.strokeStyle = this.theme.surface;
      c.lineWidth = 3;
      c.stroke();
      c.fillStyle = colour;
      c.fill();
    } else {
      c.strokeStyle = colour;
      c.lineWidth = 1.8;
      c.stroke();
    }
  }

  private disc(view: GroundTransform, at: Point | null, colour: string, filled: boolean): void {
    const radius = filled ? 5.5 : 7;
    this.mark(view, at, colour, filled, (x, y) => this.context.arc(x, y, radius, 0, 2 * Math.PI));
  }

  private diamond(view: GroundTransform, at: Point | null, colour: string, filled: boolean): void {
    const r = filled ? 7 : 9;
    this.mark(view, at, colour, filled, (x, y) => {
      const c = this.context;
      c.moveTo(x, y - r);
      c.lineTo(x + r, y);
      c.lineTo(x, y + r);
      c.lineTo(x - r, y);
      c.closePath();
    });
  }

  private square(view: GroundTransform, at: Point | null, colour: string, filled: boolean): void {
    const r = filled ? 4.5 : 6.5;
    this.mark(view, at, colour, filled, (x, y) => this.context.rect(x - r, y - r, 2 * r, 2 * r));
  }

  private plus(view: GroundTransform, at: Point | null, colour: string): void {
    this.mark(view, at, colour, false, (x, y) => {
      const c = this.context;
      c.moveTo(x - 9, y);
      c.lineTo(x + 9, y);
      c.moveTo(x, y - 9);
      c.lineTo(x, y + 9);
    });
  }

  /** Grid lines each 10 cm (1 m when that gets too dense), so that movement can be seen. */
  private drawGrid(view: GroundTransform): void {
    const c = this.context;
    const fine = view.pixelsPerMetre * 0.1 >= 12 ? 0.1 : 1;
    const corner = view.toWorld({ x: 0, y: 0 });
    const opposite = view.toWorld({ x: this.width, y: this.height });
    const lines = (low: number, high: number, draw: (value: number, major: boolean) => void): void => {
      for (let k = Math.ceil(low / fine); k <= Math.floor(high / fine); k += 1) {
        draw(k * fine, fine === 1 || k % 10 === 0);
      }
    };
    c.strokeStyle = this.theme.line;
    const rule = (from: Point, to: Point, major: boolean): void => {
      c.globalAlpha = major ? 1 : 0.45;
      c.lineWidth = 1;
      this.path(view, [from, to]);
      c.stroke();
    };
    lines(opposite.x, corner.x, (x, major) =>
      rule({ x, y: corner.y }, { x, y: opposite.y }, major),
    );
    lines(opposite.y, corner.y, (y, major) =>
      rule({ x: corner.x, y }, { x: opposite.x, y }, major),
    );
    c.globalAlpha = 1;
  }

  private drawScale(view: GroundTransform): void {
    const c = this.context;
    const metres = scaleBarLength(this.width / 4 / view.pixelsPerMetre);
    const pixels = metres * view.pixelsPerMetre;
    const x = 14;
    const y = this.height - 14;
    c.strokeStyle = this.theme.ink;
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(x, y - 5);
    c.lineTo(x, y);
    c.lineTo(x + pixels, y);
    c.lineTo(x + pixels, y - 5);
    c.stroke();
    c.fillStyle = this.theme.ink;
    c.font = `12px ${this.theme.font}`;
    c.textAlign = 'left';
    c.textBaseline = 'bottom';
    c.fillText(metres < 1 ? `${Math.round(metres * 100)} cm` : `${metres} m`, x + 4, y - 5);
    this.drawAxes();
  }

  private drawAxes(): void {
    const c = this.context;
    const x = this.width - 16;
    const y = this.height - 14;
    c.strokeStyle = this.theme.muted;
    c.fillStyle = this.theme.muted;
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(x, y - 30);
    c.lineTo(x, y);
    c.lineTo(x - 30, y);
    c.stroke();
    c.font = `12px ${this.theme.font}`;
    c.textAlign = 'center';
    c.textBaseline = 'bottom';
    c.fillText('x', x, y - 31);
    c.textAlign = 'right';
    c.textBaseline = 'middle';
    c.fillText('y', x - 33, y - 1);
  }
}
