// Pushes, steps and falls as lines across a plot; the same everywhere.

import uPlot from 'uplot';
import type { StreamEvent } from '../protocol';
import type { Theme } from '../theme';

const kinds = new Set(['push_started', 'fall', 'step']);

export function eventsWithin(
  events: readonly StreamEvent[],
  [from, to]: readonly [number, number],
): StreamEvent[] {
  return events.filter(({ kind, t }) => kinds.has(kind) && t >= from && t <= to);
}

export function markerColour(kind: string, theme: Theme): string {
  return kind === 'fall' ? theme.limit : kind === 'step' ? theme.muted : theme.ink;
}

/** `font` [px]: the words beside the lines; null: lines alone. */
export function drawMarkers(
  plot: uPlot,
  events: readonly StreamEvent[],
  theme: Theme,
  font: number | null,
): void {
  const { ctx: c, bbox, scales } = plot;
  const ratio = uPlot.pxRatio;
  const range = [scales['x']?.min ?? 0, scales['x']?.max ?? 0] as const;
  c.save();
  c.beginPath();
  c.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  c.clip();
  for (const { t, kind } of eventsWithin(events, range)) {
    const x = plot.valToPos(t, 'x', true);
    const colour = markerColour(kind, theme);
    c.strokeStyle = colour;
    c.lineWidth = (kind === 'step' ? 1 : 1.6) * ratio;
    c.setLineDash(kind === 'step' ? [2 * ratio, 4 * ratio] : []);
    c.globalAlpha = kind === 'step' ? 0.6 : 0.9;
    c.beginPath();
    c.moveTo(x, bbox.top);
    c.lineTo(x, bbox.top + bbox.height);
    c.stroke();
    if (font !== null && kind !== 'step') {
      c.globalAlpha = 1;
      c.fillStyle = colour;
      c.font = `600 ${font * ratio}px ${theme.font}`;
      c.textAlign = 'left';
      c.textBaseline = 'top';
      // A fall is often close behind its push: its word stands a line lower.
      const row = kind === 'fall' ? 1 : 0;
      const y = bbox.top + (2 + row * (font + 2)) * ratio;
      c.fillText(kind === 'fall' ? 'fall' : 'push', x + 4 * ratio, y);
    }
  }
  c.restore();
}

/** Where a replay stands: a line at `now` while the numbers go on after it. */
export function drawNow(plot: uPlot, now: number, newest: number, theme: Theme): void {
  if (!(now < newest - 1e-6)) return;
  const { ctx: c, bbox } = plot;
  const x = plot.valToPos(now, 'x', true);
  if (x < bbox.left || x > bbox.left + bbox.width) return;
  c.save();
  c.strokeStyle = theme.measured;
  c.lineWidth = 2 * uPlot.pxRatio;
  c.beginPath();
  c.moveTo(x, bbox.top);
  c.lineTo(x, bbox.top + bbox.height);
  c.stroke();
  c.restore();
}
