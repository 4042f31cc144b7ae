// Drawing on the ground seen from above: everything is given in the world and ends on the canvas.

import type { Theme } from '../theme';
import type { Foot, GroundTransform, Point } from './transform';
import { scaleBarLength } from './transform';

export class GroundCanvas {
  constructor(
    private readonly context: CanvasRenderingContext2D,
    private readonly view: GroundTransform,
    readonly theme: Theme,
  ) {}

  private path(points: readonly Point[]): void {
    this.context.beginPath();
    points.forEach((point, i) => {
      const { x, y } = this.view.toCanvas(point);
      if (i === 0) this.context.moveTo(x, y);
      else this.context.lineTo(x, y);
    });
  }

  outline(points: readonly Point[], colour: string, width: number, dash: number[] = []): void {
    const c = this.context;
    this.path(points);
    c.closePath();
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.setLineDash(dash);
    c.stroke();
    c.setLineDash([]);
  }

  fill(points: readonly Point[], colour: string, alpha: number): void {
    const c = this.context;
    this.path(points);
    c.closePath();
    c.fillStyle = colour;
    c.globalAlpha = alpha;
    c.fill();
    c.globalAlpha = 1;
  }

  /** A short line from the middle of the sole to its toe: which way the foot looks. */
  toe(foot: Foot, length: number): void {
    const along = (d: number): Point => ({
      x: foot.x + Math.cos(foot.yaw) * d,
      y: foot.y + Math.sin(foot.yaw) * d,
    });
    this.path([along(length * 0.36), along(length * 0.5)]);
    this.context.strokeStyle = this.theme.measured;
    this.context.lineWidth = 2.5;
    this.context.stroke();
  }

  footName(foot: Foot, name: string, length: number): void {
    const c = this.context;
    const { x, y } = this.view.toCanvas({
      x: foot.x - Math.cos(foot.yaw) * length * 0.36,
      y: foot.y - Math.sin(foot.yaw) * length * 0.36,
    });
    c.fillStyle = this.theme.measured;
    c.font = `600 11px ${this.theme.font}`;
    c.textAlign = 'center';
    c.textBaseline = 'middle';
    c.fillText(name, x, y);
  }

  /** A way on the ground, not closed. */
  way(points: readonly Point[], colour: string, width: number, dash: number[] = []): void {
    if (points.length < 2) return;
    const c = this.context;
    this.path(points);
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.setLineDash(dash);
    c.stroke();
    c.setLineDash([]);
  }

  /** Words at a place of the ground, on a little of the background so that lines do not cross them. */
  words(text: string, at: Point, colour: string): void {
    const c = this.context;
    const { x, y } = this.view.toCanvas(at);
    c.font = `600 11.5px ${this.theme.font}`;
    c.textAlign = 'center';
    c.textBaseline = 'middle';
    const width = c.measureText(text).width;
    c.globalAlpha = 0.8;
    c.fillStyle = this.theme.surface;
    c.fillRect(x - width / 2 - 4, y - 8, width + 8, 16);
    c.globalAlpha = 1;
    c.fillStyle = colour;
    c.fillText(text, x, y);
  }

  link(from: Point, to: Point): void {
    if (Math.hypot(to.x - from.x, to.y - from.y) < 0.005) return;
    const c = this.context;
    this.path([from, to]);
    c.strokeStyle = this.theme.planned;
    c.lineWidth = 1.4;
    c.stroke();
  }

  pushArrow(point: readonly number[], force: readonly number[], unit: number): void {
    const c = this.context;
    const [fx = 0, fy = 0] = force;
    const size = Math.hypot(fx, fy);
    const length = 0.3 * unit;
    const tip = this.view.toCanvas({ x: point[0] ?? 0, y: point[1] ?? 0 });
    const tail = this.view.toCanvas({
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

  /** The way of a point, oldest first; the older part is fainter. */
  trail(xs: Float64Array, ys: Float64Array, width: number): void {
    if (xs.length < 2) return;
    const c = this.context;
    c.strokeStyle = this.theme.measured;
    c.lineWidth = width;
    c.lineJoin = 'round';
    const pieces = 6;
    for (let piece = 0; piece < pieces; piece += 1) {
      const begin = Math.floor((xs.length * piece) / pieces);
      const end = Math.min(xs.length - 1, Math.floor((xs.length * (piece + 1)) / pieces));
      c.globalAlpha = 0.08 + (0.45 * (piece + 1)) / pieces;
      c.beginPath();
      for (let i = begin; i <= end; i += 1) {
        const { x, y } = this.view.toCanvas({ x: xs[i] ?? 0, y: ys[i] ?? 0 });
        if (i === begin) c.moveTo(x, y);
        else c.lineTo(x, y);
      }
      c.stroke();
    }
    c.globalAlpha = 1;
  }

  private mark(
    point: Point | null,
    colour: string,
    filled: boolean,
    shape: (x: number, y: number) => void,
  ): void {
    if (point === null) return;
    const c = this.context;
    const { x, y } = this.view.toCanvas(point);
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

  disc(at: Point | null, colour: string, filled: boolean): void {
    const radius = filled ? 5.5 : 7;
    this.mark(at, colour, filled, (x, y) => this.context.arc(x, y, radius, 0, 2 * Math.PI));
  }

  diamond(at: Point | null, colour: string, filled: boolean): void {
    const r = filled ? 7 : 9;
    this.mark(at, colour, filled, (x, y) => {
      const c = this.context;
      c.moveTo(x, y - r);
      c.lineTo(x + r, y);
      c.lineTo(x, y + r);
      c.lineTo(x - r, y);
      c.closePath();
    });
  }

  square(at: Point | null, colour: string, filled: boolean): void {
    const r = filled ? 4.5 : 6.5;
    this.mark(at, colour, filled, (x, y) => this.context.rect(x - r, y - r, 2 * r, 2 * r));
  }

  plus(at: Point | null, colour: string): void {
    this.mark(at, colour, false, (x, y) => {
      const c = this.context;
      c.moveTo(x - 9, y);
      c.lineTo(x + 9, y);
      c.moveTo(x, y - 9);
      c.lineTo(x, y + 9);
    });
  }

  /** Grid lines each 10 cm (1 m when that gets too dense), so that movement can be seen. */
  drawGrid(): void {
    const c = this.context;
    const fine = this.view.pixelsPerMetre * 0.1 >= 12 ? 0.1 : 1;
    const corner = this.view.toWorld({ x: 0, y: 0 });
    const opposite = this.view.toWorld({ x: this.view.width, y: this.view.height });
    const lines = (
      low: number,
      high: number,
      draw: (value: number, major: boolean) => void,
    ): void => {
      for (let k = Math.ceil(low / fine); k <= Math.floor(high / fine); k += 1) {
        draw(k * fine, fine === 1 || k % 10 === 0);
      }
    };
    c.strokeStyle = this.theme.line;
    const rule = (from: Point, to: Point, major: boolean): void => {
      c.globalAlpha = major ? 1 : 0.45;
      c.lineWidth = 1;
      this.path([from, to]);
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

  drawScale(): void {
    const c = this.context;
    const metres = scaleBarLength(this.view.width / 4 / this.view.pixelsPerMetre);
    const pixels = metres * this.view.pixelsPerMetre;
    const x = 14;
    const y = this.view.height - 14;
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
    const x = this.view.width - 16;
    const y = this.view.height - 14;
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
