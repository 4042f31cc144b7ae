// A run that is laid over another one in the plots.

import type { RingTable } from '../ring';

/** Another run, to be seen at these times plus `shift` [s]. */
export interface Overlay {
  readonly table: RingTable<string>;
  readonly shift: number;
}

/** The other run's numbers at the times of this one; NaN where it has none. */
export function overlaidColumn(
  { table, shift }: Overlay,
  series: string,
  t: Float64Array,
): Float64Array {
  const column = new Float64Array(t.length).fill(Number.NaN);
  if (!table.names.includes(series)) return column;
  const [times, values] = [table.view('t'), table.view(series)];
  const first = times[0] ?? Infinity;
  const last = times[times.length - 1] ?? -Infinity;
  t.forEach((here, i) => {
    const there = here - shift;
    if (there < first || there > last) return;
    const at = table.lowerBound('t', there);
    const [before, after] = [times[at - 1] ?? there, times[at] ?? there];
    const share = after > before ? (there - before) / (after - before) : 1;
    const [from, to] = [values[Math.max(0, at - 1)] ?? NaN, values[at] ?? NaN];
    column[i] = from + share * (to - from);
  });
  return column;
}
