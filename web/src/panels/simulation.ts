// Pause, resume, step, reset, strategies, and how the simulation is doing.

import type { Api, ResetChoice, SimulationState } from '../api';
import { attempt } from '../attempt';
import { byId, fillSelect, formatNumber, numberIn, setText, showLines } from '../dom';
import type { Keys } from '../keys';
import { Reading } from '../reading';
import type { Store } from '../store';

const pollMs = 1000;

/** The number that each kind of ground is told by; docs/trial.md has the others. */
const terrainFields: Readonly<
  Record<string, { name: string; title: string; unit: string; value: number } | undefined>
> = {
  slope: { name: 'angle_deg', title: 'Angle', unit: '°', value: 5 },
  uneven: { name: 'height_m', title: 'Height', unit: 'm', value: 0.02 },
  platform: { name: 'vx', title: 'Velocity', unit: 'm/s', value: 0.1 },
};

/** Rows of a list of facts, made once and then only rewritten. */
export class Facts {
  private readonly values = new Map<string, HTMLElement>();

  constructor(list: HTMLElement, rows: readonly (readonly [name: string, full?: boolean])[]) {
    for (const [name, full] of rows) {
      const row = document.createElement('div');
      if (full === true) row.className = 'full';
      const term = document.createElement('dt');
      term.textContent = name;
      const value = document.createElement('dd');
      value.textContent = '–';
      row.append(term, value);
      list.append(row);
      this.values.set(name, value);
    }
  }

  set(name: string, text: string): void {
    const value = this.values.get(name);
    if (value !== undefined) setText(value, text === '' ? '–' : text);
  }
}

export class SimulationPanel {
  private readonly pause = byId('pause', HTMLButtonElement);
  private readonly step = byId('step', HTMLButtonElement);
  private readonly robot = byId('robot', HTMLSelectElement);
  private readonly plant = byId('plant', HTMLSelectElement);
  private readonly seed = byId('seed', HTMLInputElement);
  private readonly terrain = byId('terrain', HTMLSelectElement);
  private readonly terrainValue = byId('terrain-value', HTMLInputElement);
  private readonly strategies = byId('strategies', HTMLElement);
  private readonly transportError = byId('transport-error', HTMLElement);
  private readonly error = byId('simulation-error', HTMLElement);
  private readonly breakdown = byId('breakdown', HTMLElement);
  private readonly facts = new Facts(byId('facts', HTMLElement), [
    ['Tick'],
    ['Steps'],
    ['Late ticks'],
    ['Frames dropped'],
    ['Shown behind'],
    ['Watchers'],
    ['Seed'],
    ['Version'],
    ['Greatest DCM error', true],
    ['State hash', true],
    ['Session', true],
  ]);
  private readonly reading: Reading<SimulationState>;
  /** How often the switch of a strategy was used without an answer yet: it stays as the user has put it. */
  private readonly switching = new Map<string, number>();

