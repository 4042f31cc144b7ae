// Every parameter of the plant that runs, and presets of them.

import type { Api } from '../api';
import { Problem, linesOf } from '../api';
import { attempt } from '../attempt';
import { byId, keepRows, setText, showLines } from '../dom';
import { Reading } from '../reading';
import type { Store } from '../store';
import { changedOf, matches } from '../tuning';
import type { Parameter, ParameterValue, PresetInfo } from '../tuning';
import { ParameterRow } from './parameter_row';
import { PresetRow } from './preset_row';

export class TuningPanel {
  private readonly panel = byId('tuning-panel', HTMLElement);
  private readonly list = byId('tuning-list', HTMLElement);
  private readonly search = byId('tuning-search', HTMLInputElement);
  private readonly changedOnly = byId('tuning-changed', HTMLInputElement);
  private readonly error = byId('tuning-error', HTMLElement);
  private readonly presetError = byId('preset-error', HTMLElement);
  private readonly rows = new Map<string, ParameterRow>();
  private readonly groups = new Map<string, HTMLDetailsElement>();
  private readonly presetRows = new Map<string, PresetRow>();
  private parameters: readonly Parameter[] = [];
  private presets: readonly PresetInfo[] = [];
  private readonly reading: Reading<[Parameter[], PresetInfo[]]>;

  constructor(
    store: Store,
    private readonly api: Api,
  ) {
    this.reading = new Reading(
      () => Promise.all([api.parameters(), api.presets()]),
      ([parameters, presets]) => {
        this.parameters = parameters;
        this.presets = presets;
        showLines(this.error, []);
        this.show();
      },
      (error) => showLines(this.error, linesOf(error)),
    );
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
    if (!this.panel.hidden) this.reading.refresh();
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
      const row = new ParameterRow(parameter, (value) => this.change(name, value));
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

  /** What was wrong with the value; nothing when it is taken. */
  private async change(name: string, value: ParameterValue | null): Promise<readonly string[]> {
    try {
      await this.api.changeParameters({ [name]: value });
      this.reading.replace();
      return [];
    } catch (error) {
      const own = error instanceof Problem ? error.errors.map(({ detail }) => detail) : [];
      return own.length > 0 ? own : linesOf(error);
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
    await this.act(async () => {
      // As they are now, whatever was changed elsewhere since they were shown.
      const [parameters, { strategies }] = await Promise.all([this.api.parameters(), this.api.simulation()]);
      await this.api.savePreset(name, {
        ...(note === '' ? {} : { note }),
        parameters: changedOf(parameters),
        strategies,
      });
    });
  }

  private async act(run: () => Promise<unknown>): Promise<void> {
    if (await attempt(this.presetError, run)) this.reading.replace();
  }

  private showPresets(): void {
    keepRows(
      byId('presets', HTMLUListElement),
      this.presetRows,
      this.presets.map((preset) => ({ id: preset.name, preset })),
      ({ id }) =>
        new PresetRow(id, {
          use: () => void this.act(() => this.api.applyPreset(id)),
          remove: () => void this.act(() => this.api.deletePreset(id)),
        }),
      (row, { preset }) => row.update(preset),
    );
  }
}
