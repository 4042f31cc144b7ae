// The server's HTTP API (docs/api.md), typed. Every call throws a Problem when it did not work.

import {
  asArray,
  asBoolean,
  asNames,
  asNumber,
  asNumberOrNull,
  asNumbers,
  asString,
  isObject,
  parseJson,
} from './json';
import type { JsonObject } from './json';
import type { PushBody } from './push_request';

/** What went wrong, in the server's words where it has spoken (RFC 9457). */
export class Problem extends Error {
  constructor(
    readonly status: number,
    readonly title: string,
    readonly detail: string,
    readonly errors: readonly { readonly pointer: string; readonly detail: string }[],
  ) {
    super(detail !== '' ? `${title}: ${detail}` : title);
    this.name = 'Problem';
  }

  /** One sentence a line, for people. */
  lines(): string[] {
    if (this.errors.length === 0) return [this.message];
    return this.errors.map(({ pointer, detail }) => {
      const field = pointer.replace(/^\//, '').replaceAll('/', '.');
      return field === '' ? detail : `${field} ${detail}`;
    });
  }
}

export function problemFrom(status: number, text: string): Problem {
  const body = parseJson(text);
  if (!isObject(body)) return new Problem(status, `The server answered ${status}`, '', []);
  const errors = asArray(body['errors']).flatMap((item) =>
    isObject(item)
      ? [{ pointer: asString(item['pointer']), detail: asString(item['detail']) }]
      : [],
  );
  return new Problem(
    status,
    asString(body['title'], `The server answered ${status}`),
    asString(body['detail']),
    errors,
  );
}

/** Any thrown thing as lines for people. */
export function linesOf(error: unknown): string[] {
  if (error instanceof Problem) return error.lines();
  return [error instanceof Error ? error.message : String(error)];
}

export interface SimulationState {
  readonly sessionId: string;
  readonly robot: string;
  readonly plant: string;
  readonly seed: number;
  readonly tick: number;
  readonly timeS: number;
  readonly running: boolean;
  readonly walkingState: string;
  readonly walking: boolean;
  readonly fallen: boolean;
  readonly fallReason: string;
  readonly strategies: Readonly<Record<string, boolean>>;
  readonly stepCount: number;
  readonly worstDcmErrorM: number;
  readonly realTimeFactor: number;
  readonly lateTicks: number;
  readonly droppedMessages: number;
  /** Why the simulation broke down; empty while it is sound. */
  readonly error: string;
  readonly stateHash: string;
  readonly version: string;
}

export interface RobotInfo {
  readonly name: string;
  readonly massKg: number;
  readonly comHeightM: number;
  readonly links: readonly string[];
  readonly joints: readonly string[];
  /** Link that base_position tells of; empty: the root of the URDF. */
  readonly baseLink: string;
  /** Link that pushes act on by default. */
  readonly torsoLink: string;
  readonly sole: { readonly lengthM: number; readonly widthM: number };
}

export interface PushResource {
  readonly id: number;
  readonly state: string;
  readonly link: string;
  readonly directionDeg: number;
  readonly impulseNs: number;
  readonly durationS: number;
  /** Norm of the impulse that has acted [N s]. */
  readonly deliveredNs: number;
  readonly startTick: number | null;
}

export interface CommandAnswer {
  readonly tick: number;
  readonly timeS: number;
}

/** Sole of the paper's robot [m], for a server that does not tell the robot's. */
const paperSole = { lengthM: 0.15, widthM: 0.075 };

function parseStrategies(value: unknown): Record<string, boolean> {
  const strategies: Record<string, boolean> = {};
  if (isObject(value)) {
    for (const [name, on] of Object.entries(value)) {
      if (typeof on === 'boolean') strategies[name] = on;
    }
  }
  return strategies;
}

export function parseSimulation(value: unknown): SimulationState {
  const body: JsonObject = isObject(value) ? value : {};
  const stream: JsonObject = isObject(body['stream']) ? body['stream'] : {};
  return {
    sessionId: asString(body['session_id']),
    robot: asString(body['robot']),
    plant: asString(body['plant']),
    seed: asNumber(body['seed'], 1),
    tick: asNumber(body['tick']),
    timeS: asNumber(body['time_s']),
    running: asBoolean(body['running'], true),
    walkingState: asString(body['walking_state']),
    walking: asBoolean(body['walking']),
    fallen: asBoolean(body['fallen']),
    fallReason: asString(body['fall_reason']),
    strategies: parseStrategies(body['strategies']),
    stepCount: asNumber(body['step_count']),
    worstDcmErrorM: asNumber(body['worst_dcm_error_m']),
    realTimeFactor: asNumber(body['real_time_factor'], Number.NaN),
    lateTicks: asNumber(body['late_ticks']),
    droppedMessages: asNumber(stream['dropped_messages']),
    error: asString(body['error']),
    stateHash: asString(body['state_hash']),
    version: asString(body['version']),
  };
}

export function parseRobot(value: unknown): RobotInfo {
  const body: JsonObject = isObject(value) ? value : {};
  const sole: JsonObject = isObject(body['sole']) ? body['sole'] : {};
  return {
    name: asString(body['name']),
    massKg: asNumber(body['mass_kg'], Number.NaN),
    comHeightM: asNumber(body['com_height_m'], 1),
    links: asNames(body['links']),
    joints: asNames(body['joints']),
    baseLink: asString(body['base_link']),
    torsoLink: asString(body['torso_link']),
    sole: {
      lengthM: asNumber(sole['length_m'], paperSole.lengthM),
      widthM: asNumber(sole['width_m'], paperSole.widthM),
    },
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
    deliveredNs: Math.hypot(...asNumbers(body['delivered_ns'])),
    startTick: asNumberOrNull(body['start_tick']),
  };
}

function parseAnswer(value: unknown): CommandAnswer {
  const body: JsonObject = isObject(value) ? value : {};
  return { tick: asNumber(body['tick']), timeS: asNumber(body['time_s']) };
}

/** How long a request may take before it counts as not answered [ms]: a long step takes time. */
const patienceMs = 20000;

export class Api {
  constructor(private readonly base = '/api/v1') {}

