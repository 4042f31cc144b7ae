// A recording that is played in the views: a store of its own, whose newest frame is the one that was
// scrubbed to.

import type { RobotInfo } from './api';
import type { PushStory } from './explain';
import type { Data, StreamEvent } from './protocol';
import { pushTimeOf } from './recording';
import type { Recorded, RecordingInfo } from './recording';
import { Store } from './store';
import type { Footprint } from './store';

const shownFootprints = 40;

export class Replay {
  readonly store = new Store();
  /** Alignment of runs: when the first push began [s]. */
  readonly pushS: number;
  private readonly frames: readonly Data[];
  private readonly footprints: Footprint[] = [];
  /** Of each push, oldest first, to its end. */
  private readonly stories: PushStory[] = [];
  private index = 0;

  constructor(
    readonly info: RecordingInfo,
    recorded: Recorded,
    robot: RobotInfo,
  ) {
    this.frames = recorded.frames;
    this.pushS = pushTimeOf(recorded);
    const { store } = this;
    store.setHello(recorded.hello);
    store.setRobot(robot);
    store.setPushes(recorded.pushes);
    store.strategies = recorded.strategies;
    // As the stream has it: the events of a tick come before its data.
    const messages = [...recorded.events, ...recorded.frames].sort((a, b) => a.tick - b.tick);
    for (const message of messages) {
      if (message.op === 'event') this.hear(message);
      else this.see(message);
    }
    store.events = [...recorded.events];
    store.running = false;
    this.seek(this.startS);
  }

  get startS(): number {
    return this.frames[0]?.t ?? 0;
  }

  get endS(): number {
    return this.frames[this.frames.length - 1]?.t ?? 0;
  }

  get timeS(): number {
    return this.frames[this.index]?.t ?? 0;
  }

  seek(t: number): void {
    this.index = this.indexAt(t);
    const { store } = this;
    store.frame = this.frames[this.index] ?? null;
    const now = this.timeS;
    const begun = this.stories.filter(({ startS }) => startS <= now);
    store.story = begun[begun.length - 1] ?? this.stories[0] ?? null;
    store.footprints = this.footprints.filter((print) => print.t <= now).slice(-shownFootprints);
    store.version += 1;
  }

  private hear(event: StreamEvent): void {
    const { store } = this;
    store.addEvent(event);
    if (event.kind === 'push_started' && store.story !== null) this.stories.push(store.story);
  }

  private see(frame: Data): void {
    const { store } = this;
    const last = store.footprints[store.footprints.length - 1];
    store.setFrame(frame);
    const newest = store.footprints[store.footprints.length - 1];
    if (newest !== undefined && newest !== last) this.footprints.push(newest);
  }

  /** Of the last frame that is not later. */
  private indexAt(t: number): number {
    let low = 0;
    let high = this.frames.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if ((this.frames[middle]?.t ?? Infinity) <= t + 1e-9) low = middle;
      else high = middle - 1;
    }
    return low;
  }
}
