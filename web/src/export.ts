// What the plots show, as files: a table of numbers and a picture.

import type { RingTable } from './ring';
import type { Theme } from './theme';
import type { PlotSpec } from './views/plot_specs';

/** All columns between two times as CSV (RFC 4180); a missing number is an empty cell. */
export function csvOf(table: RingTable<string>, [from, to]: readonly [number, number]): string {
  const first = table.lowerBound('t', from);
  const last = table.lowerBound('t', to + 1e-9);
  const columns = table.names.map((name) => table.view(name, first, last));
  const rows = [table.names.join(',')];
  for (let i = 0; i < last - first; i += 1) {
    rows.push(
      columns
        .map((column) => {
          const value = column[i] ?? Number.NaN;
          return Number.isFinite(value) ? String(value) : '';
        })
        .join(','),
    );
  }
  return `${rows.join('\r\n')}\r\n`;
}

/** The plots one below the other with their titles, on the page's background. */
export async function pictureOf(
  plots: readonly { spec: PlotSpec; canvas: HTMLCanvasElement }[],
  heading: string,
  theme: Theme,
): Promise<Blob> {
  const ratio = window.devicePixelRatio || 1;
  const line = Math.round(22 * ratio);
  const gap = Math.round(12 * ratio);
  const width = Math.max(1, ...plots.map(({ canvas }) => canvas.width)) + 2 * gap;
  const height =
    plots.reduce((sum, { canvas }) => sum + canvas.height + line, line + gap) + 2 * gap;
  const sheet = document.createElement('canvas');
  sheet.width = width;
  sheet.height = height;
  const c = sheet.getContext('2d');
  if (c === null) throw new Error('this browser has no 2D canvas');
  c.fillStyle = theme.surface;
  c.fillRect(0, 0, width, height);
  c.fillStyle = theme.ink;
  c.textBaseline = 'top';
  c.font = `600 ${Math.round(14 * ratio)}px ${theme.font}`;
  c.fillText(heading, gap, gap);
  let y = gap + line + gap / 2;
  c.font = `${Math.round(12 * ratio)}px ${theme.font}`;
  for (const { spec, canvas } of plots) {
    c.fillStyle = theme.ink;
    c.fillText(`${spec.title} [${spec.unit}]`, gap, y);
    c.drawImage(canvas, gap, y + line);
    y += line + canvas.height;
  }
  return new Promise((resolve, reject) => {
    sheet.toBlob((blob) => {
      if (blob === null) reject(new Error('the picture could not be made'));
      else resolve(blob);
    }, 'image/png');
  });
}

export function download(name: string, blob: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
