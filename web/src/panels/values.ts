// The numbers beside the pictures: rewritten a few times a second, so that they can be read.

import { byId, formatNumber, setText } from '../dom';
import type { ChannelName, Store } from '../store';
import { Facts } from './simulation';

const periodMs = 200;

const rows: readonly (readonly [string, ChannelName, ChannelName | null])[] = [
  ['CoM', 'com', 'com_reference'],
  ['DCM', 'dcm', 'dcm_reference'],
  ['ZMP', 'zmp', 'zmp_reference'],
  ['ZMP command', 'zmp_command', null],
  ['Next step', 'adjusted_step', 'planned_step'],
  ['Left foot', 'left_foot', 'left_foot_target'],
  ['Right foot', 'right_foot', 'right_foot_target'],
];

export class ValuesPanel {
  private readonly cells: readonly (readonly HTMLTableCellElement[])[];
  private readonly gait = new Facts(byId('gait', HTMLElement), [
    ['CoM height'],
    ['Support'],
    ['Load left'],
    ['Load right'],
    ['In phase'],
    ['Single support'],
  ]);
  private lastDraw = 0;
  private drawnVersion = -1;

  constructor(private readonly store: Store) {
    const body = byId('values', HTMLTableSectionElement);
    this.cells = rows.map(([title]) => {
      const row = body.insertRow();
      const head = document.createElement('th');
      head.scope = 'row';
      head.textContent = title;
      row.append(head);
      return [row.insertCell(), row.insertCell(), row.insertCell(), row.insertCell()];
    });
    const unit = document.createElement('span');
    unit.textContent = '[m]';
    body.parentElement?.querySelector('th')?.append(unit);
  }

  update(nowMs: number): void {
    const { store } = this;
    if (store.version === this.drawnVersion || nowMs - this.lastDraw < periodMs) return;
    this.lastDraw = nowMs;
    this.drawnVersion = store.version;
    rows.forEach(([, measured, reference], i) => {
      const [x, y] = store.values(measured);
      const [refX, refY] = reference === null ? [] : store.values(reference);
      const cells = this.cells[i] ?? [];
      [x, y, refX, refY].forEach((value, column) => {
        const cell = cells[column];
        if (cell === undefined) return;
        setText(cell, reference === null && column > 1 ? '' : formatNumber(value, 3));
      });
    });
    const [left, right] = store.values('foot_load');
    const { gait } = this;
    gait.set('CoM height', `${formatNumber(store.values('com')[2], 3)} m`);
    gait.set('Support', this.support());
    gait.set('Load left', `${formatNumber(left, 0)} N`);
    gait.set('Load right', `${formatNumber(right, 0)} N`);
    gait.set('In phase', `${formatNumber(store.value('phase_time'), 2)} s`);
    gait.set('Single support', `${formatNumber(store.value('t_ss'), 3)} s`);
  }

  private support(): string {
    if (this.store.frame === null) return '–';
    const side = this.store.value('support_side') > 0.5 ? 'right' : 'left';
    return this.store.walkingState === 'single_support' ? side : 'both';
  }
}
