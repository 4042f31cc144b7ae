// Step in place, walk with a velocity, stop.

import type { Api, CommandAnswer } from '../api';
import { linesOf } from '../api';
import { byId, formatNumber, numberIn, setText, showLines } from '../dom';
import type { Store } from '../store';

export class WalkPanel {
  private readonly answer = byId('walk-answer', HTMLElement);
  private readonly error = byId('walk-error', HTMLElement);

  constructor(store: Store, api: Api, done: () => void) {
    const command = async (words: string, send: () => Promise<CommandAnswer>): Promise<void> => {
      setText(this.answer, '');
      try {
        const { timeS } = await send();
        showLines(this.error, []);
        setText(this.answer, `${words} from ${formatNumber(timeS, 3)} s.`);
        done();
      } catch (error) {
        showLines(this.error, linesOf(error));
      }
    };
    byId('walk-in-place', HTMLButtonElement).addEventListener(
      'click',
      () => void command('Steps in place', () => api.walk({ vx: 0, vy: 0, wz: 0 })),
    );
    byId('walk-stop', HTMLButtonElement).addEventListener(
      'click',
      () => void command('Stops', () => api.stop()),
    );
    byId('walk-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      const velocity = {
        vx: numberIn(byId('vx', HTMLInputElement)),
        vy: numberIn(byId('vy', HTMLInputElement)),
        wz: numberIn(byId('wz', HTMLInputElement)),
      };
      if (Object.values(velocity).some((value) => !Number.isFinite(value))) {
        setText(this.answer, '');
        showLines(this.error, ['Each of the three velocities must be a number.']);
        return;
      }
      void command('Walks', () => api.walk(velocity));
    });
    store.on('hello', () => {
      setText(this.answer, '');
      showLines(this.error, []);
    });
  }
}
