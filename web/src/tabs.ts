// Tabs as ARIA has them. A new panel is a button with role="tab" and aria-controls in the tab list of
// index.html, and the section that it names.

import { byId } from './dom';

export class Tabs {
  private readonly tabs: readonly HTMLButtonElement[];

  constructor(listId: string) {
    const list = byId(listId, HTMLElement);
    this.tabs = Array.from(list.querySelectorAll<HTMLButtonElement>('[role=tab]'));
    for (const tab of this.tabs) {
      tab.addEventListener('click', () => this.show(tab));
    }
    list.addEventListener('keydown', (event) => {
      const now = this.tabs.findIndex((tab) => tab.getAttribute('aria-selected') === 'true');
      const last = this.tabs.length - 1;
      const to = {
        ArrowLeft: now === 0 ? last : now - 1,
        ArrowRight: now === last ? 0 : now + 1,
        Home: 0,
        End: last,
      }[event.key];
      const tab = to === undefined ? undefined : this.tabs[to];
      if (tab === undefined) return;
      event.preventDefault();
      this.show(tab);
      tab.focus();
    });
  }

  /** Shows the n-th panel, counted from 0. */
  showNumber(n: number): void {
    const tab = this.tabs[n];
    if (tab !== undefined) this.show(tab);
  }

  get count(): number {
    return this.tabs.length;
  }

  private show(shown: HTMLButtonElement): void {
    for (const tab of this.tabs) {
      const selected = tab === shown;
      tab.setAttribute('aria-selected', String(selected));
      tab.tabIndex = selected ? 0 : -1;
      byId(tab.getAttribute('aria-controls') ?? '', HTMLElement).hidden = !selected;
    }
  }
}
