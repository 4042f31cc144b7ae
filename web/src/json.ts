// Reading of untyped JSON: each helper answers undefined or a default when the value is not what it
// should be, so that nothing unchecked gets further than the parser.

export type JsonObject = Readonly<Record<string, unknown>>;

export function isObject(value: unknown): value is JsonObject {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

export function asString(value: unknown, fallback = ''): string {
  return typeof value === 'string' ? value : fallback;
}

export function asNumber(value: unknown, fallback = 0): number {
  return typeof value === 'number' && Number.isFinite(value) ? value : fallback;
}

export function asNumberOrNull(value: unknown): number | null {
  return typeof value === 'number' && Number.isFinite(value) ? value : null;
}

export function asBoolean(value: unknown, fallback = false): boolean {
  return typeof value === 'boolean' ? value : fallback;
}

export function asArray(value: unknown): readonly unknown[] {
  return Array.isArray(value) ? value : [];
}

export function asNumbers(value: unknown): number[] {
  return asArray(value).filter((item): item is number => typeof item === 'number');
}

/** The fields that are true or false. */
export function asBooleans(value: unknown): Record<string, boolean> {
  const fields = Object.entries(isObject(value) ? value : {});
  return Object.fromEntries(
    fields.filter((field): field is [string, boolean] => typeof field[1] === 'boolean'),
  );
}

/** Names from a list of strings or of objects with a `name`. */
export function asNames(value: unknown): string[] {
  return asArray(value)
    .map((item) => (isObject(item) ? asString(item['name']) : asString(item)))
    .filter((name) => name !== '');
}

/** The parsed text, or undefined when it is not JSON. */
export function parseJson(text: string): unknown {
  try {
    return JSON.parse(text) as unknown;
  } catch {
    return undefined;
  }
}
