// The API key: asked for when the server wants one, kept for this tab alone.

import { byId, setText } from './dom';

const place = 'stagger-key';

/** Where a key is kept: sessionStorage, or nothing where the browser forbids it. */
export interface KeyStore {
  read(): string;
  write(key: string): void;
}

export const tabStore: KeyStore = {
  read: () => {
    try {
      return window.sessionStorage.getItem(place) ?? '';
    } catch {
      return '';
    }
  },
  write: (key) => {
    try {
      window.sessionStorage.setItem(place, key);
    } catch {
      // Then it is asked for again.
    }
  },
};

/** What a request carries; nothing without a key. */
export function keyHeaders(key: string): Record<string, string> {
  return key === '' ? {} : { Authorization: `Bearer ${key}` };
}

/** Asks for the key in a dialog; with a new one the page starts over. */
export class KeyPrompt {
  private readonly dialog = byId('key-dialog', HTMLDialogElement);
  private readonly input = byId('key', HTMLInputElement);
  private readonly error = byId('key-error', HTMLElement);

  constructor(private readonly store: KeyStore) {
    byId('key-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      const key = this.input.value.trim();
      if (key === '') {
        setText(this.error, 'Type the key.');
        return;
      }
      this.store.write(key);
      window.location.reload();
    });
  }

  /** The server has refused a request for want of a valid key. */
  ask(): void {
    if (this.dialog.open) return;
    setText(this.error, this.store.read() === '' ? '' : 'The server does not take this key.');
    this.dialog.showModal();
    this.input.focus();
  }
}
