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
  /** The user has put in something that the server has not taken yet: it stays. */
  private edited = false;

  /** `change`: null is the robot's own value; what was wrong with the value comes back. */
  constructor(
    private parameter: Parameter,
    private readonly change: (value: ParameterValue | null) => Promise<readonly string[]>,
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
    this.input.addEventListener('input', () => (this.edited = true));
    this.input.addEventListener('blur', () => (this.edited = false));
    this.input.addEventListener('change', () => {
      const value = this.entered;
      if (typeof value === 'number' && !Number.isFinite(value)) this.complain(['is not a number']);
      else void this.send(value);
    });
    this.own.type = 'button';
    this.own.textContent = '↺';
    this.own.setAttribute('aria-label', `${name}: the robot's own value`);
    this.own.title = "The robot's own value";
    this.own.addEventListener('click', () => void this.send(null));
    this.hint.className = 'hint';
    this.hint.id = `${id}-hint`;
    this.error.className = 'alert';
    this.error.setAttribute('role', 'alert');
    this.element.append(label, this.input, this.own, this.hint, this.error);
    this.update(parameter);
  }

  update(parameter: Parameter): void {
    this.parameter = parameter;
    const { value, unit, least, most, meaning, waitsFor } = parameter;
    const changed = value !== parameter.default;
    this.element.classList.toggle('changed', changed);
    if (!this.edited) this.show(value);
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
  }

  private get entered(): ParameterValue {
    return this.parameter.type === 'boolean' ? this.input.checked : numberIn(this.input);
  }

  private show(value: ParameterValue): void {
    if (typeof value === 'boolean') this.input.checked = value;
    else this.input.value = valueText(value);
  }

  /** A value that is taken is shown as the server tells it, unless there is another one by then. */
  private async send(value: ParameterValue | null): Promise<void> {
    const before = this.entered;
    const wrong = await this.change(value);
    this.complain(wrong);
    if (wrong.length === 0 && Object.is(before, this.entered)) this.edited = false;
  }

  private complain(lines: readonly string[]): void {
    showLines(this.error, lines);
  }
}