  async simulation(): Promise<SimulationState> {
    return parseSimulation(await this.request('GET', '/simulation'));
  }

  async pause(): Promise<CommandAnswer> {
    return parseAnswer(await this.request('POST', '/simulation/pause', {}));
  }

  async resume(): Promise<CommandAnswer> {
    return parseAnswer(await this.request('POST', '/simulation/resume', {}));
  }

  async step(ticks: number): Promise<CommandAnswer> {
    return parseAnswer(await this.request('POST', '/simulation/step', { ticks }));
  }

  async reset(choice: { robot?: string; plant?: string; seed?: number }): Promise<CommandAnswer> {
    return parseAnswer(await this.request('POST', '/simulation/reset', choice));
  }

  async walk(command: { vx: number; vy: number; wz: number }): Promise<CommandAnswer> {
    return parseAnswer(await this.request('POST', '/walk', command));
  }

  async stop(): Promise<CommandAnswer> {
    return parseAnswer(await this.request('POST', '/stop', {}));
  }

  async setStrategies(change: Readonly<Record<string, boolean>>): Promise<void> {
    await this.request('PATCH', '/strategies', change);
  }

  async push(body: PushBody): Promise<PushResource> {
    return parsePush(await this.request('POST', '/pushes', body));
  }

  /** The newest pushes, newest first. */
  async pushes(limit: number): Promise<PushResource[]> {
    const answer = await this.request('GET', `/pushes?limit=${limit}`);
    return asArray(isObject(answer) ? answer['items'] : undefined).map(parsePush);
  }

  async cancelPush(id: number): Promise<void> {
    await this.request('DELETE', `/pushes/${id}`);
  }

  async robots(): Promise<RobotInfo[]> {
    const answer = await this.request('GET', '/robots');
    return asArray(isObject(answer) ? answer['items'] : undefined).map(parseRobot);
  }

  async robot(name: string): Promise<RobotInfo> {
    return parseRobot(await this.request('GET', `/robots/${encodeURIComponent(name)}`));
  }

  /** Where a robot's URDF and meshes lie; ends in a slash. */
  robotFiles(name: string): string {
    return `${this.base}/robots/${encodeURIComponent(name)}/files/`;
  }

  async robotUrdf(name: string): Promise<string> {
    return this.text('GET', `/robots/${encodeURIComponent(name)}/files/robot.urdf`);
  }

  private async request(method: string, path: string, body?: unknown): Promise<unknown> {
    const text = await this.text(method, path, body);
    return text === '' ? {} : parseJson(text);
  }

  private async text(method: string, path: string, body?: unknown): Promise<string> {
    let response: Response;
    let text: string;
    try {
      response = await fetch(this.base + path, {
        method,
        cache: 'no-store',
        signal: AbortSignal.timeout(patienceMs),
        ...(body === undefined
          ? {}
          : { headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(body) }),
      });
      text = await response.text();
    } catch {
      throw new Problem(0, 'The server does not answer', '', []);
    }
    if (!response.ok) throw problemFrom(response.status, text);
    return text;
  }
}
