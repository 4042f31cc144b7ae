// Everything the page knows, in one place and in bounded memory. Views read it once a frame;
// panels are told when something that they show has changed.

import type { RobotInfo, SimulationState } from './api';
import type { Data, Hello, StreamEvent } from './protocol';
import { RingTable } from './ring';
import type { Connection } from './stream';

/** Telemetry rate asked for, in simulation time [Hz]: a push of 10 ms is always seen. */
export const rateHz = 100;
/** What the plots look back on [s]. */
export const windowSeconds = 10;
/** A quarter of slack, so that a plot's view stays whole between two redraws. */
const ringCapacity = rateHz * windowSeconds * 1.25;
const maxEvents = 400;

/** Channels of docs/stream.md that the page uses. */
export const usedChannels = [
  'state',
  'support_side',
  'phase_time',
  't_ss',
  't_ds',
  'step_count',
  'com',
  'com_velocity',
  'dcm',
  'zmp',
  'com_reference',
  'dcm_reference',
  'zmp_reference',
  'dcm_estimate',
  'zmp_command',
  'base_position',
  'base_orientation',
  'left_foot',
  'right_foot',
  'left_foot_target',
  'right_foot_target',
  'foot_load',
  'joint_position',
  'planned_step',
  'adjusted_step',
  'preview',
  'support_polygon',
  'push_force',
  'push_point',
  'fallen',
] as const;
export type ChannelName = (typeof usedChannels)[number];

export const seriesNames = [
  't',
  'com_x',
  'com_y',
  'com_reference_x',
  'com_reference_y',
  'dcm_x',
  'dcm_y',
  'dcm_reference_x',
  'dcm_reference_y',
  'zmp_x',
  'zmp_y',
  'zmp_reference_x',
  'zmp_reference_y',
  'polygon_min_x',
  'polygon_max_x',
  'polygon_min_y',
  'polygon_max_y',
  'dcm_error',
] as const;
export type SeriesName = (typeof seriesNames)[number];

/** The connection and the robot's condition in one word for the user. */
export type Condition = 'connecting' | 'live' | 'paused' | 'fallen' | 'lost';

export type Topic =
  'connection' | 'hello' | 'running' | 'event' | 'simulation' | 'robot' | 'robots' | 'condition';

/** Least and greatest of every other number from `offset`, or NaN for an empty list. */
function extent(values: readonly number[], offset: number): [number, number] {
  let low = Number.NaN;
  let high = Number.NaN;
  for (let i = offset; i < values.length; i += 2) {
    const value = values[i] ?? Number.NaN;
    if (!(low <= value)) low = value;
    if (!(high >= value)) high = value;
  }
  return [low, high];
}

export class Store {
  connection: Connection = { kind: 'connecting' };
  hello: Hello | null = null;
  /** The newest data message. */
  frame: Data | null = null;
  /** Whether the simulation's time goes on; null until the server has said so. */
  running: boolean | null = null;
  simulation: SimulationState | null = null;
  robot: RobotInfo | null = null;
  robots: readonly RobotInfo[] = [];
  readonly series = new RingTable<SeriesName>(seriesNames, ringCapacity);
  /** Oldest first. */
  readonly events: StreamEvent[] = [];
  /** Goes up with every data message, hello and clearing. */
  version = 0;
  framesReceived = 0;
  framesDropped = 0;

  private readonly listeners = new Map<Topic, (() => void)[]>();
  private lastCondition: Condition = 'connecting';
  private jointNames: readonly string[] = [];

  on(topic: Topic, listener: () => void): void {
    const list = this.listeners.get(topic) ?? [];
    list.push(listener);
    this.listeners.set(topic, list);
  }

  setConnection(connection: Connection): void {
    this.connection = connection;
    if (connection.kind === 'connecting') this.running = null;
    this.tell('connection');
    this.noteCondition();
  }

  /** A session begins: nothing of the one before is kept. */
  setHello(hello: Hello): void {
    this.hello = hello;
    this.jointNames =
      hello.channels
        .find((channel) => channel.name === 'joint_position')
        ?.components.map((component) => component.name) ?? [];
    this.frame = null;
    this.simulation = null;
    this.series.clear();
    this.events.length = 0;
    this.framesReceived = 0;
    this.framesDropped = 0;
    this.version += 1;
    this.tell('hello');
    this.noteCondition();
  }

