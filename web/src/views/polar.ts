// Push limits over the directions, as a polar plot: forward is up, left is left, as from above.

import { knownLimits } from '../campaign';
import type { Limit, LimitCurve } from '../campaign';
import { formatNumber } from '../dom';

const size = 320;
const middle = size / 2;
const outer = 128;
const namespace = 'http://www.w3.org/2000/svg';

/** Dashes tell the curves apart where colours cannot. */
const dashes = ['', '7 3', '2 3', '9 3 2 3'];

export interface PolarCurve extends LimitCurve {
  /** Of the other campaign, in grey. */
  readonly muted: boolean;
  /** Trials are missing: the line leads over known limits alone, the others have hollow marks. */
  readonly partial: boolean;
}

function make(name: string, attributes: Readonly<Record<string, string | number>>): SVGElement {
  const element = document.createElementNS(namespace, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  return element;
}

function text(words: string, x: number, y: number, anchor: string): SVGElement {
  const element = make('text', { x, y, 'text-anchor': anchor });
  element.textContent = words;
  return element;
}

/** A round number of Fr for the rings: five at most. */
export function ringStep(most: number): number {
  for (const step of [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1]) {
    if (most / step <= 5) return step;
  }
  return Math.max(1, Math.ceil(most / 5));
}

/** Where a value in a direction lies [px]. */
export function polarPlace(directionDeg: number, share: number): readonly [number, number] {
  const angle = (directionDeg * Math.PI) / 180;
  return [middle - outer * share * Math.sin(angle), middle - outer * share * Math.cos(angle)];
}

/** From each direction to the next one round the circle [deg]; of one alone it is the circle. */
function gapsOf(directionsDeg: readonly number[]): number[] {
  return directionsDeg.map((direction, i) => {
    const next = directionsDeg[(i + 1) % directionsDeg.length] ?? direction;
    return (next - direction + 360) % 360 || 360;
  });
}

/** A line round through places in these directions, ascending. A partial one leaves out gaps that are
 * wider than usual. */
export function linePath(
  places: readonly { readonly directionDeg: number; readonly share: number }[],
  partial: boolean,
): string {
  if (places.length < 2) return '';
  const gaps = gapsOf(places.map(({ directionDeg }) => directionDeg));
  const widest = partial ? 1.5 * Math.min(...gaps) : 360;
  const at = places.map(({ directionDeg, share }) =>
    polarPlace(directionDeg, share).map((value) => value.toFixed(1)).join(' '),
  );
  const joined = gaps.map((gap) => gap <= widest);
  if (joined.every(Boolean)) return `M${at.join('L')}Z`;
  const line = at.map((place, i) => `${joined[i - 1] === true ? 'L' : 'M'}${place}`).join('');
  return joined.at(-1) === true ? `${line}L${at[0] ?? ''}` : line;
}

function path(
  { limits, partial }: PolarCurve,
  shareOf: (limit: Limit) => number | null,
): string {
  const places = knownLimits(limits, partial).flatMap((limit) => {
    const share = shareOf(limit);
    return share === null ? [] : [{ directionDeg: limit.directionDeg, share }];
  });
  return linePath(places, partial);
}

/** Draws into the svg anew. */
export function drawPolar(svg: SVGSVGElement, curves: readonly PolarCurve[]): void {
  const own = curves.filter(({ muted }) => !muted);
  const values = curves.flatMap(({ limits }) => limits.map(({ pass }) => pass ?? 0));
  const most = Math.max(0.05, ...values);
  const step = ringStep(most);
  const top = step * Math.ceil(most / step - 1e-9);
  svg.setAttribute('viewBox', `0 0 ${size} ${size}`);
  const parts: SVGElement[] = [];
  for (let ring = step; ring < top + step / 2; ring += step) {
    const radius = (outer * ring) / top;
    parts.push(make('circle', { class: 'ring', cx: middle, cy: middle, r: radius.toFixed(1) }));
    const words = ring + step / 2 > top ? `Fr ${formatNumber(ring, 2)}` : formatNumber(ring, 2);
    parts.push(text(words, middle + 3, middle - radius - 3, 'start'));
  }
  for (const direction of [0, 90, 180, 270]) {
    const [x, y] = polarPlace(direction, 1);
    parts.push(make('line', { class: 'ring', x1: middle, y1: middle, x2: x, y2: y }));
  }
  parts.push(
    text('forward', middle - 3, middle - outer - 14, 'end'),
    text('left', 2, middle - 4, 'start'),
    text('right', size - 2, middle - 4, 'end'),
    text('backward', middle, size - 8, 'middle'),
  );
  for (const curve of own.slice(0, 1)) {
    // The pendulum's ceiling is that of the first curve, as far as it lies inside the plot.
    const inside = make('clipPath', { id: 'polar-inside' });
    inside.append(make('circle', { cx: middle, cy: middle, r: outer }));
    const ceiling = path(curve, (limit) => (limit.ceiling === null ? null : limit.ceiling / top));
    const clipped = { class: 'ceiling', d: ceiling, 'clip-path': 'url(#polar-inside)' };
    parts.push(inside, make('path', clipped));
  }
  const count = { muted: 0, own: 0 };
  for (const curve of curves) {
    const { limits, muted } = curve;
    const dash = dashes[(muted ? count.muted++ : count.own++) % dashes.length] ?? '';
    const line = make('path', {
      class: muted ? 'curve muted' : 'curve',
      d: path(curve, ({ pass }) => (pass ?? 0) / top),
      'stroke-dasharray': dash,
    });
    parts.push(line);
    const known = knownLimits(limits, curve.partial);
    for (const limit of muted ? [] : limits) {
      const [x, y] = polarPlace(limit.directionDeg, (limit.pass ?? 0) / top);
      const mark = known.includes(limit) ? 'mark' : 'mark open';
      parts.push(make('circle', { class: mark, cx: x.toFixed(1), cy: y.toFixed(1), r: 2.5 }));
    }
  }
  svg.replaceChildren(...parts);
}
