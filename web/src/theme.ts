// Colours with fixed meanings, read from the style sheet so that it alone decides them.

export interface Theme {
  readonly name: 'light' | 'dark';
  readonly surface: string;
  readonly ink: string;
  readonly muted: string;
  readonly line: string;
  readonly ground: string;
  readonly measured: string;
  readonly reference: string;
  readonly planned: string;
  readonly limit: string;
  readonly good: string;
  readonly font: string;
}

const darkSystem = '(prefers-color-scheme: dark)';

function read(): Theme {
  // The variables hold both a light and a dark colour: what an element makes of them is one.
  const probe = document.createElement('span');
  document.body.append(probe);
  const colour = (name: string): string => {
    probe.style.color = `var(${name})`;
    return getComputedStyle(probe).color;
  };
  const chosen = document.documentElement.dataset['theme'];
  const isDark = chosen === undefined ? matchMedia(darkSystem).matches : chosen === 'dark';
  const theme: Theme = {
    name: isDark ? 'dark' : 'light',
    surface: colour('--surface'),
    ink: colour('--ink'),
    muted: colour('--muted'),
    line: colour('--line'),
    ground: colour('--ground'),
    measured: colour('--measured'),
    reference: colour('--reference'),
    planned: colour('--planned'),
    limit: colour('--limit'),
    good: colour('--good'),
    font: getComputedStyle(document.body).fontFamily,
  };
  probe.remove();
  return theme;
}

export type ThemeChoice = 'auto' | 'light' | 'dark';
const storageKey = 'stagger.theme';
const choices: readonly ThemeChoice[] = ['auto', 'light', 'dark'];

/** Light or dark as the system says, or as this browser's user has chosen here. */
export class ThemeSwitch {
  private choice: ThemeChoice = 'auto';
  private readonly listeners: ((theme: Theme) => void)[] = [];

  constructor() {
    const stored = this.stored();
    this.choice = choices.find((choice) => choice === stored) ?? 'auto';
    matchMedia(darkSystem).addEventListener('change', () => this.apply());
    this.apply();
  }

  get current(): ThemeChoice {
    return this.choice;
  }

  /** Calls back now and whenever the colours change. */
  follow(apply: (theme: Theme) => void): void {
    this.listeners.push(apply);
    apply(read());
  }

  next(): ThemeChoice {
    this.choice = choices[(choices.indexOf(this.choice) + 1) % choices.length] ?? 'auto';
    try {
      localStorage.setItem(storageKey, this.choice);
    } catch {
      // A browser that keeps nothing forgets the choice with the page.
    }
    this.apply();
    return this.choice;
  }

  private stored(): string | null {
    try {
      return localStorage.getItem(storageKey);
    } catch {
      return null;
    }
  }

  private apply(): void {
    const { dataset } = document.documentElement;
    if (this.choice === 'auto') delete dataset['theme'];
    else dataset['theme'] = this.choice;
    for (const listener of this.listeners) listener(read());
  }
}
