// One recording on the list: what it is, and what can be done with it.

import { formatNumber, localTime, setText, smallButton } from '../dom';
import type { RecordingInfo } from '../recording';
import { tagsFrom } from '../recording';

export interface RunActions {
  replay(info: RecordingInfo): void;
  layOver(info: RecordingInfo): void;
  stop(info: RecordingInfo): void;
  remove(info: RecordingInfo): void;
  change(
    info: RecordingInfo,
    change: { note?: string; tags?: readonly string[]; protected?: boolean },
  ): void;
}

function field(text: string, id: string, input: HTMLInputElement): HTMLLabelElement {
  const label = document.createElement('label');
  input.id = id;
  label.htmlFor = id;
  label.append(text, input);
  return label;
}

export function runTitle({ created, robot, plant }: RecordingInfo): string {
  return `${localTime(created)}, ${robot}${plant === 'lipm' ? ', pendulum' : ''}`;
}

function factsOf(info: RecordingInfo): string {
  const parts = [info.state === 'done' ? `${formatNumber(info.durationS, 1)} s` : info.state];
  const several = (count: number, one: string, many: string): void => {
    if (count > 0) parts.push(`${count} ${count === 1 ? one : many}`);
  };
  several(info.pushes, 'push', 'pushes');
  several(info.falls, 'fall', 'falls');
  if (info.reason !== 'manual') parts.push(`begun by a ${info.reason}`);
  if (info.kept) parts.push('kept');
  if (info.tags.length > 0) parts.push(info.tags.map((tag) => `#${tag}`).join(' '));
  if (info.error !== '') parts.push(info.error);
  return parts.join(' · ');
}

export class RunRow {
  readonly element = document.createElement('li');
  private readonly title = document.createElement('strong');
  private readonly facts = document.createElement('span');
  private readonly note = document.createElement('span');
  private readonly replay: HTMLButtonElement;
  private readonly over: HTMLButtonElement;
  private readonly stop: HTMLButtonElement;
  private readonly noteInput = document.createElement('input');
  private readonly tagsInput = document.createElement('input');
  private readonly keep = document.createElement('input');
  private readonly more = document.createElement('details');

  constructor(
    private info: RecordingInfo,
    actions: RunActions,
  ) {
    const { id } = info;
    this.element.dataset['run'] = id;
    this.replay = smallButton('Replay', () => actions.replay(this.info));
    this.over = smallButton('Lay over', () => actions.layOver(this.info));
    this.stop = smallButton('Stop', () => actions.stop(this.info));
    this.replay.dataset['act'] = 'replay';
    this.over.dataset['act'] = 'over';
    this.stop.dataset['act'] = 'stop';
    this.facts.className = 'muted';
    const buttons = document.createElement('div');
    buttons.className = 'actions';
    buttons.append(this.replay, this.over, this.stop);
    const summary = document.createElement('summary');
    summary.textContent = 'Note, tags, delete';
    this.keep.type = 'checkbox';
    const keep = field('', `keep-${id}`, this.keep);
    keep.className = 'check';
    keep.append('Keep: never deleted for its room');
    const save = smallButton('Save', () =>
      actions.change(this.info, {
        note: this.noteInput.value,
        tags: tagsFrom(this.tagsInput.value),
        protected: this.keep.checked,
      }),
    );
    save.dataset['act'] = 'save';
    const remove = smallButton('Delete', () => actions.remove(this.info));
    remove.dataset['act'] = 'delete';
    const last = document.createElement('div');
    last.className = 'actions';
    last.append(save, remove);
    this.more.append(
      summary,
      field('Note', `note-${id}`, this.noteInput),
      field('Tags, after commas', `tags-${id}`, this.tagsInput),
      keep,
      last,
    );
    this.element.append(this.title, this.facts, this.note, buttons, this.more);
    this.fill();
    this.update(info, null, null);
  }

  /** What is typed and not saved yet stays. */
  update(info: RecordingInfo, replayed: string | null, over: string | null): void {
    const changed =
      info.note !== this.info.note ||
      info.tags.join() !== this.info.tags.join() ||
      info.kept !== this.info.kept;
    this.info = info;
    if (changed) this.fill();
    setText(this.title, runTitle(info));
    setText(this.facts, factsOf(info));
    setText(this.note, info.note);
    this.note.hidden = info.note === '';
    const done = info.state === 'done';
    this.replay.disabled = !done;
    this.over.hidden = replayed === null || replayed === info.id;
    this.over.disabled = !done;
    this.over.setAttribute('aria-pressed', String(over === info.id));
    this.replay.setAttribute('aria-pressed', String(replayed === info.id));
    this.stop.hidden = done;
    for (const [made, words] of [
      [this.replay, 'Replay'],
      [this.over, 'Lay over'],
      [this.stop, 'Stop'],
    ] as const) {
      made.setAttribute('aria-label', `${words} ${runTitle(info)}`);
    }
  }

  private fill(): void {
    this.noteInput.value = this.info.note;
    this.tagsInput.value = this.info.tags.join(', ');
    this.keep.checked = this.info.kept;
  }
}
