// Who passes, by direction and hardness: a button for each cell. Cells stay when more trials come, and
// with them the focus and the press of whoever is at one.

import { survivalOf } from '../campaign';
import type { CampaignTrial, SurvivalCell } from '../campaign';
import { formatNumber, keepRows } from '../dom';

/** Cells that fit: with more, only the polar plot is drawn. */
const mostCells = 1200;

type Choose = (trial: CampaignTrial) => void;

function heading(text: string, scope: 'row' | 'col'): HTMLTableCellElement {
  const made = document.createElement('th');
  made.scope = scope;
  made.textContent = text;
  return made;
}

/** What stands in a cell; null: nobody tried. */
interface Cell {
  readonly id: string;
  readonly direction: number;
  readonly of: SurvivalCell | null;
}

class HeatCell {
  readonly element = document.createElement('td');
  private readonly button = document.createElement('button');
  private trial: CampaignTrial | null = null;

  constructor(choose: Choose) {
    this.button.type = 'button';
    this.button.className = 'heat';
    this.button.addEventListener('click', () => {
      if (this.trial !== null) choose(this.trial);
    });
  }

  update({ of, direction }: Cell, fr: number): void {
    this.trial = of?.trial ?? null;
    if (of === null) {
      this.button.remove();
      return;
    }
    const { button } = this;
    button.dataset['passed'] = of.passed === of.trials ? 'all' : of.passed === 0 ? 'none' : 'some';
    button.dataset['trial'] = String(of.trial.number);
    button.textContent = String(of.passed);
    const where = `Fr ${formatNumber(fr, 3)}, ${formatNumber(direction, 0)}°`;
    const words = `${of.passed} of ${of.trials} pass at ${where}`;
    button.title = words;
    button.setAttribute('aria-label', words);
    if (button.parentNode === null) this.element.append(button);
  }
}

class HeatRow {
  readonly element = document.createElement('tr');
  private readonly cells = new Map<string, HeatCell>();

  constructor(
    private readonly fr: number,
    private readonly choose: Choose,
  ) {
    this.element.append(heading(formatNumber(fr, 3), 'row'));
  }

  update(cells: readonly Cell[]): void {
    keepRows(
      this.element,
      this.cells,
      cells,
      () => new HeatCell(this.choose),
      (cell, of) => cell.update(of, this.fr),
      1, // the heading
    );
  }
}

export class HeatMap {
  private readonly rows = new Map<string, HeatRow>();

  constructor(
    private readonly table: HTMLTableElement,
    private readonly choose: Choose,
  ) {}

  show(trials: readonly CampaignTrial[]): void {
    const { directionsDeg, frs, rows } = survivalOf(trials);
    this.table.hidden = directionsDeg.length * frs.length > mostCells || frs.length === 0;
    const body = this.table.tBodies[0];
    if (this.table.hidden || body === undefined) return;
    const head = document.createElement('tr');
    const columns = directionsDeg.map((direction) => heading(`${formatNumber(direction, 0)}°`, 'col'));
    head.append(document.createElement('td'), ...columns);
    this.table.tHead?.replaceChildren(head);
    const cellsOf = (of: readonly (SurvivalCell | null)[]): Cell[] =>
      directionsDeg.map((direction, i) => ({ id: String(direction), direction, of: of[i] ?? null }));
    const items = frs.map((fr, i) => ({ id: String(fr), fr, cells: cellsOf(rows[i] ?? []) }));
    keepRows(
      body,
      this.rows,
      items.reverse(), // the hardest push is on top, as in the report
      ({ fr }) => new HeatRow(fr, this.choose),
      (row, { cells }) => row.update(cells),
    );
  }
}
