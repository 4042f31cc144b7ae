// One preset on the list: what it sets, and what can be done with it.

import { setText, smallButton } from '../dom';
import { valueText } from '../tuning';
import type { PresetInfo } from '../tuning';

export class PresetRow {
  readonly element = document.createElement('li');
  private readonly what = document.createElement('span');

  constructor(name: string, acts: { readonly use: () => void; readonly remove: () => void }) {
    this.element.dataset['preset'] = name;
    const title = document.createElement('strong');
    title.textContent = name;
    this.what.className = 'muted';
    const actions = document.createElement('div');
    actions.className = 'actions';
    actions.append(
      smallButton('Use', acts.use, `Use preset ${name}`),
      smallButton('Delete', acts.remove, `Delete preset ${name}`),
    );
    this.element.append(title, this.what, actions);
  }

  update({ note, parameters, strategies }: PresetInfo): void {
    const off = Object.keys(strategies).filter((strategy) => strategies[strategy] === false);
    const parts = [
      note,
      ...Object.entries(parameters).map(([key, value]) => `${key} ${valueText(value)}`),
      ...off.map((strategy) => `${strategy} off`),
    ];
    setText(this.what, parts.filter((part) => part !== '').join(' · '));
  }
}
