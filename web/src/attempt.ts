// What a person asked for and what went wrong with it.

import { linesOf } from './api';
import { showLines } from './dom';

/** Runs what was asked for and tells whether it went well; what went wrong is shown. The place is
 * cleared first and not at the end: a late answer must not wipe out what went wrong since. */
export async function attempt(errors: HTMLElement, run: () => Promise<unknown>): Promise<boolean> {
  showLines(errors, []);
  try {
    await run();
    return true;
  } catch (error) {
    showLines(errors, linesOf(error));
    return false;
  }
}
