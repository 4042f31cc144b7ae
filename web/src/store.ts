// Everything the page knows, in one place and in bounded memory. Views read it once a frame;
// panels are told when something that they show has changed.

import type { RobotInfo, SimulationState } from './api';
import { PushStory } from './explain';
import type { Data, Hello, StreamEvent } from './protocol';
import type { PushResource } from './push_body';
import { RingTable } from './ring';
import { fixedSeries, jointsOf, rowOf, torqueSeries } from './series';
import type { Connection } from './stream';
import { Terrain } from './terrain';

/** Telemetry rate asked for, in simulation time [Hz]: a push of 10 ms is always seen. */
export const rateHz = 100;
/** How far back the plots can look [s]. */
export const historySeconds = 60;
/** A quarter of slack, so that a plot's view stays whole between two redraws. */
const ringCapacity = rateHz * historySeconds * 1.25;
const maxEvents = 400;
const maxFootprints = 40;
/** A second of frames: what a push is told after may come before the word of it. */
const rememberedFrames = rateHz;
/** A message of the stream may come so much later than an answer that was made after it [ms]. */
const underWayMs = 500;

/** Channels of docs/stream.md that the page uses. */
export const usedChannels = [
  'state',
  'support_side',
  'phase_time',
  't_ss',
  't_ds',
  'planned_t_ss',
  'step_count',
  'com',
  'com_velocity',
  'angular_momentum',
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
  'joint_torque',
  'planned_step',
  'adjusted_step',
  'preview',
  'support_polygon',
  'reachable_footholds',
  'capture_region',
  'swing_path',
  'ground_forces',
  'push_force',
  'push_point',
  'fallen',
] as const;
export type ChannelName = (typeof usedChannels)[number];

/** Where a foot has landed, and where it was planned to. */
export interface Footprint {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly yaw: number;
  /** 0 left, 1 right. */
  readonly side: number;
  readonly t: number;
}

/** The connection and the robot's condition in one word for the user. */
export type Condition = 'connecting' | 'live' | 'paused' | 'fallen' | 'lost';

export const topics = [
  'connection',
  'hello',
  'running',
  'event',
  'pushes',
  'simulation',
  'robot',
  'robots',
  'condition',
] as const;
export type Topic = (typeof topics)[number];

