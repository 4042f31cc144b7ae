// Colours with fixed meanings, read from the style sheet so that it alone decides them.

export interface Theme {
  readonly surface: string;
  readonly ink: string;
  readonly muted: string;
  readonly line: string;
  readonly ground: string;
  readonly measured: string;
  readonly reference: string;
  readonly planned: string;
  readonly limit: string;
  readonly font: string;
}

function read(): Theme {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string): string => style.getPropertyValue(name).trim();
  return {
    surface: colour('--surface'),
    ink: colour('--ink'),
    muted: colour('--muted'),
    line: colour('--line'),
    ground: colour('--ground'),
    measured: colour('--measured'),
    reference: colour('--reference'),
    planned: colour('--planned'),
    limit: colour('--limit'),
    font: getComputedStyle(document.body).fontFamily,
  };
}

/** Calls back now and whenever the system changes between light and dark. */
export function followTheme(apply: (theme: Theme) => void): void {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  dark.addEventListener('change', () => apply(read()));
  apply(read());
}