  constructor(
    private readonly store: Store,
    private readonly api: Api,
    keys: Keys,
  ) {
    const { transportError } = this;
    this.reading = new Reading(
      () => api.simulation(),
      (state) => store.setSimulation(state),
    );
    this.pause.addEventListener('click', () => this.togglePause());
    this.step.addEventListener('click', () => this.advance());
    const reset = (): void => void this.command(transportError, () => this.api.reset({}));
    for (const id of ['reset', 'fall-reset']) {
      byId(id, HTMLButtonElement).addEventListener('click', reset);
    }
    const add = (key: string, text: string, run: () => void): void =>
      keys.add({ key, group: 'Simulation', text, run });
    add(' ', 'Pause and resume', () => this.togglePause());
    add('.', 'Step, when paused', () => this.advance());
    add('r', 'Reset', reset);
    this.terrain.addEventListener('change', () => this.showTerrain(true));
    byId('reset-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      const seed = numberIn(this.seed);
      void this.command(this.error, () =>
        this.api.reset({
          robot: this.robot.value,
          plant: this.plant.value,
          ...(Number.isFinite(seed) ? { seed } : {}),
          ...this.chosenTerrain(),
        }),
      );
    });
    store.on('running', () => this.showRunning());
    store.on('simulation', () => this.show());
    store.on('robots', () => this.showRobots());
    store.on('hello', () => {
      showLines(this.transportError, []);
      showLines(this.error, []);
      this.showRobots();
      this.showChoice();
      this.reading.replace();
    });
    store.on('event', () => {
      const kind = store.events[store.events.length - 1]?.kind;
      if (kind === 'command' || kind === 'fall') this.reading.refresh();
    });
    store.on('condition', () => this.showRunning());
    setInterval(() => {
      if (!document.hidden && store.connection.kind === 'open') this.reading.look();
    }, pollMs);
    this.showRunning();
  }

  /** The page has commanded something: what was asked before it is not shown any more. */
  commanded(): void {
    this.reading.replace();
  }

  private togglePause(): void {
    const running = this.store.running !== false;
    void this.command(this.transportError, async () => {
      await (running ? this.api.pause() : this.api.resume());
      this.store.answerRunning(!running, performance.now());
    });
  }

  private advance(): void {
    if (this.step.disabled) return;
    const ticks = numberIn(byId('step-ticks', HTMLInputElement));
    void this.command(this.transportError, () => this.api.step(ticks));
  }

  /** The ground of the form; nothing when it is the present one, with all that it has. */
  private chosenTerrain(): Pick<ResetChoice, 'terrain'> {
    const { json } = this.store.terrain;
    const kind = this.terrain.value;
    const field = terrainFields[kind];
    const value = numberIn(this.terrainValue);
    if (json['kind'] === kind && (field === undefined || json[field.name] === value)) return {};
    return { terrain: { kind, ...(field === undefined ? {} : { [field.name]: value }) } };
  }

  private showTerrain(chosen: boolean): void {
    const field = terrainFields[this.terrain.value];
    byId('terrain-field', HTMLElement).hidden = field === undefined;
    if (field === undefined) return;
    setText(byId('terrain-label', HTMLElement), field.title);
    setText(byId('terrain-unit', HTMLElement), field.unit);
    const present = this.store.terrain.json[field.name];
    const value = chosen || typeof present !== 'number' ? field.value : present;
    this.terrainValue.value = String(value);
  }

  private async command(where: HTMLElement, send: () => Promise<unknown>): Promise<void> {
    showLines(this.transportError, []);
    showLines(this.error, []);
    await attempt(where, send);
    this.commanded();
  }

  private showRunning(): void {
    const { running, connection } = this.store;
    const away = connection.kind !== 'open';
    setText(this.pause, running === false ? 'Resume' : 'Pause');
    this.pause.disabled = away;
    this.step.disabled = away || running !== false;
    byId('reset', HTMLButtonElement).disabled = away;
  }

  private showRobots(): void {
    const { hello, robots } = this.store;
    const names = robots.map((robot) => robot.name);
    if (hello !== null && !names.includes(hello.robot)) names.unshift(hello.robot);
    fillSelect(this.robot, names, hello?.robot ?? '');
  }

  /** A new session: the form starts from what is there. */
  private showChoice(): void {
    const { hello } = this.store;
    if (hello === null) return;
    this.robot.value = hello.robot;
    this.plant.value = hello.plant;
    this.seed.value = String(hello.seed);
    this.terrain.value = this.store.terrain.kind;
    this.showTerrain(false);
  }

  private show(): void {
    const { simulation } = this.store;
    if (simulation === null) return;
    setText(
      this.breakdown,
      simulation.error === '' ? '' : `The simulation broke down; reset it. ${simulation.error}`,
    );
    this.facts.set('Tick', `${simulation.tick}`);
    this.facts.set('Steps', `${simulation.stepCount}`);
    this.facts.set('Late ticks', `${simulation.lateTicks}`);
    this.facts.set('Greatest DCM error', `${formatNumber(simulation.worstDcmErrorM, 3)} m`);
    this.facts.set('Frames dropped', `${this.store.framesDropped}`);
    this.facts.set('Shown behind', `${formatNumber(this.store.behindMs, 0)} ms`);
    this.facts.set('Watchers', `${simulation.clients}`);
    this.facts.set('Seed', `${simulation.seed}`);
    this.facts.set('Version', simulation.version);
    this.facts.set('State hash', simulation.stateHash);
    this.facts.set('Session', simulation.sessionId);
    this.showStrategies(simulation.strategies);
  }

  private showStrategies(strategies: Readonly<Record<string, boolean>>): void {
    const names = Object.keys(strategies);
    const shown = Array.from(
      this.strategies.querySelectorAll('input'),
      (input) => input.dataset['strategy'],
    );
    if (shown.join() !== names.join()) {
      this.strategies.replaceChildren(...names.map((name) => this.strategySwitch(name)));
    }
    for (const input of this.strategies.querySelectorAll('input')) {
      const name = input.dataset['strategy'] ?? '';
      const on = strategies[name];
      if (on !== undefined && (this.switching.get(name) ?? 0) === 0) input.checked = on;
    }
  }

  private strategySwitch(name: string): HTMLLabelElement {
    const label = document.createElement('label');
    label.className = 'check';
    const input = document.createElement('input');
    input.type = 'checkbox';
    input.setAttribute('role', 'switch');
    input.id = `strategy-${name}`;
    input.dataset['strategy'] = name;
    label.htmlFor = input.id;
    label.append(input, name);
    input.addEventListener('change', () => {
      const on = input.checked;
      const { switching } = this;
      switching.set(name, (switching.get(name) ?? 0) + 1);
      void this.command(byId('strategies-error', HTMLElement), () =>
        this.api.setStrategies({ [name]: on }),
      ).then(() => switching.set(name, (switching.get(name) ?? 1) - 1));
    });
    return label;
  }
}
