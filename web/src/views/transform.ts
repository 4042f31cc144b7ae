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

/** What two convex polygons, both counter-clockwise, have in common (Sutherland and Hodgman). */
export function overlapOf(a: readonly Point[], b: readonly Point[]): Point[] {
  let rest = [...a];
  b.forEach((from, i) => {
    const to = b[(i + 1) % b.length] ?? from;
    const inside = (p: Point): number =>
      (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    const kept: Point[] = [];
    rest.forEach((p, k) => {
      const next = rest[(k + 1) % rest.length] ?? p;
      const here = inside(p);
      const there = inside(next);
      if (here >= 0) kept.push(p);
      if (here >= 0 !== there >= 0) {
        const share = here / (here - there);
        kept.push({ x: p.x + share * (next.x - p.x), y: p.y + share * (next.y - p.y) });
      }
    });
    rest = kept;
  });
  return rest.length > 2 ? rest : [];
}

/** Points of a list of x, y, z. */
export function pathFrom(values: readonly number[]): (Point & { z: number })[] {
  const points: (Point & { z: number })[] = [];
  for (let i = 0; i + 2 < values.length; i += 3) {
    points.push({ x: values[i] ?? 0, y: values[i + 1] ?? 0, z: values[i + 2] ?? 0 });
  }
  return points;
}

/** How far it is from a point inside of a convex polygon to its edge, that way; null: not inside. */
export function roomTowards(polygon: readonly Point[], from: Point, way: Point): number | null {
  const length = Math.hypot(way.x, way.y);
  if (polygon.length < 3 || !(length > 0)) return null;
  let room = Infinity;
  for (let i = 0; i < polygon.length; i += 1) {
    const a = polygon[i] ?? from;
    const b = polygon[(i + 1) % polygon.length] ?? from;
    // Counter-clockwise: the inside is on the left of every edge.
    const [nx, ny] = [a.y - b.y, b.x - a.x];
    const inside = nx * (from.x - a.x) + ny * (from.y - a.y);
    if (inside < 0) return null;
    const speed = -(nx * way.x + ny * way.y) / length;
    if (speed > 0) room = Math.min(room, inside / speed);
  }
  return Number.isFinite(room) ? room : null;
}

/**
 * How far one of two convex polygons would have to move to leave the other; negative: how far they
 * are apart, along the edge's normal that tells most. Null where one of them is none.
 */
export function overlapDepth(a: readonly Point[], b: readonly Point[]): number | null {
  if (a.length < 3 || b.length < 3) return null;
  let depth = Infinity;
  for (const polygon of [a, b]) {
    for (let i = 0; i < polygon.length; i += 1) {
      const from = polygon[i];
      const to = polygon[(i + 1) % polygon.length];
      if (from === undefined || to === undefined) continue;
      const length = Math.hypot(to.x - from.x, to.y - from.y);
      if (length < 1e-9) continue;
      const [nx, ny] = [(to.y - from.y) / length, (from.x - to.x) / length];
      const along = (points: readonly Point[]): number[] => points.map((p) => p.x * nx + p.y * ny);
      const [pa, pb] = [along(a), along(b)];
      const common = Math.min(
        Math.max(...pa) - Math.min(...pb),
        Math.max(...pb) - Math.min(...pa),
      );
      depth = Math.min(depth, common);
    }
  }
  return Number.isFinite(depth) ? depth : null;
}
