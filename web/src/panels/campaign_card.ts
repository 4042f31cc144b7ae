// What came of a campaign: push limits over the directions, survival, one trial's own words, and
// another campaign beside it.

import { campaignTitle, compare, extentOf, isPartial, knownLimits, limitCurves } from '../campaign';
import type { CampaignInfo, CampaignTrial, Limit, LimitCurve } from '../campaign';
import { byId, keepRows, setText } from '../dom';
import { trialFromJson, trialLink, trialTitle } from '../trial';
import { drawPolar } from '../views/polar';
import type { PolarCurve } from '../views/polar';
import { CurveRow } from './curve_row';
import { HeatMap } from './heat_map';

export interface CampaignResults {
  readonly info: CampaignInfo;
  readonly trials: readonly CampaignTrial[];
}

function svgById(id: string): SVGSVGElement {
  const element = document.getElementById(id);
  if (!(element instanceof SVGSVGElement)) throw new Error(`index.html has no svg #${id}`);
  return element;
}

function polarCurves({ info, trials }: CampaignResults, muted: boolean): PolarCurve[] {
  return limitCurves(trials).map((curve) => ({ ...curve, muted, partial: isPartial(info) }));
}

export class CampaignCard {
  private readonly card = byId('campaign-card', HTMLElement);
  private readonly heat = new HeatMap(byId('campaign-heat', HTMLTableElement), (trial) =>
    this.choose(trial),
  );
  private readonly curves = byId('campaign-curves', HTMLTableElement);
  private readonly curveRows = new Map<string, CurveRow>();
  private readonly told = byId('campaign-trial', HTMLElement);
  private readonly difference = byId('campaign-difference', HTMLElement);
  private readonly plot = svgById('campaign-polar');
  private shown: CampaignResults | null = null;
  private other: CampaignResults | null = null;
  private chosen: CampaignTrial | null = null;

  constructor(private readonly onClose: () => void) {
    byId('campaign-close', HTMLButtonElement).addEventListener('click', () => this.onClose());
    byId('campaign-replay', HTMLButtonElement).addEventListener('click', () => {
      const spec = this.chosen === null ? null : trialFromJson(this.chosen.spec);
      if (spec !== null) window.location.hash = new URL(trialLink(window.location.href, spec)).hash;
    });
  }

  state(): Record<string, unknown> {
    return {
      shown: this.shown?.info.id ?? null,
      trials: this.shown?.trials.length ?? 0,
      other: this.other?.info.id ?? null,
      curves: this.shown === null ? [] : limitCurves(this.shown.trials).map(this.curveState),
      chosen: this.chosen?.number ?? null,
    };
  }

  show(shown: CampaignResults | null, other: CampaignResults | null): void {
    // The same campaign with more trials keeps the one that was chosen.
    if (shown?.info.id !== this.shown?.info.id) this.choose(null);
    this.shown = shown;
    this.other = other;
    this.card.hidden = shown === null;
    if (shown === null) return;
    setText(byId('campaign-heading', HTMLElement), `Campaign ${campaignTitle(shown.info)}`);
    const curves = polarCurves(shown, false);
    const others = other === null ? [] : polarCurves(other, true);
    drawPolar(this.plot, [...others, ...curves]);
    const open = curves.some(({ limits, partial }) => limits.length > knownLimits(limits, partial).length);
    const hint = open ? ' · hollow marks: nothing has failed there yet' : '';
    setText(byId('campaign-extent', HTMLElement), extentOf(shown.info) + hint);
    this.tellCurves(curves, others);
    this.heat.show(shown.trials);
    this.tellDifference();
  }

  private readonly curveState = ({ series, limits }: LimitCurve): Record<string, unknown> => ({
    series,
    limits: limits.map(({ directionDeg, pass, fail }) => ({ directionDeg, pass, fail })),
  });

  private tellCurves(curves: readonly PolarCurve[], others: readonly PolarCurve[]): void {
    const known = (curve: PolarCurve | undefined): readonly Limit[] =>
      curve === undefined ? [] : knownLimits(curve.limits, curve.partial);
    const body = this.curves.tBodies[0];
    if (body === undefined) return;
    keepRows(
      body,
      this.curveRows,
      curves.map((curve) => ({ id: curve.series, curve })),
      ({ id }) => new CurveRow(id, (trial) => this.choose(trial)),
      (row, { id, curve }) => row.update(known(curve), known(others.find(({ series }) => series === id))),
    );
  }

  private tellDifference(): void {
    const { shown, other } = this;
    this.difference.hidden = shown === null || other === null;
    if (shown === null || other === null) return;
    const { pairs, lost, won } = compare(other.trials, shown.trials);
    const name = campaignTitle(other.info);
    setText(
      this.difference,
      pairs === 0
        ? `No trial of ${name} set the same as one of these.`
        : `Of ${pairs} trials that ${name} has, too, ${lost.length} passed there and not here, ` +
            `${won.length} here and not there. In grey: its limits.`,
    );
  }

  private choose(trial: CampaignTrial | null): void {
    this.chosen = trial;
    this.told.hidden = trial === null;
    if (trial === null) return;
    const spec = trialFromJson(trial.spec);
    const replay = byId('campaign-replay', HTMLButtonElement);
    replay.disabled = spec === null || spec.push === null;
    const reason = trial.reason === '' ? '' : `: ${trial.reason}`;
    setText(
      byId('campaign-trial-text', HTMLElement),
      `Trial ${trial.number} ${trial.outcome}${reason}. ${spec === null ? '' : trialTitle(spec)}`,
    );
  }
}
