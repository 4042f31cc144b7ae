// The event log, and the words for people who do not see the page.

import { byId, formatNumber, setText } from '../dom';
import type { StreamEvent } from '../protocol';
import type { Store } from '../store';

const listedEvents = 200;
/** Told aloud: a step each second would drown everything else. */
const announcedKinds = new Set(['push_started', 'push_done', 'fall', 'command']);

export class EventsPanel {
  private readonly list = byId('events', HTMLOListElement);
  private readonly announcer = byId('announcer', HTMLElement);
  private waiting: StreamEvent[] = [];

  constructor(store: Store) {
    const withSteps = byId('show-steps', HTMLInputElement);
    withSteps.addEventListener('change', () => {
      this.list.classList.toggle('with-steps', withSteps.checked);
    });
    store.on('event', () => {
      const event = store.events[store.events.length - 1];
      if (event === undefined) return;
      this.waiting.push(event);
      if (this.waiting.length > listedEvents) this.waiting.shift();
      if (announcedKinds.has(event.kind)) this.announce(event.text);
    });
    store.on('hello', () => {
      this.waiting = [];
      this.list.replaceChildren();
    });
  }

  announce(text: string): void {
    setText(this.announcer, text);
  }

  /** Puts what has come since the last frame on the list, newest first. */
  update(): void {
    if (this.waiting.length === 0) return;
    this.list.prepend(...this.waiting.reverse().map((event) => this.row(event)));
    this.waiting = [];
    while (this.list.childElementCount > listedEvents) this.list.lastElementChild?.remove();
  }

  private row(event: StreamEvent): HTMLLIElement {
    const row = document.createElement('li');
    row.className = `kind-${event.kind}`;
    const time = document.createElement('time');
    time.textContent = `${formatNumber(event.t, 3)} s`;
    time.title = `Tick ${event.tick}`;
    const text = document.createElement('span');
    const words = event.text === '' ? event.kind.replaceAll('_', ' ') : event.text;
    text.textContent = event.source === '' ? words : `${words} (${event.source})`;
    row.append(time, text);
    return row;
  }
}
