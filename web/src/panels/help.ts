// The help over the page: every key, and how to use the pointer.

import { byId } from '../dom';
import type { Keys } from '../keys';

export class HelpPanel {
  private readonly dialog = byId('help', HTMLDialogElement);

  constructor(private readonly keys: Keys) {
    byId('help-open', HTMLButtonElement).addEventListener('click', () => this.open());
    byId('help-close', HTMLButtonElement).addEventListener('click', () => this.dialog.close());
    this.dialog.addEventListener('click', (event) => {
      if (event.target === this.dialog) this.dialog.close();
    });
    const enabled = byId('keys-enabled', HTMLInputElement);
    enabled.addEventListener('change', () => (keys.enabled = enabled.checked));
    keys.add({ key: '?', group: 'Page', text: 'This help', run: () => this.open() });
  }

  open(): void {
    const groups = new Map<string, HTMLElement>();
    for (const { key, shown, group, text } of this.keys.all) {
      let list = groups.get(group);
      if (list === undefined) {
        list = document.createElement('dl');
        groups.set(group, list);
      }
      const row = document.createElement('div');
      const term = document.createElement('dt');
      const cap = document.createElement('kbd');
      cap.textContent = shown ?? (key === ' ' ? 'Space' : key.length === 1 ? key.toUpperCase() : key);
      term.append(cap);
      const what = document.createElement('dd');
      what.textContent = text;
      row.append(term, what);
      list.append(row);
    }
    byId('help-keys', HTMLElement).replaceChildren(
      ...[...groups].map(([name, list]) => {
        const section = document.createElement('section');
        const title = document.createElement('h3');
        title.textContent = name;
        section.append(title, list);
        return section;
      }),
    );
    this.dialog.showModal();
  }
}
