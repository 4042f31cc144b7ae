// The server's HTTP API (docs/api.md), typed. Every call throws a Problem when it did not work.

import {
  asArray,
  asBoolean,
  asBooleans,
  asNames,
  asNumber,
  asNumberOrNull,
  asString,
  isObject,
  parseJson,
} from './json';
import type { JsonObject } from './json';
import { keyHeaders } from './key';
import type { PushBody } from './push_request';
import { campaignsFrom, parseCampaign } from './campaign';
import type { CampaignInfo } from './campaign';
import { parsePush } from './push_body';
import type { PushResource } from './push_body';
import { parseRecording } from './recording';
import type { RecordingInfo, RecordingList } from './recording';
import { parseReport } from './robot_report';
import type { RobotReport } from './robot_report';
import { parseParameters, parsePresets } from './tuning';
import type { Parameter, ParameterValue, PresetInfo } from './tuning';

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
  readonly walk: { readonly vx: number; readonly vy: number; readonly wz: number };
  /** What control knows of the body, and how late its torques act; null on the pendulum. */
  readonly state: string | null;
  readonly controlDelayMs: number | null;
  readonly terrain: JsonObject;
  /** Those that differ from the robot's own; null: this server has none to choose. */
  readonly parameters: JsonObject | null;
  /** Who watches, this page among them. */
  readonly clients: number;
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
  /** By a user, who may delete it. */
  readonly uploaded: boolean;
}

/** What a reset may choose; what is left out stays. */
export interface ResetChoice {
  readonly robot?: string;
  readonly plant?: string;
  readonly seed?: number;
  readonly state?: string;
  readonly control_delay_ms?: number;
  readonly terrain?: Readonly<Record<string, unknown>>;
  readonly parameters?: Readonly<Record<string, unknown>>;
}

/** What came of a trial in a world of its own. */
export interface TrialResult {
  /** recovered, fell, timeout or invalid. */
  readonly outcome: string;
  readonly reason: string;
  readonly stepsToRecover: number | null;
  readonly recoveryTimeS: number | null;
  readonly worstDcmErrorM: number;
  readonly stateHash: string;
}

export interface CommandAnswer {
  readonly tick: number;
  readonly timeS: number;
}

/** Sole of the paper's robot [m], for a server that does not tell the robot's. */
const paperSole = { lengthM: 0.15, widthM: 0.075 };

export function parseSimulation(value: unknown): SimulationState {
  const body: JsonObject = isObject(value) ? value : {};
  const stream: JsonObject = isObject(body['stream']) ? body['stream'] : {};
  const walk: JsonObject = isObject(body['walk']) ? body['walk'] : {};
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
    walk: { vx: asNumber(walk['vx']), vy: asNumber(walk['vy']), wz: asNumber(walk['wz']) },
    state: typeof body['state'] === 'string' ? body['state'] : null,
    controlDelayMs: asNumberOrNull(body['control_delay_ms']),
    terrain: isObject(body['terrain']) ? body['terrain'] : { kind: 'flat' },
    parameters: isObject(body['parameters']) ? body['parameters'] : null,
    clients: asNumber(stream['clients'], 1),
    fallen: asBoolean(body['fallen']),
    fallReason: asString(body['fall_reason']),
    strategies: asBooleans(body['strategies']),
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
    uploaded: asBoolean(body['uploaded']),
    sole: {
      lengthM: asNumber(sole['length_m'], paperSole.lengthM),
      widthM: asNumber(sole['width_m'], paperSole.widthM),
    },
  };
}

function parseAnswer(value: unknown): CommandAnswer {
  const body: JsonObject = isObject(value) ? value : {};
  return { tick: asNumber(body['tick']), timeS: asNumber(body['time_s']) };
}

