// A recording as the server tells it, a line of JSON for each thing (docs/recording.md), made into the
// messages that a live page would have got.

import { asBooleans, asNumber, asString, isObject, parseJson } from './json';
import type { JsonObject } from './json';
import type { Channel, Data, Hello, StreamEvent } from './protocol';
import { parsePush } from './push_body';
import type { PushResource } from './push_body';

/** What the catalogue says of a recording. */
/** Recordings, and a word when their room gets scarce. */
export interface RecordingList {
  readonly items: readonly RecordingInfo[];
  readonly warning: string;
}

export interface RecordingInfo {
  readonly id: string;
  readonly state: string;
  readonly reason: string;
  readonly created: string;
  readonly robot: string;
  readonly plant: string;
  readonly durationS: number;
  readonly ticks: number;
  readonly pushes: number;
  readonly falls: number;
  readonly bytes: number;
  readonly note: string;
  readonly tags: readonly string[];
  readonly kept: boolean;
  readonly error: string;
}

export function parseRecording(value: unknown): RecordingInfo {
  const body: JsonObject = isObject(value) ? value : {};
  const { tags } = body;
  return {
    id: asString(body['id']),
    state: asString(body['state']),
    reason: asString(body['reason']),
    created: asString(body['created']),
    robot: asString(body['robot']),
    plant: asString(body['plant']),
    durationS: asNumber(body['duration_s']),
    ticks: asNumber(body['ticks']),
    pushes: asNumber(body['pushes']),
    falls: asNumber(body['falls']),
    bytes: asNumber(body['bytes']),
    note: asString(body['note']),
    tags: Array.isArray(tags) ? tags.map((tag) => asString(tag)) : [],
    kept: body['protected'] === true,
    error: asString(body['error']),
  };
}

/** The last world of a recording. */
export interface Recorded {
  readonly hello: Hello;
  readonly frames: readonly Data[];
  readonly events: readonly StreamEvent[];
  /** Every push that this world was asked for, newest first. */
  readonly pushes: readonly PushResource[];
  /** The switches before the first frame. */
  readonly strategies: Readonly<Record<string, boolean>>;
}

/** "preview[0].x": channel, place in its list, component. */
const columnName = /^([^[.]+)(\[\d+\])?(?:\.(.+))?$/;

interface Column {
  readonly channel: string;
  readonly component: string;
  readonly listed: boolean;
}

function columnsOf(names: readonly string[]): Map<string, Column> {
  const columns = new Map<string, Column>();
  for (const name of names) {
    const [, channel, item, component = 'value'] = columnName.exec(name) ?? [];
    if (channel !== undefined) columns.set(name, { channel, component, listed: item !== undefined });
  }
  return columns;
}

function channelsOf(columns: Iterable<Column>): Channel[] {
  const components = new Map<string, Set<string>>();
  for (const { channel, component } of columns) {
    const names = components.get(channel) ?? new Set();
    components.set(channel, names.add(component));
  }
  return Array.from(components, ([name, names]) => ({
    name,
    frame: '',
    meaning: '',
    components: Array.from(names, (component) => ({ name: component, unit: '' })),
    maxRepeat: 1,
  }));
}

function configOf(world: JsonObject): JsonObject {
  return isObject(world['config']) ? world['config'] : {};
}

/** `states` are the names of the walking states, which the file does not repeat. */
export function parseRecorded(text: string, states: readonly string[]): Recorded | null {
  let world: JsonObject = {};
  let frames: Data[] = [];
  let events: StreamEvent[] = [];
  let pushes: PushResource[] = [];
  let strategies: Record<string, boolean> = {};
  let columns = new Map<string, Column>();
  for (const line of text.split('\n')) {
    const json = parseJson(line);
    if (!isObject(json)) continue;
    const t = asNumber(json['t']);
    const tick = asNumber(json['tick']);
    if (json['op'] === 'world') {
      world = json;
      frames = [];
      events = [];
      pushes = [];
      strategies = asBooleans(configOf(world)['strategies']);
    } else if (json['op'] === 'command' && isObject(json['command'])) {
      const { push, strategies: change } = json['command'];
      // The server counts them from the world's begin on, as the commands do.
      if (isObject(push)) pushes.push(parsePush({ id: pushes.length + 1, spec: push }));
      if (isObject(change) && frames.length === 0) strategies = asBooleans(change);
    } else if (json['op'] === 'event') {
      events.push({
        op: 'event',
        tick,
        t,
        kind: asString(json['kind']),
        text: asString(json['text']),
        source: asString(json['source']),
        values: isObject(json['values']) ? json['values'] : {},
      });
    } else if (json['op'] === 'data' && isObject(json['v'])) {
      // Lists are as long as they were at that tick: a later frame may name more.
      const unknown = Object.keys(json['v']).filter((name) => !columns.has(name));
      if (unknown.length > 0) columns = new Map([...columns, ...columnsOf(unknown)]);
      const v: Record<string, number[]> = {};
      for (const [name, value] of Object.entries(json['v'])) {
        const column = columns.get(name);
        if (column === undefined) continue;
        if (value === null && column.listed) continue;
        (v[column.channel] ??= []).push(typeof value === 'number' ? value : Number.NaN);
      }
      frames.push({ op: 'data', seq: frames.length, tick, t, v });
    }
  }
  if (frames.length === 0) return null;
  const config = configOf(world);
  const hello: Hello = {
    op: 'hello',
    sessionId: asString(world['session_id']),
    robot: asString(config['robot']),
    plant: asString(config['plant']),
    seed: asNumber(config['seed'], 1),
    terrain: isObject(config['terrain']) ? config['terrain'] : { kind: 'flat' },
    tickSeconds: 0.001,
    channels: channelsOf(columns.values()),
    states,
  };
  return { hello, frames, events, pushes: pushes.reverse(), strategies };
}

/** When the first push of it began, else its first time [s]. */
export function pushTimeOf({ events, frames }: Recorded): number {
  const push = events.find(({ kind }) => kind === 'push_started');
  return push?.t ?? frames[0]?.t ?? 0;
}

/** Tags as people type them. */
export function tagsFrom(text: string): string[] {
  const tags = text.split(',').map((tag) => tag.trim());
  return [...new Set(tags.filter((tag) => tag !== ''))];
}
