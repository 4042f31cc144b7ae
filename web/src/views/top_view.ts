// The ground from above: feet, steps to come, support polygon, CoM, DCM and ZMP with references.

import type { Store } from '../store';
import type { Theme } from '../theme';
import { GroundCanvas } from './ground_canvas';
import type { Foot, Point } from './transform';
import {
  GroundTransform,
  footFrom,
  lag,
  pointFrom,
  polygonFrom,
  soleCorners,
  stepsFrom,
} from './transform';

const trailSeconds = 3;
/** Follows the middle of the feet with this time constant, so that the sway stays visible [s]. */
const followTau = 0.5;

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
    const ground = new GroundCanvas(c, view, theme);
    ground.drawGrid();
    this.drawn = { frame: null, centre, pixels_per_metre: pixelsPerMetre };
    if (store.frame === null) {
      ground.drawScale();
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
      ground.outline(corners(step), theme.planned, 1.2, [4, 4]);
    });
    c.globalAlpha = 1;
    for (const name of ['left_foot_target', 'right_foot_target'] as const) {
      const target = footFrom(store.values(name));
      if (target !== null) ground.outline(corners(target), theme.reference, 1.2, [3, 3]);
    }
    for (const foot of [left, right]) {
      if (foot === null) continue;
      ground.fill(corners(foot), theme.measured, 0.14);
      ground.outline(corners(foot), theme.measured, 1.6);
      ground.toe(foot, sole.lengthM);
    }
    if (left !== null) ground.footName(left, 'L', sole.lengthM);
    if (right !== null) ground.footName(right, 'R', sole.lengthM);
    if (polygon.length > 2) {
      ground.fill(polygon, theme.limit, 0.05);
      ground.outline(polygon, theme.limit, 1.2);
    }
    if (planned !== undefined) ground.outline(corners(planned), theme.planned, 1.4, [4, 4]);
    if (adjusted !== undefined) {
      ground.fill(corners(adjusted), theme.planned, 0.16);
      ground.outline(corners(adjusted), theme.planned, 2);
      if (planned !== undefined) ground.link(planned, adjusted);
    }

    const { series } = store;
    const from = series.lowerBound('t', store.frame.t - trailSeconds);
    ground.trail(series.view('com_x', from), series.view('com_y', from), 1.6);
    ground.trail(series.view('dcm_x', from), series.view('dcm_y', from), 1);
    const push = store.values('push_force');
    const point = store.values('push_point');
    const pushed = Math.hypot(push[0] ?? 0, push[1] ?? 0) > 0;
    if (pushed) ground.pushArrow(point, push, unit);

    const marks = {
      com: pointFrom(store.values('com')),
      com_reference: pointFrom(store.values('com_reference')),
      dcm: pointFrom(store.values('dcm')),
      dcm_reference: pointFrom(store.values('dcm_reference')),
      zmp: pointFrom(store.values('zmp')),
      zmp_reference: pointFrom(store.values('zmp_reference')),
      zmp_command: pointFrom(store.values('zmp_command')),
    };
    ground.square(marks.zmp_reference, theme.reference, false);
    ground.plus(marks.zmp_command, theme.reference);
    ground.square(marks.zmp, theme.measured, true);
    ground.disc(marks.com_reference, theme.reference, false);
    ground.disc(marks.com, theme.measured, true);
    ground.diamond(marks.dcm_reference, theme.reference, false);
    ground.diamond(marks.dcm, theme.measured, true);
    ground.drawScale();

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
      trail_points: series.length - from,
      push_arrow: pushed,
    };
  }
}
