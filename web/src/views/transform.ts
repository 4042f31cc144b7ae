// From the ground plane to a canvas: world x goes up the page, world y to the left, so that the
// picture turns as the push pad does.

export interface Point {
  readonly x: number;
  readonly y: number;
}

/** Place of a sole on the ground: centre [m] and yaw [rad]. */
export interface Foot extends Point {
  readonly yaw: number;
}

export class GroundTransform {
  constructor(
    readonly centre: Point,
    readonly pixelsPerMetre: number,
    readonly width: number,
    readonly height: number,
  ) {}

  /** World [m] to canvas [px], y downwards. */
  toCanvas(point: Point): Point {
    return {
      x: this.width / 2 - (point.y - this.centre.y) * this.pixelsPerMetre,
      y: this.height / 2 - (point.x - this.centre.x) * this.pixelsPerMetre,
    };
  }

  /** Canvas [px] to world [m]. */
  toWorld(pixel: Point): Point {
    return {
      x: this.centre.x - (pixel.y - this.height / 2) / this.pixelsPerMetre,
      y: this.centre.y - (pixel.x - this.width / 2) / this.pixelsPerMetre,
    };
  }
}

/** Corners of a foot's sole in the world, going round. */
export function soleCorners(
  pose: Foot,
  length: number,
  width: number,
): [Point, Point, Point, Point] {
  const c = Math.cos(pose.yaw);
  const s = Math.sin(pose.yaw);
  const corner = (along: number, across: number): Point => ({
    x: pose.x + c * along - s * across,
    y: pose.y + s * along + c * across,
  });
  const l = length / 2;
  const w = width / 2;
  return [corner(l, w), corner(l, -w), corner(-l, -w), corner(-l, w)];
}

/** A round length for the scale bar, at most `longest` [m]: 1, 2 or 5 times a power of ten. */
export function scaleBarLength(longest: number): number {
  const power = 10 ** Math.floor(Math.log10(longest));
  const factor = longest / power;
  return power * (factor >= 5 ? 5 : factor >= 2 ? 2 : 1);
}

/** Moves towards a target as a first-order lag does in `dt` with time constant `tau` [s]. */
export function lag(from: number, to: number, dt: number, tau: number): number {
  return from + (to - from) * (1 - Math.exp(-dt / tau));
}

/** A foot from a channel x, y, z, yaw, or null when there is none. */
export function footFrom(values: readonly number[]): Foot | null {
  const [x, y, , yaw] = values;
  return x === undefined || y === undefined || yaw === undefined ? null : { x, y, yaw };
}

/** A point from a channel that begins with x, y, or null when there is none. */
export function pointFrom(values: readonly number[]): Point | null {
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

/** Corners of a list of x, y. */
export function polygonFrom(values: readonly number[]): Point[] {
  const points: Point[] = [];
  for (let i = 0; i + 1 < values.length; i += 2) {
    points.push({ x: values[i] ?? 0, y: values[i + 1] ?? 0 });
  }
  return points;
}
