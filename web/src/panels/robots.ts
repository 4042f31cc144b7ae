// Robots: which there are, and one of one's own, looked into before it is used.

import type { Api } from '../api';
import { attempt } from '../attempt';
import { byId, keepRows, setText, showLines } from '../dom';
import { meshPath, robotNameFrom } from '../robot_report';
import type { RobotReport } from '../robot_report';
import type { Store } from '../store';
import { RobotRow } from './robot_row';

interface RobotFiles {
  readonly urdf: File;
  readonly description: File | null;
  readonly meshes: readonly File[];
}

/** The files of a robot among those that were dropped; null: there is no URDF. */
function sorted(files: readonly File[]): RobotFiles | null {
  const urdf = files.find(({ name }) => /\.(urdf|xml)$/i.test(name));
  if (urdf === undefined) return null;
  const description = files.find(({ name }) => /\.json$/i.test(name)) ?? null;
  return { urdf, description, meshes: files.filter((file) => file !== urdf && file !== description) };
}

export class RobotsPanel {
  private readonly list = byId('robot-list', HTMLUListElement);
  private readonly drop = byId('robot-drop', HTMLElement);
  private readonly files = byId('robot-files', HTMLInputElement);
  private readonly name = byId('robot-name', HTMLInputElement);
  private readonly progress = byId('robot-progress', HTMLElement);
  private readonly error = byId('robot-error', HTMLElement);
  private readonly found = byId('robot-report', HTMLElement);
  private chosen: RobotFiles | null = null;
  private report: RobotReport | null = null;
  private readonly rows = new Map<string, RobotRow>();
  /** What was asked for goes one after the other. */
  private turn: Promise<unknown> = Promise.resolve();
  private waiting = 0;

  constructor(
    private readonly store: Store,
    private readonly api: Api,
  ) {
    store.on('robots', () => this.show());
    store.on('hello', () => this.show());
    this.files.addEventListener('change', () => void this.look(Array.from(this.files.files ?? [])));
    this.drop.addEventListener('dragover', (event) => {
      event.preventDefault();
      this.drop.classList.add('over');
    });
    this.drop.addEventListener('dragleave', () => this.drop.classList.remove('over'));
    this.drop.addEventListener('drop', (event) => {
      event.preventDefault();
      this.drop.classList.remove('over');
      void this.look(Array.from(event.dataTransfer?.files ?? []));
    });
    byId('robot-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      void this.upload();
    });
  }

  state(): Record<string, unknown> {
    return {
      listed: this.store.robots.map(({ name }) => name),
      report: this.report,
      busy: this.waiting > 0,
    };
  }

  /** What the server finds in the files; nothing is kept yet. */
  private async look(files: readonly File[]): Promise<void> {
    const chosen = sorted(files);
    this.chosen = chosen;
    this.report = null;
    this.found.hidden = true;
    if (chosen === null) {
      showLines(this.error, ['There is no URDF among these files.']);
      return;
    }
    const { urdf } = chosen;
    await this.act('Looking into it…', async () => {
      const report = await this.api.checkRobot(await this.form(chosen, null));
      if (this.chosen !== chosen) return; // others have been dropped since
      this.report = report;
      const named = this.report.name === '' ? urdf.name : this.report.name;
      this.name.value = robotNameFrom(named);
      this.showReport(this.report);
    });
  }

  private async upload(): Promise<void> {
    const { chosen } = this;
    if (chosen === null) return;
    const name = this.name.value.trim();
    await this.act('Uploading…', async () => {
      await this.api.uploadRobot(await this.form(chosen, name));
      this.store.setRobots(await this.api.robots());
      this.found.hidden = true;
      this.files.value = '';
      await this.api.reset({ robot: name, plant: 'bullet' });
    });
  }

  private async form(files: RobotFiles, name: string | null): Promise<FormData> {
    const form = new FormData();
    const urdf = await files.urdf.text();
    if (name !== null) form.append('name', name);
    form.append('urdf', urdf);
    if (files.description !== null) form.append('description', await files.description.text());
    for (const mesh of files.meshes) {
      const folder = mesh.webkitRelativePath;
      form.append('mesh', mesh, meshPath(urdf, folder === '' ? mesh.name : folder));
    }
    return form;
  }

  private act(words: string, run: () => Promise<unknown>): Promise<void> {
    this.waiting += 1;
    const done = this.turn.then(async () => {
      setText(this.progress, words);
      await attempt(this.error, run);
      this.waiting -= 1;
      if (this.waiting === 0) setText(this.progress, '');
    });
    this.turn = done;
    return done;
  }

  private showReport({ name, facts, quirks }: RobotReport): void {
    this.found.hidden = false;
    setText(byId('robot-found', HTMLElement), `Found in ${name === '' ? 'the files' : name}`);
    byId('robot-facts', HTMLElement).replaceChildren(
      ...facts.map(([term, text]) => {
        const row = document.createElement('div');
        const what = document.createElement('dt');
        what.textContent = term;
        const value = document.createElement('dd');
        value.textContent = text;
        row.append(what, value);
        return row;
      }),
    );
    const lines = quirks.length > 0 ? quirks : ['Nothing odd about the files.'];
    byId('robot-quirks', HTMLElement).replaceChildren(
      ...lines.map((line) => {
        const item = document.createElement('li');
        item.textContent = line;
        return item;
      }),
    );
  }

  private show(): void {
    const here = this.store.hello?.robot;
    keepRows(
      this.list,
      this.rows,
      this.store.robots.map((robot) => ({ id: robot.name, robot })),
      ({ id }) =>
        new RobotRow(id, {
          use: () => void this.act('Use…', () => this.api.reset({ robot: id })),
          remove: () =>
            void this.act('Delete…', async () => {
              await this.api.deleteRobot(id);
              this.store.setRobots(await this.api.robots());
            }),
        }),
      (row, { robot }) => row.update(robot, here),
    );
  }
}
