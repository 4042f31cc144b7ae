// A pull at the robot as a sequence of exact pushes: each lasts a tenth of a second with the force
// that the spring had, and begins at the tick at which the one before ends. What was pulled is so a
// list of pushes that can be sent again.

import type { Api } from './api';
import type { PushBody, Vector } from './push_request';
import type { Grip } from './views/aim';

/** Length of a piece [s]. */
export const pieceS = 0.1;
/** A piece is sent this long before it is due [s]. */
const leadS = 0.04;
/** What is felt as nothing [N]; a push has to be more than zero. */
const leastForceN = 0.01;

export interface SpringPiece {
  readonly id: number;
  readonly body: PushBody;
}

export class SpringPull {
  readonly pieces: SpringPiece[] = [];
  private force: Vector = [0, 0, 0];
  private ended = false;
  private done: Promise<void> | null = null;

  constructor(
    private readonly api: Pick<Api, 'push'>,
    private readonly grip: Grip,
    private readonly failed: (error: unknown) => void,
    private readonly wait: (ms: number) => Promise<void> = (ms) =>
      new Promise((resolve) => setTimeout(resolve, ms)),
  ) {}

  pull(force: Vector): void {
    this.force = force;
    this.done ??= this.run();
  }

  /** Lets go; resolves when the last piece has been sent. */
  async end(): Promise<void> {
    this.ended = true;
    await this.done;
  }

  /** Sum of the impulses [N s]. */
  get impulseNs(): number {
    return this.pieces.reduce((sum, { body }) => sum + (body.impulse_ns ?? 0), 0);
  }

  private async run(): Promise<void> {
    let dueS: number | null = null;
    try {
      while (!this.ended) {
        const size = Math.hypot(...this.force);
        if (size > leastForceN) {
          const [x, y, z] = this.force;
          const body: PushBody = {
            ...(this.grip.link === null ? {} : { link: this.grip.link }),
            ...(this.grip.point === null ? {} : { point: this.grip.point }),
            direction: [x / size, y / size, z / size],
            impulse_ns: size * pieceS,
            duration_s: pieceS,
            profile: 'rectangular',
            ...(dueS === null ? {} : { at_s: Number(dueS.toFixed(3)) }),
          };
          const push = await this.api.push(body);
          const begunS: number = dueS ?? push.tick * 0.001;
          this.pieces.push({ id: push.id, body: { ...body, at_s: Number(begunS.toFixed(3)) } });
          dueS = begunS + pieceS;
        } else if (dueS !== null) {
          dueS += pieceS;
        }
        await this.wait(1000 * (this.pieces.length < 2 ? pieceS - leadS : pieceS));
      }
    } catch (error) {
      this.failed(error);
    }
  }
}
