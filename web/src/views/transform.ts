// From the ground plane to a canvas: world x goes up the page, world y to the left, so that the
// picture turns as the push pad does.

export interface Point {
  readonly x: number;
  readonly y: number;
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
  pose: { readonly x: number; readonly y: number; readonly yaw: number },
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

/** A round length for the scale bar that is at most `longest` [m]: 1, 2 or 5 times a power of ten. */
export function scaleBarLength(longest: number): number {
  const power = 10 ** Math.floor(Math.log10(longest));
  const factor = longest / power;
  return power * (factor >= 5 ? 5 : factor >= 2 ? 2 : 1);
}

/** Moves towards a target as a first-order lag does in `dt` with time constant `tau` [s]. */
export function lag(from: number, to: number, dt: number, tau: number): number {
  return from + (to - from) * (1 - Math.exp(-dt / tau));
}
