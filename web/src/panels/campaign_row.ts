// One campaign on the list: how far it is, what came of it, and what can be done with it.

import { campaignTitle, canBeShown, isUnderWay, trialCount } from '../campaign';
import type { CampaignInfo } from '../campaign';
import { setText, smallButton } from '../dom';

export interface CampaignActions {
  show(info: CampaignInfo): void;
  compare(info: CampaignInfo): void;
  report(info: CampaignInfo): void;
  cancel(info: CampaignInfo): void;
  resume(info: CampaignInfo): void;
  remove(info: CampaignInfo): void;
}

/** Seconds for people: 40 s, 5 min, 2.5 h. */
export function roughly(seconds: number): string {
  if (seconds < 90) return `${Math.ceil(seconds)} s`;
  if (seconds < 90 * 60) return `${Math.round(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}

export function factsOf(info: CampaignInfo): string {
  const parts = [info.state, trialCount(info)];
  if (info.etaS !== null) parts.push(`about ${roughly(info.etaS)} to go`);
  for (const [count, words] of [
    [info.fell, 'fell'],
    [info.timeout, 'not pushed'],
    [info.invalid, 'invalid'],
  ] as const) {
    if (count > 0) parts.push(`${count} ${words}`);
  }
  if (info.passed === false && info.state === 'done') parts.push('a threshold failed');
  if (info.error !== '') parts.push(info.error);
  return parts.join(' · ');
}

export class CampaignRow {
  readonly element = document.createElement('li');
  private readonly title = document.createElement('strong');
  private readonly facts = document.createElement('span');
  private readonly bar = document.createElement('progress');
  /** Is there another one on the card? */
  private comparable = false;
  private readonly buttons: readonly {
    readonly element: HTMLButtonElement;
    readonly words: string;
    readonly offered: () => boolean;
  }[];

  constructor(
    private info: CampaignInfo,
    actions: CampaignActions,
  ) {
    this.element.dataset['campaign'] = info.id;
    this.facts.className = 'muted';
    const begun = (): boolean => this.info.done > 0;
    const ended = (): boolean => begun() && !isUnderWay(this.info);
    const offer = (
      act: keyof CampaignActions,
      words: string,
      offered: () => boolean,
    ): (typeof this.buttons)[number] => {
      const element = smallButton(words, () => actions[act](this.info));
      element.dataset['act'] = act;
      return { element, words, offered };
    };
    this.buttons = [
      offer('show', 'Show', () => canBeShown(this.info)),
      offer('compare', 'Compare', () => ended() && this.comparable),
      offer('report', 'Report', begun),
      offer('cancel', 'Cancel', () => ['queued', 'running'].includes(this.info.state)),
      offer('resume', 'Resume', () => ['cancelled', 'interrupted'].includes(this.info.state)),
      offer('remove', 'Delete', () => !isUnderWay(this.info)),
    ];
    const row = document.createElement('div');
    row.className = 'actions';
    row.append(...this.buttons.map(({ element }) => element));
    this.element.append(this.title, this.facts, this.bar, row);
    this.update(info, null, null);
  }


  /** `shown` and `other` are the campaigns on the card. */
  update(info: CampaignInfo, shown: string | null, other: string | null): void {
    this.info = info;
    this.comparable = shown !== null && shown !== info.id;
    const title = campaignTitle(info);
    setText(this.title, title);
    setText(this.facts, factsOf(info));
    this.bar.hidden = !isUnderWay(info);
    this.bar.max = Math.max(1, info.total);
    this.bar.value = info.done;
    this.bar.setAttribute('aria-label', `Progress of ${title}`);
    for (const { element, words, offered } of this.buttons) {
      element.hidden = !offered();
      element.setAttribute('aria-label', `${words} ${title}`);
      if (words === 'Show') element.setAttribute('aria-pressed', String(shown === info.id));
      if (words === 'Compare') element.setAttribute('aria-pressed', String(other === info.id));
    }
  }
}
