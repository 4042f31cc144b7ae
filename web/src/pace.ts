// How far the page is behind the server, and at what rate it can keep up. Where reading and drawing
// take too long, fewer frames are asked for: the page drops frames rather than lag.

const fullRateHz = 100;
const leastRateHz = 12.5;
/** Beyond the time between two frames: more than this for a while, half the rate [ms]. */
const tooFarMs = 100;
const whileMs = 1500;
/** Less than this for long: twice the rate [ms]. */
const nearMs = 30;
const longMs = 10000;

export class Pace {
  rateHz = fullRateHz;
  /** What is shown is so much older than what the server has [ms]. */
  behindMs = 0;
  private backlogMs = 0;
  private receivedMs = 0;
  private since = 0;
  private state: 'far' | 'near' | 'between' = 'between';

  /** A new session, or time does not run: nothing is behind. */
  restart(): void {
    this.backlogMs = 0;
    this.behindMs = 0;
    this.state = 'between';
  }

  /** A frame has been read. */
  received(nowMs: number): void {
    this.receivedMs = nowMs;
  }

  /** The server has said its time while the newest frame read was of `newestS` [s]. */
  compared(serverS: number, newestS: number): void {
    this.backlogMs = Math.max(0, 1000 * (serverS - newestS));
  }

  /** What was read last has been drawn. Returns a new rate when it should change. */
  drawn(nowMs: number): number | null {
    this.behindMs = this.backlogMs + Math.max(0, nowMs - this.receivedMs);
    const beyond = this.behindMs - 1000 / this.rateHz;
    const state = beyond > tooFarMs ? 'far' : beyond < nearMs ? 'near' : 'between';
    if (state !== this.state) {
      this.state = state;
      this.since = nowMs;
    }
    if (state === 'far' && nowMs - this.since > whileMs && this.rateHz > leastRateHz) {
      return this.change(this.rateHz / 2, nowMs);
    }
    if (state === 'near' && nowMs - this.since > longMs && this.rateHz < fullRateHz) {
      return this.change(this.rateHz * 2, nowMs);
    }
    return null;
  }

  private change(rateHz: number, nowMs: number): number {
    this.rateHz = rateHz;
    this.since = nowMs;
    return rateHz;
  }
}
