// What the plots are made of: one row of numbers for each frame that has come.

import type { Hello, Values } from './protocol';

export const fixedSeries = [
  't',
  'com_x',
  'com_y',
  'com_reference_x',
  'com_reference_y',
  'dcm_x',
  'dcm_y',
  'dcm_reference_x',
  'dcm_reference_y',
  'zmp_x',
  'zmp_y',
  'zmp_reference_x',
  'zmp_reference_y',
  'polygon_min_x',
  'polygon_max_x',
  'polygon_min_y',
  'polygon_max_y',
  'dcm_error',
  'step_time',
  'step_time_planned',
  'load_left',
  'load_right',
  'momentum_x',
  'momentum_y',
  'momentum_z',
  'angular_momentum_x',
  'angular_momentum_y',
  'angular_momentum_z',
  'push_force',
  'stance',
] as const;

const torquePrefix = 'torque_';

export function torqueSeries(joint: string): string {
  return torquePrefix + joint;
}

export function jointsOf(hello: Hello, channel: string): string[] {
  const found = hello.channels.find(({ name }) => name === channel);
  return found?.components.map(({ name }) => name) ?? [];
}

/** Least and greatest of every other number from `offset`, or NaN for an empty list. */
function extent(values: readonly number[], offset: number): [number, number] {
  let low = Number.NaN;
  let high = Number.NaN;
  for (let i = offset; i < values.length; i += 2) {
    const value = values[i] ?? Number.NaN;
    if (!(low <= value)) low = value;
    if (!(high >= value)) high = value;
  }
  return [low, high];
}

/** Which foot stands: 0 both, 1 left, 2 right; NaN where the stream does not tell. */
function stanceOf(v: Values, states: readonly string[]): number {
  const state = v['state']?.[0];
  const side = v['support_side']?.[0];
  if (state === undefined || side === undefined) return Number.NaN;
  return states[state] === 'single_support' ? 1 + side : 0;
}

/** The row of one frame. */
export function rowOf(
  t: number,
  v: Values,
  states: readonly string[],
  torqueJoints: readonly string[],
  massKg: number,
): Record<string, number> {
  const at = (channel: string, i = 0): number => v[channel]?.[i] ?? Number.NaN;
  const polygon = v['support_polygon'] ?? [];
  const [minX, maxX] = extent(polygon, 0);
  const [minY, maxY] = extent(polygon, 1);
  const row: Record<string, number> = {
    t,
    polygon_min_x: minX,
    polygon_max_x: maxX,
    polygon_min_y: minY,
    polygon_max_y: maxY,
    dcm_error: Math.hypot(
      at('dcm') - at('dcm_reference'),
      at('dcm', 1) - at('dcm_reference', 1),
    ),
    step_time: at('t_ss'),
    step_time_planned: at('planned_t_ss'),
    load_left: at('foot_load'),
    load_right: at('foot_load', 1),
    push_force: Math.hypot(at('push_force'), at('push_force', 1), at('push_force', 2)),
    stance: stanceOf(v, states),
  };
  for (const channel of ['com', 'dcm', 'zmp', 'com_reference', 'dcm_reference', 'zmp_reference']) {
    row[`${channel}_x`] = at(channel);
    row[`${channel}_y`] = at(channel, 1);
  }
  (['x', 'y', 'z'] as const).forEach((axis, i) => {
    row[`momentum_${axis}`] = massKg * at('com_velocity', i);
    row[`angular_momentum_${axis}`] = at('angular_momentum', i);
  });
  torqueJoints.forEach((joint, i) => (row[torqueSeries(joint)] = at('joint_torque', i)));
  return row;
}
