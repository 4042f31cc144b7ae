// A push read back from JSON: of the server's resources, and of links.

import { asNumber, asNumberOrNull, asNumbers, asString, isObject } from './json';
import type { JsonObject } from './json';
import type { PushBody, PushTrigger, Vector } from './push_request';

export interface PushResource {
  readonly id: number;
  readonly state: string;
  readonly link: string;
  readonly directionDeg: number;
  readonly impulseNs: number;
  readonly durationS: number;
  /** The push with every field resolved: sent again as it is, it is the same push to the bit. */
  readonly spec: PushBody;
  /** Norm of the impulse that has acted [N s]. */
  readonly deliveredNs: number;
  /** First tick at which it could act. */
  readonly tick: number;
  readonly startTick: number | null;
}

function vector(value: unknown): Vector | null {
  const [x, y, z] = asNumbers(value);
  return x === undefined || y === undefined || z === undefined ? null : [x, y, z];
}

function triggerFrom(value: unknown): PushTrigger | null {
  if (!isObject(value)) return null;
  const { leg } = value;
  return {
    phase: asString(value['phase']) === 'double_support' ? 'double_support' : 'single_support',
    ...(leg === 'left' || leg === 'right' ? { leg } : {}),
    fraction: asNumber(value['fraction']),
  };
}

/** A push of a link or a recording: the fields that it has; ranges are the server's business. */
export function pushFrom(json: JsonObject): PushBody {
  const { link, direction_deg, impulse_ns, force_n, duration_s, profile, at_s } = json;
  const point = vector(json['point']);
  const direction = vector(json['direction']);
  const trigger = triggerFrom(json['trigger']);
  return {
    ...(typeof link === 'string' ? { link } : {}),
    ...(point === null ? {} : { point }),
    ...(typeof direction_deg === 'number' ? { direction_deg } : {}),
    ...(direction === null ? {} : { direction }),
    ...(typeof impulse_ns === 'number' ? { impulse_ns } : {}),
    ...(typeof force_n === 'number' ? { force_n } : {}),
    ...(typeof duration_s === 'number' ? { duration_s } : {}),
    ...(profile === 'half_sine' || profile === 'rectangular' ? { profile } : {}),
    ...(trigger === null ? {} : { trigger }),
    ...(typeof at_s === 'number' ? { at_s } : {}),
  };
}

export function parsePush(value: unknown): PushResource {
  const body: JsonObject = isObject(value) ? value : {};
  const spec: JsonObject = isObject(body['spec']) ? body['spec'] : {};
  const [x = 1, y = 0] = asNumbers(spec['direction']);
  const angle = (Math.atan2(y, x) * 180) / Math.PI;
  return {
    id: asNumber(body['id']),
    state: asString(body['state']),
    link: asString(spec['link']),
    directionDeg: asNumber(spec['direction_deg'], angle),
    impulseNs: asNumber(spec['impulse_ns'], Number.NaN),
    durationS: asNumber(spec['duration_s'], Number.NaN),
    spec: pushFrom(spec),
    deliveredNs: Math.hypot(...asNumbers(body['delivered_ns'])),
    tick: asNumber(body['tick']),
    startTick: asNumberOrNull(body['start_tick']),
  };
}
