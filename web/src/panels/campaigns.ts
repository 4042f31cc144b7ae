// Campaigns: one made by a form or as a specification, the list with how far they are, and what came
// of them beside the live views.

import type { Api } from '../api';
import { attempt } from '../attempt';
import { campaignSpec, isUnderWay, newsOf, numbersFrom, parseTrials } from '../campaign';
import type { CampaignChoice, CampaignInfo } from '../campaign';
import { byId, fillSelect, keepRows, numberIn, showLines } from '../dom';
import { download } from '../export';
import { parseJson } from '../json';
import { Reading } from '../reading';
import type { Store } from '../store';
import { CampaignCard } from './campaign_card';
import type { CampaignResults } from './campaign_card';
import { CampaignRow } from './campaign_row';

const periodMs = 1000;
/** How often the results of a campaign under way are read again, at the most [ms]. */
const refreshMs = 2000;
/** Share of the time that this may take: large results are read less often. */
const refreshShare = 0.1;

const input = (id: string): HTMLInputElement => byId(`campaign-${id}`, HTMLInputElement);

export class CampaignsPanel {
  private readonly panel = byId('campaigns-panel', HTMLElement);
  private readonly list = byId('campaigns', HTMLUListElement);
  private readonly error = byId('campaigns-error', HTMLElement);
  private readonly text = byId('campaign-spec', HTMLTextAreaElement);
  private readonly rows = new Map<string, CampaignRow>();
  private readonly card = new CampaignCard(() => this.show(null, null));
  private items: readonly CampaignInfo[] = [];
  private readonly reading: Reading<CampaignInfo[]>;
  private shown: CampaignResults | null = null;
  private other: CampaignResults | null = null;
  private refreshing = false;
  /** Counts what was asked to be shown: only the last of it is, however long it takes. */
  private chosen = 0;
  /** When the results may be read again [ms]. */
  private nextRefresh = 0;

