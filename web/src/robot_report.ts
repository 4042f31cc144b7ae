// What the server has found in the files of a robot, in words.

import { formatNumber } from './dom';
import { asArray, asNumber, asString, isObject } from './json';
import type { JsonObject } from './json';

export interface RobotReport {
  readonly name: string;
  /** Rows of a list of facts. */
  readonly facts: readonly (readonly [string, string])[];
  /** What is odd, and what was made of it. */
  readonly quirks: readonly string[];
}

function part(value: unknown, name: string): JsonObject {
  const found = isObject(value) ? value[name] : undefined;
  return isObject(found) ? found : {};
}

export function parseReport(value: unknown): RobotReport {
  const body: JsonObject = isObject(value) ? value : {};
  const figures = part(body, 'figures');
  const ankle = part(figures, 'ankle_m');
  const feet = part(part(body, 'description'), 'feet');
  const metres = (from: JsonObject, name: string, digits = 3): string =>
    `${formatNumber(asNumber(from[name], Number.NaN), digits)} m`;
  const facts: [string, string][] = [
    ['Mass', `${formatNumber(asNumber(figures['mass_kg'], Number.NaN), 2)} kg`],
    ['CoM height', metres(figures, 'com_height_m')],
  ];
  for (const side of ['left', 'right']) {
    const leg = part(part(body, 'legs'), side);
    const joints = asArray(leg['joints']).map((joint) =>
      isObject(joint) ? asString(joint['role']).replaceAll('_', ' ') : '',
    );
    if (joints.length > 0) {
      facts.push([`${side} leg`, `${metres(leg, 'length_m')}: ${joints.join(', ')}`]);
    }
    const sole = part(part(feet, side), 'sole');
    const link = asString(leg['foot'], asString(part(feet, side)['link']));
    if (link !== '') {
      facts.push([`${side} foot`, `${link}, ${metres(sole, 'length')} × ${metres(sole, 'width')}`]);
    }
  }
  if (Object.keys(ankle).length > 0) {
    facts.push([
      'Ankle to edge',
      `${metres(ankle, 'ahead', 2)} ahead, ${metres(ankle, 'behind', 2)} behind, ` +
        `${metres(ankle, 'inward', 2)} inward, ${metres(ankle, 'outward', 2)} outward`,
    ]);
  }
  const weak = asArray(figures['single_support']).filter(
    (joint): joint is JsonObject =>
      isObject(joint) && asNumber(joint['needed_nm']) > asNumber(joint['limit_nm'], Infinity),
  );
  const reason = asString(body['reason']);
  return {
    name: asString(body['robot']),
    facts,
    quirks: [
      ...(reason === '' ? [] : [reason]),
      ...weak.map((joint) => `${asString(joint['joint'])} is too weak to stand on one leg`),
      ...asArray(body['quirks']).flatMap((quirk) =>
        isObject(quirk)
          ? [`${asString(quirk['where'])}: ${asString(quirk['what'])}; ${asString(quirk['answer'])}`]
          : [],
      ),
    ],
  };
}

/** A name that the server takes. */
export function robotNameFrom(text: string): string {
  const name = text
    .toLowerCase()
    .replace(/\.(urdf|xml)$/, '')
    .replace(/[^a-z0-9_-]+/g, '_')
    .replace(/^[^a-z0-9]+/, '');
  return name.slice(0, 64);
}

/** The path that a URDF says of a file, without `package://` and leading `..`; its name if none. */
export function meshPath(urdf: string, fileName: string): string {
  for (const [, said = ''] of urdf.matchAll(/filename\s*=\s*["']([^"']+)["']/g)) {
    const path = said.replace(/^(package|file):\/\//, '').replace(/^(\.\.?\/)+/, '');
    if (path === fileName || path.endsWith(`/${fileName}`)) return path;
  }
  return fileName;
}
