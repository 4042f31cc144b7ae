// One line of the polar plot in numbers: the range of its limits, and the direction that takes least.

import type { CampaignTrial, Limit } from '../campaign';
import { formatNumber, setText, smallButton } from '../dom';

function rangeOf(limits: readonly Limit[]): string {
  if (limits.length === 0) return '–';
  const values = limits.map(({ pass }) => pass ?? 0);
  return `${formatNumber(Math.min(...values), 3)} to ${formatNumber(Math.max(...values), 3)}`;
}

function weakestOf(limits: readonly Limit[]): Limit | undefined {
  return limits.reduce(
    (least: Limit | undefined, limit) =>
      least === undefined || (limit.pass ?? 0) < (least.pass ?? 0) ? limit : least,
    undefined,
  );
}

export class CurveRow {
  readonly element = document.createElement('tr');
  private readonly range = document.createElement('td');
  private readonly beside = document.createElement('td');
  private readonly button: HTMLButtonElement;
  private weakest: CampaignTrial | null = null;

  constructor(series: string, choose: (trial: CampaignTrial) => void) {
    const name = document.createElement('th');
    name.scope = 'row';
    name.textContent = series === '' ? 'all' : series;
    this.button = smallButton('', () => {
      if (this.weakest !== null) choose(this.weakest);
    });
    const last = document.createElement('td');
    last.append(this.button);
    this.element.append(name, this.range, this.beside, last);
  }

  /** `others` are those of the same line of the other campaign. */
  update(limits: readonly Limit[], others: readonly Limit[]): void {
    setText(this.range, rangeOf(limits));
    setText(this.beside, rangeOf(others));
    const weakest = weakestOf(limits);
    this.weakest = weakest?.trial ?? null;
    this.button.hidden = weakest === undefined;
    const where = `${formatNumber(weakest?.directionDeg, 0)}°`;
    setText(this.button, where);
    this.button.setAttribute('aria-label', `Weakest direction, ${where}: its first trial that fails`);
  }
}