  setFrame(frame: Data): void {
    const before = this.frame;
    this.frame = frame;
    this.framesReceived += 1;
    this.version += 1;
    if (before === null || frame.t > before.t) this.appendSeries(frame);
    this.noteCondition();
  }

  addEvent(event: StreamEvent): void {
    this.events.push(event);
    if (this.events.length > maxEvents) this.events.splice(0, this.events.length - maxEvents);
    this.tell('event');
  }

  setRunning(running: boolean): void {
    if (running === this.running) return;
    this.running = running;
    this.tell('running');
    this.noteCondition();
  }

  setSimulation(simulation: SimulationState): void {
    // An answer that was under way while the session changed tells of the old one.
    if (this.hello !== null && simulation.sessionId !== this.hello.sessionId) return;
    this.simulation = simulation;
    this.setRunning(simulation.running);
    this.tell('simulation');
    this.noteCondition();
  }

  setRobot(robot: RobotInfo | null): void {
    this.robot = robot;
    this.tell('robot');
  }

  setRobots(robots: readonly RobotInfo[]): void {
    this.robots = robots;
    this.tell('robots');
  }

  addDropped(count: number): void {
    this.framesDropped += count;
  }

  /** Numbers of a channel in the newest frame; empty when there are none. */
  values(channel: ChannelName): readonly number[] {
    return this.frame?.v[channel] ?? [];
  }

  value(channel: ChannelName): number {
    return this.values(channel)[0] ?? Number.NaN;
  }

  /** Calls back for each joint of the newest frame. */
  eachJoint(visit: (name: string, position: number) => void): void {
    const positions = this.values('joint_position');
    this.jointNames.forEach((name, i) => {
      const position = positions[i];
      if (position !== undefined) visit(name, position);
    });
  }

  get fallen(): boolean {
    return this.frame === null ? (this.simulation?.fallen ?? false) : this.value('fallen') > 0.5;
  }

  get condition(): Condition {
    if (this.connection.kind === 'lost') return 'lost';
    if (this.connection.kind === 'connecting' || this.running === null) return 'connecting';
    if (this.fallen) return 'fallen';
    return this.running ? 'live' : 'paused';
  }

  /** Name of the walking state in the newest frame. */
  get walkingState(): string {
    return this.hello?.states[this.value('state')] ?? '';
  }

  private appendSeries(frame: Data): void {
    const pair = (name: ChannelName): readonly [number, number] => {
      const values = frame.v[name];
      return [values?.[0] ?? Number.NaN, values?.[1] ?? Number.NaN];
    };
    const [comX, comY] = pair('com');
    const [comReferenceX, comReferenceY] = pair('com_reference');
    const [dcmX, dcmY] = pair('dcm');
    const [dcmReferenceX, dcmReferenceY] = pair('dcm_reference');
    const [zmpX, zmpY] = pair('zmp');
    const [zmpReferenceX, zmpReferenceY] = pair('zmp_reference');
    const polygon = frame.v['support_polygon'] ?? [];
    const [polygonMinX, polygonMaxX] = extent(polygon, 0);
    const [polygonMinY, polygonMaxY] = extent(polygon, 1);
    this.series.push({
      t: frame.t,
      com_x: comX,
      com_y: comY,
      com_reference_x: comReferenceX,
      com_reference_y: comReferenceY,
      dcm_x: dcmX,
      dcm_y: dcmY,
      dcm_reference_x: dcmReferenceX,
      dcm_reference_y: dcmReferenceY,
      zmp_x: zmpX,
      zmp_y: zmpY,
      zmp_reference_x: zmpReferenceX,
      zmp_reference_y: zmpReferenceY,
      polygon_min_x: polygonMinX,
      polygon_max_x: polygonMaxX,
      polygon_min_y: polygonMinY,
      polygon_max_y: polygonMaxY,
      dcm_error: Math.hypot(dcmX - dcmReferenceX, dcmY - dcmReferenceY),
    });
  }

  private noteCondition(): void {
    if (this.condition === this.lastCondition) return;
    this.lastCondition = this.condition;
    this.tell('condition');
  }

  private tell(topic: Topic): void {
    for (const listener of this.listeners.get(topic) ?? []) listener();
  }
}
