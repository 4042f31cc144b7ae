// The ground that the robot walks on (docs/trial.md), from the stream's hello: its height and colour.

import { asArray, asNumber, asString, isObject } from './json';

export interface Patch {
  readonly xMin: number;
  readonly xMax: number;
  readonly yMin: number;
  readonly yMax: number;
  readonly friction: number;
}

interface Shove {
  readonly atS: number;
  readonly durationS: number;
  readonly xM: number;
  readonly yM: number;
}

export type TerrainKind = 'flat' | 'slope' | 'uneven' | 'platform';

/** Side of a tile of uneven ground [m]. */
export const tileSize = 0.5;
/** How long a platform takes to reach its velocity [s]. */
const runUpS = 1;

const low64 = (1n << 64n) - 1n;

/** The next number of the generator splitmix64 in state x. */
function splitmix64(x: bigint): bigint {
  let z = (x + 0x9e3779b97f4a7c15n) & low64;
  z = ((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n) & low64;
  z = ((z ^ (z >> 27n)) * 0x94d049bb133111ebn) & low64;
  return z ^ (z >> 31n);
}

function kindOf(name: string): TerrainKind {
  return name === 'slope' || name === 'uneven' || name === 'platform' ? name : 'flat';
}

export class Terrain {
  readonly kind: TerrainKind;
  readonly friction: number;
  readonly patches: readonly Patch[];
  /** Slope: of the plane, and the heading that leads straight up [rad]. */
  readonly angle: number;
  readonly uphill: number;
  /** Uneven: greatest height of a tile [m]. */
  readonly unevenness: number;
  private readonly velocity: readonly [number, number];
  private readonly shoves: readonly Shove[];
  private readonly tiles = new Map<string, number>();
  private readonly seedBits: bigint;

  /** `json` is the terrain as the API tells it; it is kept for links and forms. */
  constructor(
    readonly json: Readonly<Record<string, unknown>> = { kind: 'flat' },
    seed = 1,
  ) {
    const degree = Math.PI / 180;
    this.kind = kindOf(asString(json['kind'], 'flat'));
    this.friction = asNumber(json['friction'], 0.8);
    this.patches = asArray(json['patches']).flatMap((item) =>
      isObject(item)
        ? [
            {
              xMin: asNumber(item['x_min']),
              xMax: asNumber(item['x_max']),
              yMin: asNumber(item['y_min']),
              yMax: asNumber(item['y_max']),
              friction: asNumber(item['friction'], 0.8),
            },
          ]
        : [],
    );
    this.angle = asNumber(json['angle_deg']) * degree;
    this.uphill = asNumber(json['uphill_deg']) * degree;
    this.unevenness = asNumber(json['height_m']);
    this.velocity = [asNumber(json['vx']), asNumber(json['vy'])];
    this.shoves = asArray(json['shoves']).flatMap((item) =>
      isObject(item)
        ? [
            {
              atS: asNumber(item['at_s']),
              durationS: asNumber(item['duration_s'], 0.2),
              xM: asNumber(item['x_m']),
              yM: asNumber(item['y_m']),
            },
          ]
        : [],
    );
    this.seedBits = splitmix64(BigInt(Math.max(0, Math.round(seed))));
  }

  /** Of the ground at a place [m]. */
  height(x: number, y: number): number {
    if (this.kind === 'slope') {
      return Math.tan(this.angle) * (x * Math.cos(this.uphill) + y * Math.sin(this.uphill));
    }
    if (this.kind === 'uneven') {
      return this.tileHeight(Math.floor(x / tileSize + 0.5), Math.floor(y / tileSize + 0.5));
    }
    return 0;
  }

  /** Of the tile whose middle is at tileSize * (column, row) [m]. */
  tileHeight(column: number, row: number): number {
    if (column === 0 && row === 0) return 0;
    const key = `${column} ${row}`;
    let height = this.tiles.get(key);
    if (height === undefined) {
      const inner = splitmix64(this.seedBits ^ BigInt.asUintN(64, BigInt(column)));
      const bits = splitmix64(inner ^ BigInt.asUintN(64, BigInt(row)));
      height = this.unevenness * Number(bits >> 11n) * 2 ** -53;
      if (this.tiles.size > 20000) this.tiles.clear();
      this.tiles.set(key, height);
    }
    return height;
  }

  /** How far the platform has come at a time [m]. */
  shift(t: number): readonly [number, number] {
    if (this.kind !== 'platform') return [0, 0];
    const gathering = Math.min(t, runUpS);
    const run =
      0.5 * gathering -
      (runUpS / (2 * Math.PI)) * Math.sin((Math.PI * gathering) / runUpS) +
      t -
      gathering;
    let x = run * this.velocity[0];
    let y = run * this.velocity[1];
    for (const shove of this.shoves) {
      const share = Math.min(1, Math.max(0, (t - shove.atS) / shove.durationS));
      const way = share - Math.sin(2 * Math.PI * share) / (2 * Math.PI);
      x += way * shove.xM;
      y += way * shove.yM;
    }
    return [x, y];
  }

  /** In words, for the bar and for lists. */
  get title(): string {
    const degrees = (this.angle * 180) / Math.PI;
    switch (this.kind) {
      case 'flat':
        return 'flat ground';
      case 'slope':
        return `slope of ${Number(degrees.toFixed(1))}°`;
      case 'uneven':
        return `tiles up to ${Number((this.unevenness * 1000).toFixed(1))} mm`;
      case 'platform':
        return 'moving platform';
    }
  }
}