export function parseTrialResult(value: unknown): TrialResult {
  const body: JsonObject = isObject(value) ? value : {};
  return {
    outcome: asString(body['outcome']),
    reason: asString(body['reason']),
    stepsToRecover: asNumberOrNull(body['steps_to_recover']),
    recoveryTimeS: asNumberOrNull(body['recovery_time_s']),
    worstDcmErrorM: asNumber(body['worst_dcm_error_m'], Number.NaN),
    stateHash: asString(body['state_hash']),
  };
}

/** How long a request may take before it counts as not answered [ms]: a long step takes time. */
const patienceMs = 20000;
/** The same for a whole trial of the full body on a busy machine [ms]. */
const trialPatienceMs = 120000;

export class Api {
  /** `refused` is called when the server wants a key, or another one. */
  constructor(
    private readonly base = '/api/v1',
    private readonly key: () => string = () => '',
    private readonly refused: () => void = () => undefined,
  ) {}

  /** What every request carries; for those who load files by themselves. */
  headers(): Record<string, string> {
    return keyHeaders(this.key());
  }

  /** Opens one stream, once: a WebSocket cannot send the key in a header. */
  async ticket(): Promise<string> {
    const answer = await this.request('POST', '/tickets', {});
    return asString(isObject(answer) ? answer['ticket'] : undefined);
  }

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

  async reset(choice: ResetChoice): Promise<CommandAnswer> {
    return parseAnswer(await this.request('POST', '/simulation/reset', choice));
  }

  async walk(command: { vx: number; vy: number; wz: number }): Promise<CommandAnswer> {
    return parseAnswer(await this.request('POST', '/walk', command));
  }

