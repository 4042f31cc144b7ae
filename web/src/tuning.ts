// Parameters and presets as the API tells them.

import { asArray, asNumberOrNull, asString, isObject } from './json';
import type { JsonObject } from './json';

export type ParameterValue = number | boolean;

export interface Parameter {
  /** Group and name: gait.t_ss. */
  readonly name: string;
  readonly type: string;
  readonly unit: string;
  readonly meaning: string;
  readonly default: ParameterValue;
  readonly value: ParameterValue;
  /** next_step or reset; null: it is in effect. */
  readonly waitsFor: string | null;
  readonly least: number | null;
  readonly most: number | null;
}

export interface PresetInfo {
  readonly name: string;
  readonly note: string;
  readonly parameters: Readonly<Record<string, ParameterValue>>;
  readonly strategies: Readonly<Record<string, boolean>>;
}

function asValue(value: unknown): ParameterValue {
  return typeof value === 'boolean' || typeof value === 'number' ? value : Number.NaN;
}

export function parseParameters(value: unknown): Parameter[] {
  return asArray(isObject(value) ? value['items'] : undefined).flatMap((item): Parameter[] => {
    if (!isObject(item)) return [];
    const waits = item['waits_for'];
    return [
      {
        name: asString(item['name']),
        type: asString(item['type']),
        unit: asString(item['unit']),
        meaning: asString(item['meaning']),
        default: asValue(item['default']),
        value: asValue(item['value']),
        waitsFor: typeof waits === 'string' ? waits : null,
        least: asNumberOrNull(item['least']),
        most: asNumberOrNull(item['most']),
      },
    ];
  });
}

export function parsePresets(value: unknown): PresetInfo[] {
  return asArray(isObject(value) ? value['items'] : undefined).flatMap((item): PresetInfo[] => {
    if (!isObject(item)) return [];
    const object = (name: string): JsonObject => {
      const found = item[name];
      return isObject(found) ? found : {};
    };
    return [
      {
        name: asString(item['name']),
        note: asString(item['note']),
        parameters: object('parameters') as Record<string, ParameterValue>,
        strategies: object('strategies') as Record<string, boolean>,
      },
    ];
  });
}

/** What is changed, by name: what a preset keeps. */
export function changedOf(parameters: readonly Parameter[]): Record<string, ParameterValue> {
  const changed = parameters.filter((one) => one.value !== one.default);
  return Object.fromEntries(changed.map(({ name, value }) => [name, value]));
}

/** Whether every word is in the name, the unit or the meaning. */
export function matches({ name, unit, meaning }: Parameter, words: string): boolean {
  const text = `${name} ${unit} ${meaning}`.toLowerCase();
  return words
    .toLowerCase()
    .split(/\s+/)
    .every((word) => text.includes(word));
}

/** A value as people read and type it: 20, not 19.999999999999996. */
export function valueText(value: ParameterValue): string {
  return typeof value === 'boolean' ? (value ? 'on' : 'off') : String(Number(value.toPrecision(9)));
}
