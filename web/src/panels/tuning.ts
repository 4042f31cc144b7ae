// Every parameter of the plant that runs, and presets of them.

import type { Api } from '../api';
import { Problem, linesOf } from '../api';
import { attempt } from '../attempt';
import { byId, setText, showLines, smallButton } from '../dom';
import type { Store } from '../store';
import { changedOf, matches, valueText } from '../tuning';
import type { Parameter, ParameterValue, PresetInfo } from '../tuning';
import { ParameterRow } from './parameter_row';

export class TuningPanel {
  private readonly panel = byId('tuning-panel', HTMLElement);
  private readonly list = byId('tuning-list', HTMLElement);
  private readonly search = byId('tuning-search', HTMLInputElement);
  private readonly changedOnly = byId('tuning-changed', HTMLInputElement);
  private readonly error = byId('tuning-error', HTMLElement);
  private readonly presetError = byId('preset-error', HTMLElement);
  private readonly rows = new Map<string, ParameterRow>();
  private readonly groups = new Map<string, HTMLDetailsElement>();
  private parameters: readonly Parameter[] = [];
  private presets: readonly PresetInfo[] = [];

  constructor(
    private readonly store: Store,
    private readonly api: Api,
  ) {
    this.search.addEventListener('input', () => this.filter());
    this.changedOnly.addEventListener('change', () => this.filter());
    byId('preset-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      void this.savePreset();
    });
    store.on('hello', () => this.readIfShown());
    store.on('event', () => {
      const kind = store.events[store.events.length - 1]?.kind;
      if (kind === 'parameters' || kind === 'command') this.readIfShown();
    });
    new MutationObserver(() => this.readIfShown()).observe(this.panel, {
      attributes: true,
      attributeFilter: ['hidden'],
    });
  }

  state(): Record<string, unknown> {
    return {
      count: this.parameters.length,
      changed: changedOf(this.parameters),
      presets: this.presets.map(({ name }) => name),
    };
  }

  private readIfShown(): void {
    if (!this.panel.hidden) void this.read();
  }

  private async read(): Promise<void> {
    try {
      const [parameters, presets] = await Promise.all([this.api.parameters(), this.api.presets()]);
      this.parameters = parameters;
      this.presets = presets;
      showLines(this.error, []);
      this.show();
    } catch (error) {
      showLines(this.error, linesOf(error));
    }
  }

  private show(): void {
    const names = this.parameters.map(({ name }) => name);
    if (names.join() !== [...this.rows.keys()].join()) this.build();
    for (const parameter of this.parameters) this.rows.get(parameter.name)?.update(parameter);
    this.filter();
    this.showPresets();
  }

  private build(): void {
    this.rows.clear();
    this.groups.clear();
    for (const parameter of this.parameters) {
      const { name } = parameter;
      const groupName = name.slice(0, name.indexOf('.'));
      let group = this.groups.get(groupName);
      if (group === undefined) {
        group = document.createElement('details');
        const summary = document.createElement('summary');
        summary.textContent = groupName;
        group.append(summary);
        this.groups.set(groupName, group);
      }
      const row = new ParameterRow(parameter, (value) => void this.change(name, value));
      this.rows.set(name, row);
      group.append(row.element);
    }
    this.list.replaceChildren(...this.groups.values());
  }

  /** Groups with something that was searched for are open. */
  private filter(): void {
    const words = this.search.value.trim();
    const { checked } = this.changedOnly;
    let found = 0;
    const inGroups = new Map<string, number>();
    for (const parameter of this.parameters) {
      const { name } = parameter;
      const fits =
        matches(parameter, words) && (!checked || parameter.value !== parameter.default);
      const row = this.rows.get(name);
      if (row !== undefined) row.element.hidden = !fits;
      if (!fits) continue;
      found += 1;
      const group = name.slice(0, name.indexOf('.'));
      inGroups.set(group, (inGroups.get(group) ?? 0) + 1);
    }
    for (const [name, group] of this.groups) {
      const count = inGroups.get(name) ?? 0;
      group.hidden = count === 0;
      if (words !== '' || checked) group.open = count > 0;
    }
    const changed = Object.keys(changedOf(this.parameters)).length;
    setText(
      byId('tuning-count', HTMLElement),
      `${found} of ${this.parameters.length}; ${changed} changed`,
    );
  }

  private async change(name: string, value: ParameterValue | null): Promise<void> {
    const row = this.rows.get(name);
    try {
      await this.api.changeParameters({ [name]: value });
      row?.complain([]);
      await this.read();
      row?.refill();
    } catch (error) {
      const own = error instanceof Problem ? error.errors.map(({ detail }) => detail) : [];
      row?.complain(own.length > 0 ? own : linesOf(error));
    }
  }

  private async savePreset(): Promise<void> {
    const name = byId('preset-name', HTMLInputElement).value.trim();
    if (!/^[a-z0-9][a-z0-9_-]{0,63}$/.test(name)) {
      const words = 'A name has 1 to 64 of a-z, 0-9, - and _, and begins with a letter or a digit.';
      showLines(this.presetError, [words]);
      return;
    }
    const note = byId('preset-note', HTMLInputElement).value.trim();
    await this.act(() =>
      this.api.savePreset(name, {
        ...(note === '' ? {} : { note }),
        parameters: changedOf(this.parameters),
        strategies: this.store.simulation?.strategies ?? {},
      }),
    );
  }

  private async act(run: () => Promise<unknown>): Promise<void> {
    if (await attempt(this.presetError, run)) await this.read();
  }

  private showPresets(): void {
    byId('presets', HTMLUListElement).replaceChildren(
      ...this.presets.map(({ name, note, parameters, strategies }) => {
        const row = document.createElement('li');
        row.dataset['preset'] = name;
        const title = document.createElement('strong');
        title.textContent = name;
        const what = document.createElement('span');
        what.className = 'muted';
        const off = Object.keys(strategies).filter((strategy) => strategies[strategy] === false);
        what.textContent = [
          note,
          ...Object.entries(parameters).map(([key, value]) => `${key} ${valueText(value)}`),
          ...off.map((strategy) => `${strategy} off`),
        ]
          .filter((part) => part !== '')
          .join(' · ');
        const actions = document.createElement('div');
        actions.className = 'actions';
        const button = (text: string, run: () => Promise<unknown>): HTMLButtonElement =>
          smallButton(text, () => void this.act(run), `${text} preset ${name}`);
        actions.append(
          button('Use', () => this.api.applyPreset(name)),
          button('Delete', () => this.api.deletePreset(name)),
        );
        row.append(title, what, actions);
        return row;
      }),
    );
  }
}
