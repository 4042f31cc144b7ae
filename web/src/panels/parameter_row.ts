// One parameter: its value to be changed, and what it means.

import { numberIn, setText, showLines } from '../dom';
import { valueText } from '../tuning';
import type { Parameter, ParameterValue } from '../tuning';

const waits: Readonly<Record<string, string>> = {
  next_step: 'acts from a step to come',
  reset: 'acts in the next world',
};

export class ParameterRow {
  readonly element = document.createElement('div');
  private readonly input = document.createElement('input');
  private readonly own = document.createElement('button');
  private readonly hint = document.createElement('p');
  private readonly error = document.createElement('p');

  /** `change`: null is the robot's own value. */
  constructor(
    private parameter: Parameter,
    change: (value: ParameterValue | null) => void,
  ) {
    const { name, type } = parameter;
    const id = `parameter-${name.replace('.', '-')}`;
    this.element.className = 'parameter';
    this.element.dataset['parameter'] = name;
    const label = document.createElement('label');
    label.htmlFor = id;
    label.textContent = name.slice(name.indexOf('.') + 1).replaceAll('_', ' ');
    this.input.id = id;
    this.input.setAttribute('aria-describedby', `${id}-hint`);
    if (type === 'boolean') {
      this.input.type = 'checkbox';
      this.input.setAttribute('role', 'switch');
    } else {
      this.input.type = 'number';
      this.input.step = type === 'integer' ? '1' : 'any';
    }
    this.input.addEventListener('change', () => {
      const value = type === 'boolean' ? this.input.checked : numberIn(this.input);
      if (typeof value === 'number' && !Number.isFinite(value)) this.complain(['is not a number']);
      else change(value);
    });
    this.own.type = 'button';
    this.own.textContent = '↺';
    this.own.setAttribute('aria-label', `${name}: the robot's own value`);
    this.own.title = "The robot's own value";
    this.own.addEventListener('click', () => change(null));
    this.hint.className = 'hint';
    this.hint.id = `${id}-hint`;
    this.error.className = 'alert';
    this.error.setAttribute('role', 'alert');
    this.element.append(label, this.input, this.own, this.hint, this.error);
    this.update(parameter);
  }

  /** What is being typed stays. */
  update(parameter: Parameter): void {
    this.parameter = parameter;
    const { value, unit, least, most, meaning, waitsFor } = parameter;
    const changed = value !== parameter.default;
    this.element.classList.toggle('changed', changed);
    if (document.activeElement !== this.input) this.refill();
    this.own.hidden = !changed;
    const range = least === null || most === null ? '' : ` ${valueText(least)} to ${valueText(most)}`;
    const units = unit === '' || unit === '1' ? '' : ` ${unit}`;
    const parts = [
      meaning,
      `${range}${range === '' ? '' : units}`.trim(),
      `own: ${valueText(parameter.default)}${units}`,
      waitsFor === null ? '' : (waits[waitsFor] ?? waitsFor),
    ];
    setText(this.hint, parts.filter((part) => part !== '').join(' · '));
    if (typeof value === 'boolean') this.input.checked = value;
  }

  /** The value that counts, in place of what was typed. */
  refill(): void {
    const { value } = this.parameter;
    if (typeof value === 'number') this.input.value = valueText(value);
  }

  complain(lines: readonly string[]): void {
    showLines(this.error, lines);
  }
}
