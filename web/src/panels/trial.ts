// A push that repeats exactly: the trial made of form and world, as a link and as a run in the live
// world that ends with a state hash.

import type { Api } from '../api';
import { linesOf } from '../api';
import { byId, formatNumber, numberIn, setText, showLines } from '../dom';
import type { Store } from '../store';
import { runTrial, trialFrom, trialLike, trialLink, trialTitle } from '../trial';
import type { TrialOutcome, TrialSpec } from '../trial';
import type { PushForm } from '../push_form';
import type { PushPanel } from './push';

export class TrialPanel {
  private readonly run = byId('trial-run', HTMLButtonElement);
  private readonly copied = byId('copied', HTMLElement);
  private readonly error = byId('trial-error', HTMLElement);
  private readonly card = byId('trial-card', HTMLElement);
  private readonly title = byId('trial-title', HTMLElement);
  private readonly progress = byId('trial-progress', HTMLElement);
  private readonly start = byId('trial-start', HTMLButtonElement);
  private shared: TrialSpec | null = null;
  private outcome: TrialOutcome | null = null;
  private busy = false;

  constructor(
    private readonly store: Store,
    private readonly api: Api,
    private readonly push: PushPanel,
    private readonly form: PushForm,
  ) {
    this.run.addEventListener('click', () => {
      const spec = this.spec();
      if (spec !== null) void this.perform(spec);
    });
    byId('copy-link', HTMLButtonElement).addEventListener('click', () => {
      const spec = this.spec();
      if (spec === null) return;
      void this.copy(trialLink(window.location.href, spec), 'Link copied');
    });
    byId('copy-curl', HTMLButtonElement).addEventListener('click', () => {
      const text = push.curl();
      if (text === '') showLines(this.error, ['The push has a number missing.']);
      else void this.copy(text, 'Command copied');
    });
    this.start.addEventListener('click', () => {
      if (this.shared !== null) void this.perform(this.shared);
    });
    byId('trial-close', HTMLButtonElement).addEventListener('click', () => this.close());
    window.addEventListener('hashchange', () => this.open());
    this.open();
  }

  /** The link that was opened, and what has come of the trial; for tests. */
  state(): Record<string, unknown> {
    return { shared: this.shared !== null, busy: this.busy, outcome: this.outcome };
  }

  /** The trial of the form in the world that is shown; null until everything is known. */
  private spec(): TrialSpec | null {
    const body = this.push.body();
    const settleS = numberIn(byId('settle', HTMLInputElement));
    const observeS = numberIn(byId('observe', HTMLInputElement));
    const spec = body === null ? null : trialLike(this.store, body, settleS, observeS);
    showLines(this.error, spec === null ? ['The push has a number missing.'] : []);
    return spec;
  }

  /** A link that holds a trial: run at once, but asked first where others are watching. */
  private open(): void {
    const spec = trialFrom(window.location.hash);
    if (spec === null) return;
    this.shared = spec;
    this.outcome = null;
    this.show(spec, 'This link holds a trial.');
    this.whenConnected(() => this.performOrAsk(spec));
  }

  /** Calls back once this page itself is among the watchers. */
  private whenConnected(run: () => void): void {
    let waiting = true;
    const look = (): void => {
      if (!waiting || this.store.connection.kind !== 'open') return;
      waiting = false;
      run();
    };
    this.store.on('connection', look);
    look();
  }

  private performOrAsk(spec: TrialSpec): void {
    void this.api.simulation().then(
      ({ clients }) => {
        if (clients <= 1) void this.perform(spec);
        else setText(this.progress, 'Others are watching this world; running it resets it.');
      },
      (error: unknown) => showLines(this.error, linesOf(error)),
    );
  }

  private show(spec: TrialSpec, progress: string): void {
    this.card.hidden = false;
    setText(this.title, trialTitle(spec));
    setText(this.progress, progress);
    if (spec.push !== null) this.form.fill(spec.push);
  }

  private close(): void {
    this.card.hidden = true;
    this.shared = null;
    if (window.location.hash !== '') history.replaceState(null, '', window.location.pathname);
  }

  private async perform(spec: TrialSpec): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    this.outcome = null;
    this.run.disabled = true;
    this.start.disabled = true;
    this.show(spec, 'Starting…');
    try {
      this.outcome = await runTrial(this.api, spec, (text) => setText(this.progress, text));
      const { ticks, stateHash, fallen, reason } = this.outcome;
      setText(
        this.progress,
        `${fallen ? `Fell: ${reason}` : 'Still up'} at ${formatNumber(ticks * 0.001, 3)} s. ` +
          `State hash ${stateHash}; the world is paused there.`,
      );
      if (spec.push !== null) this.form.fill(spec.push);
    } catch (error) {
      setText(this.progress, `The trial did not run. ${linesOf(error).join(' ')}`);
    }
    this.busy = false;
    this.run.disabled = false;
    this.start.disabled = false;
    setText(this.start, 'Run it again');
  }

  private async copy(text: string, words: string): Promise<void> {
    const field = byId('copied-text', HTMLTextAreaElement);
    field.value = text;
    field.hidden = false;
    try {
      await navigator.clipboard.writeText(text);
      setText(this.copied, `${words}.`);
    } catch {
      // Without a secure address a browser gives no clipboard: the text is there to be copied.
      field.focus();
      field.select();
      setText(this.copied, 'Copy it from here:');
    }
  }
}
