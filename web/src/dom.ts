// Small helpers around the page's elements and the numbers in them.

/** The element with this id; a page without it is a mistake in index.html. */
export function byId<T extends Element>(id: string, type: abstract new (...args: never[]) => T): T {
  const element = document.getElementById(id);
  if (!(element instanceof type)) throw new Error(`index.html has no ${type.name} #${id}`);
  return element;
}

/** Sets the text only when it differs: leaves selections and screen readers alone. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** A fixed number of digits, a real minus sign, and a dash where there is no number. */
export function formatNumber(value: number | undefined, digits: number): string {
  if (value === undefined || !Number.isFinite(value)) return '–';
  const text = value.toFixed(digits);
  return (Number(text) === 0 ? text.replace('-', '') : text).replace('-', '−');
}

/** At most so many digits, without zeros at the end: for what people have typed. */
export function formatShort(value: number, digits: number): string {
  return Number.isFinite(value)
    ? formatNumber(value, digits)
        .replace(/(\.\d*?)0+$/, '$1')
        .replace(/\.$/, '')
    : '–';
}

/** A server's time in the reader's own; as it is when it cannot be read. */
export function localTime(iso: string): string {
  const when = new Date(iso);
  return Number.isNaN(when.getTime())
    ? iso
    : when.toLocaleString([], { dateStyle: 'short', timeStyle: 'medium' });
}

/** A value of a number field; NaN when it is empty or not a number. */
export function numberIn(input: HTMLInputElement): number {
  return input.value.trim() === '' ? Number.NaN : input.valueAsNumber;
}

/** A small button of a list; `label` tells which row it is of, where its text does not. */
export function smallButton(text: string, run: () => void, label?: string): HTMLButtonElement {
  const made = document.createElement('button');
  made.type = 'button';
  made.className = 'small';
  made.textContent = text;
  if (label !== undefined) made.setAttribute('aria-label', label);
  made.addEventListener('click', run);
  return made;
}

/** Shows what went wrong, or nothing. */
export function showLines(element: HTMLElement, lines: readonly string[]): void {
  element.replaceChildren(
    ...lines.map((line) => {
      const row = document.createElement('span');
      row.textContent = line;
      return row;
    }),
  );
}

/** Fills a select, keeping its value where that is still offered. */
export function fillSelect(
  select: HTMLSelectElement,
  values: readonly string[],
  preferred: string,
): void {
  const present = Array.from(select.options, (option) => option.value);
  const same = present.length === values.length && present.every((value, i) => value === values[i]);
  if (!same) {
    const before = select.value;
    select.replaceChildren(...values.map((value) => new Option(value, value)));
    if (values.includes(before)) select.value = before;
    else if (values.includes(preferred)) select.value = preferred;
  }
}

/** Keeps a row for each item on a list, in their order: rows stay, and with them what is typed there.
 * `before`: children of the list that come before the rows. */
export function keepRows<Item extends { readonly id: string }, Row extends { readonly element: HTMLElement }>(
  list: HTMLElement,
  rows: Map<string, Row>,
  items: readonly Item[],
  make: (item: Item) => Row,
  update: (row: Row, item: Item) => void,
  before = 0,
): void {
  const listed = new Set(items.map(({ id }) => id));
  for (const [id, row] of rows) {
    if (listed.has(id)) continue;
    row.element.remove();
    rows.delete(id);
  }
  items.forEach((item, i) => {
    let row = rows.get(item.id);
    if (row === undefined) {
      row = make(item);
      rows.set(item.id, row);
    }
    update(row, item);
    const there = list.children[before + i];
    if (there !== row.element) list.insertBefore(row.element, there ?? null);
  });
}
