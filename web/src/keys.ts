// The keyboard: one list of keys that the page obeys and the help shows.

export interface Key {
  /** As KeyboardEvent.key has it, letters in lower case. */
  readonly key: string;
  /** As people write it; the key itself when left out. */
  readonly shown?: string;
  readonly group: string;
  readonly text: string;
  readonly run: () => void;
  /** Whether it is obeyed now. */
  readonly on?: () => boolean;
}

/** Whether a key pressed there belongs to what has the focus: typing, choosing, scrolling. */
function isTyping(target: EventTarget | null): boolean {
  return (
    target instanceof Element &&
    target.closest('input:not([type=checkbox]), select, textarea, ol, dialog, [role=tablist]') !== null
  );
}

/** Space and Enter press the button that has the focus. */
function isPressing(event: KeyboardEvent): boolean {
  return (
    (event.key === ' ' || event.key === 'Enter') &&
    event.target instanceof Element &&
    event.target.closest('button, summary, a, input') !== null
  );
}

export class Keys {
  private readonly keys: Key[] = [];
  enabled = true;

  constructor() {
    document.addEventListener('keydown', (event) => this.press(event));
  }

  add(key: Key): void {
    this.keys.push(key);
  }

  get all(): readonly Key[] {
    return this.keys;
  }

  private press(event: KeyboardEvent): void {
    if (!this.enabled || event.defaultPrevented || event.repeat) return;
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (isTyping(event.target) || isPressing(event)) return;
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.shiftKey && (name.startsWith('Arrow') || /^[a-z]$/.test(name))) return;
    const key = this.keys.find((one) => one.key === name && (one.on?.() ?? true));
    if (key === undefined) return;
    event.preventDefault();
    key.run();
  }
}
