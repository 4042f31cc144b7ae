// The ground from above: feet, steps, support polygon, CoM, DCM and ZMP with their references, and
// the two regions that tell whether the next step can save the robot.

import type { Store } from '../store';
import type { Terrain } from '../terrain';
import { tileSize } from '../terrain';
import type { Theme } from '../theme';
import { GroundCanvas } from './ground_canvas';
import type { Foot, Point } from './transform';
import {
  GroundTransform,
  footFrom,
  lag,
  overlapOf,
  pathFrom,
  pointFrom,
  polygonFrom,
  soleCorners,
  stepsFrom,
} from './transform';

const trailSeconds = 3;
/** Follows the middle of the feet with this time constant, so that the sway stays visible [s]. */
const followTau = 0.5;
const leastSpan = 0.3;
const mostSpan = 8;

export class TopView {
  private readonly context: CanvasRenderingContext2D;
  private centre: Point | null = null;
  /** Width of what is seen, in lengths of the robot's CoM height. */
  private span = 1.25;
  /** Moved by hand: it follows no more until it is told to. */
  private pinned = false;
  private width = 0;
  private height = 0;
  private ratio = 1;
  private dirty = true;
  private drawnVersion = -1;
  private lastTime = 0;
  private view: GroundTransform | null = null;
  private drawn: Record<string, unknown> = {};
  /** Drawn over everything else: steps that are edited there, another run. */
  readonly overlays: ((ground: GroundCanvas) => void)[] = [];
  /** A click that is no drag, in the world; whoever edits steps there takes it. */
  onClick: ((place: Point) => void) | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly store: Store,
    private theme: Theme,
  ) {
    const context = canvas.getContext('2d');
    if (context === null) throw new Error('this browser has no 2D canvas');
    this.context = context;
    store.on('hello', () => this.follow());
    new ResizeObserver(() => this.redraw()).observe(canvas);
    canvas.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        this.zoom(Math.exp(-event.deltaY * 0.0015));
      },
      { passive: false },
    );
    canvas.addEventListener('pointerdown', (event) => this.drag(event));
    canvas.addEventListener('dblclick', () => this.follow());
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.redraw();
  }

  redraw(): void {
    this.dirty = true;
  }

  zoom(factor: number): void {
    this.span = Math.min(mostSpan, Math.max(leastSpan, this.span / factor));
    this.redraw();
  }

  /** Goes along with the robot again. */
  follow(): void {
    this.pinned = false;
    this.centre = null;
    this.redraw();
  }

  /** Draws when there is something new. */
  update(nowMs: number): void {
    const dt = Math.min(1, Math.max(0, (nowMs - this.lastTime) / 1000));
    this.lastTime = nowMs;
    const moving = !this.pinned && this.moveAlong(dt);
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

  private drag(down: PointerEvent): void {
    const { view, canvas } = this;
    if (down.button !== 0 || view === null) return;
    const grabbed = view.toWorld({ x: down.offsetX, y: down.offsetY });
    let moved = false;
    const move = (event: PointerEvent): void => {
      const way = Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY);
      if (!moved && way < 3) return;
      moved = true;
      this.pinned = true;
      const dx = event.clientX - down.clientX;
      const dy = event.clientY - down.clientY;
      const here = view.toWorld({ x: down.offsetX + dx, y: down.offsetY + dy });
      this.centre = {
        x: view.centre.x + grabbed.x - here.x,
        y: view.centre.y + grabbed.y - here.y,
      };
      this.redraw();
    };
    const end = (last: PointerEvent): void => {
      if (!moved && last.type === 'pointerup') this.onClick?.(grabbed);
      canvas.removeEventListener('pointermove', move);
      canvas.removeEventListener('pointerup', end);
      canvas.removeEventListener('pointercancel', end);
    };
    canvas.setPointerCapture(down.pointerId);
    canvas.addEventListener('pointermove', move);
    canvas.addEventListener('pointerup', end);
    canvas.addEventListener('pointercancel', end);
  }

  private moveAlong(dt: number): boolean {
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
    this.view = view;
    const ground = new GroundCanvas(c, view, theme);
    this.drawTerrain(ground, view, store.terrain);
    ground.drawGrid();
    this.drawn = { frame: null, centre, pixels_per_metre: pixelsPerMetre };
    if (store.frame === null) {
      ground.drawScale();
      return;
    }
    const sole = store.robot?.sole ?? { lengthM: 0.15, widthM: 0.075 };
    const corners = (foot: Foot): Point[] => soleCorners(foot, sole.lengthM, sole.widthM);
    const regions = this.drawRegions(ground);
    store.footprints.forEach((print, i) => {
      c.globalAlpha = 0.35 + (0.45 * (i + 1)) / store.footprints.length;
      ground.outline(corners(print), theme.muted, 1);
    });
    c.globalAlpha = 1;
    const steps = this.drawSteps(ground, corners);
    const feet = this.drawFeet(ground, corners, sole.lengthM);
    const path = pathFrom(store.values('swing_path'));
    ground.way(path, theme.planned, 1.6, [2, 4]);
    const polygon = polygonFrom(store.values('support_polygon'));
    if (polygon.length > 2) {
      ground.fill(polygon, theme.limit, 0.05);
      ground.outline(polygon, theme.limit, 1.2);
    }
    const { series } = store;
    const from = series.lowerBound('t', store.frame.t - trailSeconds);
    const to = series.lowerBound('t', store.frame.t + 1e-9);
    ground.trail(series.view('com_x', from, to), series.view('com_y', from, to), 1.6);
    ground.trail(series.view('dcm_x', from, to), series.view('dcm_y', from, to), 1);
    const push = store.values('push_force');
    const point = store.values('push_point');
    const pushed = Math.hypot(push[0] ?? 0, push[1] ?? 0) > 0;
    if (pushed) ground.pushArrow(point, push, unit);
    const marks = this.drawMarks(ground);
    ground.drawScale();
    for (const draw of this.overlays) draw(ground);

    const onCanvas = (p: Point | null): Point | null => (p === null ? null : view.toCanvas(p));
    this.drawn = {
      tick: store.frame.tick,
      t: store.frame.t,
      centre,
      pinned: this.pinned,
      pixels_per_metre: pixelsPerMetre,
      width: this.width,
      height: this.height,
      feet,
      ...steps,
      ...regions,
      swing_path: path.length,
      footprints: store.footprints.length,
      support_polygon: polygon,
      marks,
      marks_px: Object.fromEntries(
        Object.entries(marks).map(([name, mark]) => [name, onCanvas(mark)]),
      ),
      trail_points: to - from,
      push_arrow: pushed,
    };
  }

  /** Tiles by their heights, and what is more slippery than the rest. */
  private drawTerrain(ground: GroundCanvas, view: GroundTransform, terrain: Terrain): void {
    const { theme } = this;
    const box = (xMin: number, xMax: number, yMin: number, yMax: number): Point[] => [
      { x: xMin, y: yMin },
      { x: xMax, y: yMin },
      { x: xMax, y: yMax },
      { x: xMin, y: yMax },
    ];
    if (terrain.kind === 'uneven' && terrain.unevenness > 0) {
      const far = view.toWorld({ x: 0, y: 0 });
      const near = view.toWorld({ x: view.width, y: view.height });
      const tile = (value: number): number => Math.floor(value / tileSize + 0.5);
      for (let i = tile(near.x); i <= tile(far.x); i += 1) {
        for (let j = tile(near.y); j <= tile(far.y); j += 1) {
          const [x, y] = [i * tileSize, j * tileSize];
          const square = box(x - 0.25, x + 0.25, y - 0.25, y + 0.25);
          ground.fill(
            square,
            theme.muted,
            0.04 + (0.3 * terrain.tileHeight(i, j)) / terrain.unevenness,
          );
        }
      }
    }
    const [dx, dy] = terrain.shift(this.store.frame?.t ?? 0);
    for (const { xMin, xMax, yMin, yMax, friction } of terrain.patches) {
      const corners = box(xMin + dx, xMax + dx, yMin + dy, yMax + dy);
      ground.fill(corners, theme.muted, 0.16);
      ground.outline(corners, theme.muted, 1, [6, 3]);
      const [first] = corners;
      if (first === undefined) continue;
      ground.words(`μ ${friction}`, { x: xMax + dx, y: (yMin + yMax) / 2 + dy }, theme.muted);
    }
  }

  /** Where the foot in the air can land, and where it has to: they overlap, or the robot falls. */
  private drawRegions(ground: GroundCanvas): Record<string, unknown> {
    const { store, theme } = this;
    const reach = polygonFrom(store.values('reachable_footholds'));
    const capture = polygonFrom(store.values('capture_region'));
    const overlap = overlapOf(capture, reach);
    if (reach.length > 2) {
      ground.fill(reach, theme.planned, 0.05);
      ground.outline(reach, theme.planned, 1, [1, 3]);
    }
    if (capture.length > 2) {
      const colour = overlap.length > 0 ? theme.good : theme.limit;
      ground.fill(capture, colour, 0.06);
      ground.outline(capture, colour, 1.2, [5, 3]);
      if (overlap.length > 0) ground.fill(overlap, theme.good, 0.16);
    }
    return {
      reachable_footholds: reach,
      capture_region: capture,
      capturable: capture.length > 2 ? overlap.length > 0 : null,
    };
  }

  /** Steps to come; the far ones fainter. */
  private drawSteps(
    ground: GroundCanvas,
    corners: (foot: Foot) => Point[],
  ): Record<string, unknown> {
    const { store, theme, context: c } = this;
    const preview = stepsFrom(store.values('preview'));
    const walking = store.walkingState !== 'idle' && preview.length > 0;
    const planned = walking ? stepsFrom(store.values('planned_step'))[0] : undefined;
    const adjusted = walking ? stepsFrom(store.values('adjusted_step'))[0] : undefined;
    // [0] is the adjusted next step and drawn below.
    preview.slice(1).forEach((step, i) => {
      c.globalAlpha = 0.55 - 0.12 * i;
      ground.outline(corners(step), theme.planned, 1.2, [4, 4]);
    });
    c.globalAlpha = 1;
    for (const name of ['left_foot_target', 'right_foot_target'] as const) {
      const target = footFrom(store.values(name));
      if (target !== null) ground.outline(corners(target), theme.reference, 1.2, [3, 3]);
    }
    if (planned !== undefined) ground.outline(corners(planned), theme.planned, 1.4, [4, 4]);
    if (adjusted !== undefined) {
      ground.fill(corners(adjusted), theme.planned, 0.16);
      ground.outline(corners(adjusted), theme.planned, 2);
      if (planned !== undefined) ground.link(planned, adjusted);
    }
    return {
      planned_step: planned ?? null,
      adjusted_step: adjusted ?? null,
      preview_steps: preview.length,
    };
  }

  private drawFeet(
    ground: GroundCanvas,
    corners: (foot: Foot) => Point[],
    length: number,
  ): Record<string, unknown> {
    const { store, theme } = this;
    const left = footFrom(store.values('left_foot'));
    const right = footFrom(store.values('right_foot'));
    const draw = (foot: Foot | null, name: string): void => {
      if (foot === null) return;
      ground.fill(corners(foot), theme.measured, 0.14);
      ground.outline(corners(foot), theme.measured, 1.6);
      ground.toe(foot, length);
      ground.footName(foot, name, length);
    };
    draw(left, 'L');
    draw(right, 'R');
    return { left, right };
  }

  private drawMarks(ground: GroundCanvas): Record<string, Point | null> {
    const { store, theme } = this;
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
    return marks;
  }
}
