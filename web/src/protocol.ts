// Messages of the telemetry stream (docs/stream.md) and their parser.

import { asArray, asBoolean, asNumber, asString, isObject, parseJson } from './json';

export interface Component {
  readonly name: string;
  readonly unit: string;
}

export interface Channel {
  readonly name: string;
  readonly frame: string;
  readonly meaning: string;
  readonly components: readonly Component[];
  readonly maxRepeat: number;
}

export interface Hello {
  readonly op: 'hello';
  readonly sessionId: string;
  readonly robot: string;
  readonly plant: string;
  readonly seed: number;
  readonly terrain: Readonly<Record<string, unknown>>;
  readonly tickSeconds: number;
  readonly channels: readonly Channel[];
  readonly states: readonly string[];
}

export type Values = Readonly<Record<string, readonly number[] | undefined>>;

export interface Data {
  readonly op: 'data';
  readonly seq: number;
  readonly tick: number;
  readonly t: number;
  readonly v: Values;
}

export interface StreamEvent {
  readonly op: 'event';
  readonly tick: number;
  readonly t: number;
  readonly kind: string;
  readonly text: string;
  readonly source: string;
  readonly values: Readonly<Record<string, unknown>>;
}

export interface Heartbeat {
  readonly op: 'heartbeat';
  readonly tick: number;
  readonly t: number;
  readonly running: boolean;
  readonly dropped: number;
}

export interface Subscribed {
  readonly op: 'subscribed';
  readonly rateHz: number;
}

export interface StreamError {
  readonly op: 'error';
  readonly detail: string;
}

export type Message = Hello | Data | StreamEvent | Heartbeat | Subscribed | StreamError;

export const protocolVersion = 1;

function parseChannel(value: unknown): Channel | null {
  if (!isObject(value)) return null;
  const components = asArray(value['components']).flatMap((item): Component[] =>
    isObject(item) ? [{ name: asString(item['name']), unit: asString(item['unit']) }] : [],
  );
  return {
    name: asString(value['name']),
    frame: asString(value['frame']),
    meaning: asString(value['meaning']),
    components,
    maxRepeat: asNumber(value['max_repeat'], 1),
  };
}

/** A channel's numbers; JSON has no NaN, so a value that is not finite comes as null. */
function parseNumbers(value: unknown): number[] {
  return asArray(value).map((item) => (typeof item === 'number' ? item : Number.NaN));
}

function parseValues(value: unknown): Values {
  const values: Record<string, number[]> = {};
  if (isObject(value)) {
    for (const [name, numbers] of Object.entries(value)) values[name] = parseNumbers(numbers);
  }
  return values;
}

/** The message, or null when the text is no message of this protocol. */
export function parseMessage(text: string): Message | null {
  const value = parseJson(text);
  if (!isObject(value)) return null;
  switch (value['op']) {
    case 'hello':
      if (asNumber(value['protocol'], protocolVersion) !== protocolVersion) return null;
      return {
        op: 'hello',
        sessionId: asString(value['session_id']),
        robot: asString(value['robot']),
        plant: asString(value['plant']),
        seed: asNumber(value['seed'], 1),
        terrain: isObject(value['terrain']) ? value['terrain'] : { kind: 'flat' },
        tickSeconds: asNumber(value['tick_s'], 0.001),
        channels: asArray(value['channels'])
          .map(parseChannel)
          .filter((channel): channel is Channel => channel !== null && channel.name !== ''),
        states: asArray(value['states']).map((state) => asString(state)),
      };
    case 'data':
      return {
        op: 'data',
        seq: asNumber(value['seq']),
        tick: asNumber(value['tick']),
        t: asNumber(value['t']),
        v: parseValues(value['v']),
      };
    case 'event':
      return {
        op: 'event',
        tick: asNumber(value['tick']),
        t: asNumber(value['t']),
        kind: asString(value['kind']),
        text: asString(value['text']),
        source: asString(value['source']),
        values: isObject(value['values']) ? value['values'] : {},
      };
    case 'heartbeat':
      return {
        op: 'heartbeat',
        tick: asNumber(value['tick']),
        t: asNumber(value['t']),
        running: asBoolean(value['running'], true),
        dropped: asNumber(value['dropped']),
      };
    case 'subscribed':
      return { op: 'subscribed', rateHz: asNumber(value['rate_hz']) };
    case 'error':
      return { op: 'error', detail: asString(value['detail']) };
    default:
      return null;
  }
}