  /** Steps in world coordinates, feet in turn; from standing. */
  async walkSteps(steps: readonly object[]): Promise<CommandAnswer> {
    return parseAnswer(await this.request('POST', '/walk', { steps, frame: 'world' }));
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

  async readPush(id: number): Promise<PushResource> {
    return parsePush(await this.request('GET', `/pushes/${id}`));
  }

  /** The newest pushes, newest first. */
  async pushes(limit: number): Promise<PushResource[]> {
    const answer = await this.request('GET', `/pushes?limit=${limit}`);
    return asArray(isObject(answer) ? answer['items'] : undefined).map(parsePush);
  }

  async cancelPush(id: number): Promise<void> {
    await this.request('DELETE', `/pushes/${id}`);
  }

  /** Runs a trial (docs/trial.md) in a world of its own; the one that is shown goes on. */
  async trial(spec: Readonly<Record<string, unknown>>): Promise<TrialResult> {
    return parseTrialResult(await this.request('POST', '/trials', spec, trialPatienceMs));
  }

  async parameters(): Promise<Parameter[]> {
    return parseParameters(await this.request('GET', '/parameters'));
  }

  /** null: the robot's own value. */
  async changeParameters(change: Readonly<Record<string, ParameterValue | null>>): Promise<void> {
    await this.request('PATCH', '/parameters', change);
  }

  async presets(): Promise<PresetInfo[]> {
    return parsePresets(await this.request('GET', '/presets'));
  }

  /** No note is none, not an empty one. */
  async savePreset(
    name: string,
    preset: Omit<PresetInfo, 'name' | 'note'> & { readonly note?: string },
  ): Promise<void> {
    await this.request('PUT', `/presets/${encodeURIComponent(name)}`, preset);
  }

  async applyPreset(name: string): Promise<void> {
    await this.request('POST', `/presets/${encodeURIComponent(name)}/apply`, {});
  }

  async deletePreset(name: string): Promise<void> {
    await this.request('DELETE', `/presets/${encodeURIComponent(name)}`);
  }

  /** Looks into the files of a robot; nothing is kept. */
  async checkRobot(form: FormData): Promise<RobotReport> {
    const answer = await this.request('POST', '/robots?check=true', form, trialPatienceMs);
    return parseReport(isObject(answer) ? answer['report'] : undefined);
  }

  async uploadRobot(form: FormData): Promise<void> {
    await this.request('POST', '/robots', form, trialPatienceMs);
  }

  async deleteRobot(name: string): Promise<void> {
    await this.request('DELETE', `/robots/${encodeURIComponent(name)}`);
  }

  /** Newest first, and what the server says of its disk; empty: nothing. */
  async recordings(tag: string): Promise<RecordingList> {
    const query = tag === '' ? '' : `&tag=${encodeURIComponent(tag)}`;
    const answer = await this.request('GET', `/recordings?limit=100${query}`);
    const body: JsonObject = isObject(answer) ? answer : {};
    const disk: JsonObject = isObject(body['disk']) ? body['disk'] : {};
    return {
      items: asArray(body['items']).map(parseRecording),
      warning: asString(disk['warning']),
    };
  }

  async record(when: 'now' | 'push'): Promise<RecordingInfo> {
    return parseRecording(await this.request('POST', '/recordings', { when }));
  }

  async stopRecording(id: string): Promise<void> {
    await this.request('POST', `/recordings/${encodeURIComponent(id)}/stop`, {});
  }

  async changeRecording(
    id: string,
    change: { note?: string; tags?: readonly string[]; protected?: boolean },
  ): Promise<void> {
    await this.request('PATCH', `/recordings/${encodeURIComponent(id)}`, change);
  }

  async deleteRecording(id: string): Promise<void> {
    await this.request('DELETE', `/recordings/${encodeURIComponent(id)}`);
  }

  /** A recording's lines of JSON, each so many ticks. */
  async recordingLines(id: string, every: number): Promise<string> {
    const path = `/recordings/${encodeURIComponent(id)}/data?format=ndjson&every=${every}`;
    return this.text('GET', path, undefined, trialPatienceMs);
  }

  /** Newest first. */
  async campaigns(): Promise<CampaignInfo[]> {
    return campaignsFrom(await this.request('GET', '/campaigns?limit=100'));
  }

  async startCampaign(spec: unknown): Promise<CampaignInfo> {
    return parseCampaign(await this.request('POST', '/campaigns', spec));
  }

  async cancelCampaign(id: string): Promise<void> {
    await this.request('POST', `/campaigns/${encodeURIComponent(id)}/cancel`, {});
  }

  async resumeCampaign(id: string): Promise<void> {
    await this.request('POST', `/campaigns/${encodeURIComponent(id)}/resume`, {});
  }

  async deleteCampaign(id: string): Promise<void> {
    await this.request('DELETE', `/campaigns/${encodeURIComponent(id)}`);
  }

  async campaignResults(id: string, format: 'ndjson' | 'html'): Promise<string> {
    const path = `/campaigns/${encodeURIComponent(id)}/results?format=${format}`;
    return this.text('GET', path, undefined, trialPatienceMs);
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

  private async request(
    method: string,
    path: string,
    body?: unknown,
    patience = patienceMs,
  ): Promise<unknown> {
    const text = await this.text(method, path, body, patience);
    return text === '' ? {} : parseJson(text);
  }

  private async text(
    method: string,
    path: string,
    body?: unknown,
    patience = patienceMs,
  ): Promise<string> {
    let response: Response;
    let text: string;
    // The browser names a form's type by itself.
    const json = body !== undefined && !(body instanceof FormData);
    const sent = json ? JSON.stringify(body) : body;
    try {
      response = await fetch(this.base + path, {
        method,
        cache: 'no-store',
        signal: AbortSignal.timeout(patience),
        headers: {
          ...this.headers(),
          ...(json ? { 'Content-Type': 'application/json' } : {}),
        },
        ...(sent === undefined ? {} : { body: sent }),
      });
      text = await response.text();
    } catch {
      throw new Problem(0, 'The server does not answer', '', []);
    }
    if (response.status === 401) this.refused();
    if (!response.ok) throw problemFrom(response.status, text);
    return text;
  }
}