  constructor(
    private readonly store: Store,
    private readonly api: Api,
  ) {
    this.reading = new Reading(
      () => api.campaigns(),
      (items) => {
        this.items = items;
        this.showList();
        void this.refresh();
      },
    );
    byId('campaign-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      const choice = this.choice();
      if (choice !== null) this.start(campaignSpec(choice));
    });
    byId('campaign-write', HTMLButtonElement).addEventListener('click', () => {
      const choice = this.choice();
      if (choice !== null) this.text.value = JSON.stringify(campaignSpec(choice), null, 2);
    });
    byId('campaign-start-spec', HTMLButtonElement).addEventListener('click', () => {
      const spec = parseJson(this.text.value);
      if (spec === undefined) showLines(this.error, ['The specification is not JSON.']);
      else this.start(spec);
    });
    store.on('robots', () => this.showRobots());
    store.on('connection', () => this.reading.refresh());
    setInterval(() => {
      const waiting = !this.panel.hidden || this.items.some(isUnderWay);
      if (waiting && !document.hidden) this.reading.look();
    }, periodMs);
    new MutationObserver(() => {
      if (!this.panel.hidden) this.reading.look();
    }).observe(this.panel, { attributes: true, attributeFilter: ['hidden'] });
  }

  state(): Record<string, unknown> {
    return {
      listed: this.items.map(({ id, name, state, done, total }) => ({ id, name, state, done, total })),
      ...this.card.state(),
    };
  }

  private showRobots(): void {
    const select = byId('campaign-robot', HTMLSelectElement);
    fillSelect(select, this.store.robots.map(({ name }) => name), this.store.hello?.robot ?? '');
  }

  /** What the form asks, or null after a word about what it lacks. */
  private choice(): CampaignChoice | null {
    const phases = numbersFrom(input('phases').value);
    const choice = {
      name: input('name').value.trim(),
      robot: byId('campaign-robot', HTMLSelectElement).value,
      plant: byId('campaign-plant', HTMLSelectElement).value,
      kind: byId('campaign-kind', HTMLSelectElement).value === 'grid' ? 'grid' : 'bisect',
      directions: numberIn(input('directions')),
      phases: phases ?? [],
      durationS: numberIn(input('duration')),
      from: numberIn(input('from')),
      to: numberIn(input('to')),
      step: numberIn(input('step')),
      repeats: numberIn(input('repeats')),
    } as const;
    const lacking = [
      ...(choice.name === '' ? ['The campaign needs a name.'] : []),
      ...(phases === null ? ['Moments of the step are numbers between commas: 0.1, 0.5.'] : []),
      ...(['directions', 'durationS', 'from', 'to', 'step', 'repeats'] as const).flatMap((field) =>
        choice[field] > 0 ? [] : [`${field === 'durationS' ? 'duration' : field} has to be above 0.`],
      ),
    ];
    showLines(this.error, lacking);
    return lacking.length === 0 ? choice : null;
  }

  private start(spec: unknown): void {
    void this.act(() => this.api.startCampaign(spec));
  }

  private async act(run: () => Promise<unknown>): Promise<void> {
    if (await attempt(this.error, run)) this.reading.replace();
  }

  /** Brings the card up to what the list says: the results are read only when there are more. */
  private async refresh(): Promise<void> {
    const { shown } = this;
    const info = this.items.find(({ id }) => id === shown?.info.id);
    if (shown === null || info === undefined || this.refreshing) return;
    const news = newsOf(shown.info, info);
    if (news === 'state') this.show({ ...shown, info }, this.other);
    if (news !== 'trials' || (isUnderWay(info) && performance.now() < this.nextRefresh)) return;
    this.refreshing = true;
    try {
      const results = await this.load(info);
      // Meanwhile somebody may have chosen another one.
      if (this.shown === shown) this.show(results, this.other);
    } catch {
      // Nobody has asked for it just now: the card stays as it was, and it is tried again.
    } finally {
      this.refreshing = false;
    }
  }

  private showList(): void {
    keepRows(
      this.list,
      this.rows,
      this.items,
      (info) => this.makeRow(info),
      (row, info) => row.update(info, this.shown?.info.id ?? null, this.other?.info.id ?? null),
    );
    byId('campaigns-empty', HTMLElement).hidden = this.items.length > 0;
  }

  private makeRow(first: CampaignInfo): CampaignRow {
    return new CampaignRow(first, {
      show: (info) => void this.choose(info, (results) => this.show(results, null)),
      compare: (info) => {
        if (this.other?.info.id === info.id) this.show(this.shown, null);
        else void this.choose(info, (results) => this.show(this.shown, results));
      },
      report: (info) =>
        void this.act(async () => {
          const page = await this.api.campaignResults(info.id, 'html');
          download(`${info.name}.html`, new Blob([page], { type: 'text/html' }));
        }),
      cancel: (info) => void this.act(() => this.api.cancelCampaign(info.id)),
      resume: (info) => void this.act(() => this.api.resumeCampaign(info.id)),
      remove: (info) =>
        void this.act(async () => {
          await this.api.deleteCampaign(info.id);
          if (this.shown?.info.id === info.id) this.show(null, null);
          else if (this.other?.info.id === info.id) this.show(this.shown, null);
        }),
    });
  }

  private async choose(info: CampaignInfo, show: (results: CampaignResults) => void): Promise<void> {
    this.chosen += 1;
    const { chosen } = this;
    await this.act(async () => {
      const results = await this.load(info);
      if (chosen === this.chosen) show(results);
    });
  }

  private async load(info: CampaignInfo): Promise<CampaignResults> {
    const begun = performance.now();
    const trials = parseTrials(await this.api.campaignResults(info.id, 'ndjson'));
    const now = performance.now();
    this.nextRefresh = now + Math.max(refreshMs, (now - begun) / refreshShare);
    return { info, trials };
  }

  private show(shown: CampaignResults | null, other: CampaignResults | null): void {
    this.shown = shown;
    this.other = other;
    this.card.show(shown, other);
    this.showList();
  }
}
