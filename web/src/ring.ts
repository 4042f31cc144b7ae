// The last rows of a few columns of numbers, in memory that never grows.

/**
 * Each column is written twice, `capacity` apart, so that any run of rows is one contiguous piece
 * that a plot can take without a copy.
 */
export class RingTable<Name extends string> {
  private readonly columns: ReadonlyMap<Name, Float64Array>;
  private head = 0;
  private count = 0;

  constructor(
    readonly names: readonly Name[],
    readonly capacity: number,
  ) {
    if (!Number.isInteger(capacity) || capacity < 1) {
      throw new RangeError(`capacity is ${capacity}; allowed: whole numbers from 1`);
    }
    this.columns = new Map(names.map((name) => [name, new Float64Array(2 * capacity)]));
  }

  /** Rows held now. */
  get length(): number {
    return this.count;
  }

  /** Appends one row; the oldest one goes when the table is full. A missing value is NaN. */
  push(row: Readonly<Partial<Record<Name, number>>>): void {
    for (const [name, column] of this.columns) {
      const value = row[name] ?? Number.NaN;
      column[this.head] = value;
      column[this.head + this.capacity] = value;
    }
    this.head = (this.head + 1) % this.capacity;
    this.count = Math.min(this.count + 1, this.capacity);
  }

  clear(): void {
    this.head = 0;
    this.count = 0;
  }

  /** Rows `from` (0 is the oldest) up to `to`, no copy: valid until the ring comes round. */
  view(name: Name, from = 0, to = this.count): Float64Array {
    const column = this.column(name);
    const start = this.start();
    const first = Math.min(Math.max(from, 0), this.count);
    return column.subarray(start + first, start + Math.min(Math.max(to, first), this.count));
  }

  /** The rows held now in a table of their own. */
  copy(): RingTable<Name> {
    const copy = new RingTable(this.names, Math.max(1, this.count));
    for (const [name, column] of copy.columns) {
      const values = this.view(name);
      column.set(values);
      column.set(values, copy.capacity);
    }
    copy.count = this.count;
    return copy;
  }

  /** The newest value, or undefined. */
  last(name: Name): number | undefined {
    return this.count === 0 ? undefined : this.column(name)[this.start() + this.count - 1];
  }

  /** First row whose value in a rising column is not below `value`. */
  lowerBound(name: Name, value: number): number {
    const values = this.view(name);
    let low = 0;
    let high = values.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((values[middle] ?? Infinity) < value) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  private start(): number {
    return (this.head - this.count + this.capacity) % this.capacity;
  }

  private column(name: Name): Float64Array {
    const column = this.columns.get(name);
    if (column === undefined) throw new RangeError(`there is no column ${name}`);
    return column;
  }
}