/** Events have numbers for values: 1 is on. */
function switchesOf({ values }: StreamEvent): Record<string, boolean> {
  return Object.fromEntries(Object.entries(values).map(([name, on]) => [name, on === 1]));
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
  /** Rows of numbers for the plots; made anew for each session, as joints have it. */
  series = new RingTable<string>(fixedSeries, ringCapacity);
  terrain = new Terrain();
  /** Where the feet have landed since this page looks, oldest first. */
  footprints: Footprint[] = [];
  torqueJoints: readonly string[] = [];
  /** Oldest first. */
  events: StreamEvent[] = [];
  /** The newest ones, newest first, the one that is told of among them. */
  pushes: readonly PushResource[] = [];
  /** Which strategies may act, as far as it is known. */
  strategies: Readonly<Record<string, boolean>> = {};
  /** What the strategies did about the newest push. */
  story: PushStory | null = null;
  /** Goes up with everything that changes what the views draw. */
  version = 0;
  framesReceived = 0;
  framesDropped = 0;
  /** How far what is shown is behind the server, as far as this page can tell [ms]. */
  behindMs = 0;
  private answeredMs = -Infinity;
  private mirrored: Store | null = null;
  private mirroredVersion = -1;

  private readonly listeners = new Map<Topic, (() => void)[]>();
  private lastCondition: Condition = 'connecting';
  private jointNames: readonly string[] = [];
  private readonly lately: Data[] = [];

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

  /** Shows what another store knows, the very same objects, and tells of those topics. */
  mirror(other: Store, ...news: readonly Topic[]): void {
    this.connection = other.connection;
    this.hello = other.hello;
    this.frame = other.frame;
    this.running = other.running;
    this.simulation = other.simulation;
    this.robot = other.robot;
    this.robots = other.robots;
    this.series = other.series;
    this.terrain = other.terrain;
    this.footprints = other.footprints;
    this.torqueJoints = other.torqueJoints;
    this.events = other.events;
    this.pushes = other.pushes;
    this.strategies = other.strategies;
    this.story = other.story;
    this.jointNames = other.jointNames;
    // What has not changed is not drawn again.
    if (this.mirrored !== other || this.mirroredVersion !== other.version) this.version += 1;
    this.mirrored = other;
    this.mirroredVersion = other.version;
    for (const topic of news) this.tell(topic);
  }

  /** A session begins: nothing of the one before is kept. */
  setHello(hello: Hello): void {
    this.hello = hello;
    this.jointNames = jointsOf(hello, 'joint_position');
    this.torqueJoints = jointsOf(hello, 'joint_torque');
    this.terrain = new Terrain(hello.terrain, hello.seed);
    this.frame = null;
    this.simulation = null;
    this.footprints.length = 0;
    this.series = new RingTable<string>(
      [...fixedSeries, ...this.torqueJoints.map(torqueSeries)],
      ringCapacity,
    );
    this.events.length = 0;
    this.pushes = [];
    this.strategies = {};
    this.story = null;
    this.lately.length = 0;
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
    if (before !== null) this.noteLanding(before, frame);
    if (before === null || frame.t > before.t) {
      const states = this.hello?.states ?? [];
      const mass = this.robot?.massKg ?? Number.NaN;
      this.series.push(rowOf(frame.t, frame.v, states, this.torqueJoints, mass));
    }
    this.lately.push(frame);
    if (this.lately.length > rememberedFrames) this.lately.shift();
    this.story?.look(frame, this.hello?.states ?? []);
    this.noteCondition();
  }

  addEvent(event: StreamEvent): void {
    this.version += 1;
    this.events.push(event);
    if (this.events.length > maxEvents) this.events.splice(0, this.events.length - maxEvents);
    this.story?.take(event);
    if (event.kind === 'strategies') this.strategies = switchesOf(event);
    if (event.kind === 'push_started') this.begin(new PushStory(event, this.strategies, this.simulation?.walk));
    this.tell('event');
  }

  setPushes(pushes: readonly PushResource[]): void {
    this.pushes = pushes;
    this.tell('pushes');
  }

  /** The server's answer to a pause or a resume of this page. */
  answerRunning(running: boolean, nowMs: number): void {
    this.answeredMs = nowMs;
    this.setRunning(running);
  }

  /** A heartbeat says so. One that was under way at an answer tells of before; the next comes within a second. */
  hearRunning(running: boolean, nowMs: number): void {
    if (nowMs - this.answeredMs > underWayMs) this.setRunning(running);
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
    this.strategies = simulation.strategies;
    this.setRunning(simulation.running);
    this.tell('simulation');
    this.noteCondition();
  }

  setRobot(robot: RobotInfo | null): void {
    this.robot = robot;
    this.version += 1;
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

  /** Where the robot's trunk is meant to look [rad]; pushes are told from there. */
  get heading(): number {
    const left = this.values('left_foot_target')[3] ?? 0;
    const right = this.values('right_foot_target')[3] ?? 0;
    const turn = right - left;
    return left + 0.5 * (turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI)));
  }

  /** Name of the walking state in the newest frame. */
  get walkingState(): string {
    return this.hello?.states[this.value('state')] ?? '';
  }

  /** The frames of the moment before it, and those that were quicker than the word of it. */
  private begin(story: PushStory): void {
    for (const frame of this.lately) story.look(frame, this.hello?.states ?? []);
    this.story = story;
  }

  /** A landing shows as one more step between two frames; the foot that the ZMP leaves stood. */
  private noteLanding(before: Data, frame: Data): void {
    const landed = (frame.v['step_count']?.[0] ?? 0) > (before.v['step_count']?.[0] ?? 0);
    if (!landed) return;
    const side = (before.v['support_side']?.[0] ?? 0) > 0.5 ? 0 : 1;
    const [x, y, z, yaw] = frame.v[side === 0 ? 'left_foot' : 'right_foot'] ?? [];
    if (x === undefined || y === undefined || z === undefined || yaw === undefined) return;
    this.footprints.push({ x, y, z, yaw, side, t: frame.t });
    if (this.footprints.length > maxFootprints) this.footprints.shift();
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
