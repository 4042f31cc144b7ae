// Which plots there are, in groups of which one is shown at a time.

import { torqueSeries } from '../series';

/** What a line means; its colour and the legend's switch follow from it. */
export type Role = 'measured' | 'reference' | 'planned' | 'limit' | 'other';

export interface Line {
  readonly series: string;
  readonly role: Role;
  /** Column of the CSV. */
  readonly label: string;
  /** Of the run that is laid over this one. */
  readonly overlaid?: boolean;
}

export interface PlotSpec {
  readonly id: string;
  readonly title: string;
  readonly unit: string;
  readonly lines: readonly Line[];
  /** The y axis shows at least this much. */
  readonly leastSpan: number;
  readonly fromZero?: boolean;
  readonly wide?: boolean;
  readonly digits?: number;
}

export interface PlotGroup {
  readonly id: string;
  readonly title: string;
  readonly plots: readonly PlotSpec[];
}

const line = (series: string, role: Role): Line => ({ series, role, label: series });

function tracking(quantity: string, title: string, axis: 'x' | 'y', edges = false): PlotSpec {
  return {
    id: `${quantity}_${axis}`,
    title: `${title} ${axis}`,
    unit: 'm',
    leastSpan: 0.06,
    lines: [
      line(`${quantity}_${axis}`, 'measured'),
      line(`${quantity}_reference_${axis}`, 'reference'),
      ...(edges ? [line(`polygon_min_${axis}`, 'limit'), line(`polygon_max_${axis}`, 'limit')] : []),
    ],
  };
}

const balance: PlotGroup = {
  id: 'balance',
  title: 'Balance',
  plots: [
    {
      id: 'dcm_error',
      title: 'DCM error, distance',
      unit: 'm',
      leastSpan: 0.02,
      fromZero: true,
      wide: true,
      lines: [line('dcm_error', 'measured')],
    },
    tracking('dcm', 'DCM', 'x'),
    tracking('dcm', 'DCM', 'y'),
    tracking('zmp', 'ZMP', 'x', true),
    tracking('zmp', 'ZMP', 'y', true),
    tracking('com', 'CoM', 'x'),
    tracking('com', 'CoM', 'y'),
  ],
};

const steps: PlotGroup = {
  id: 'steps',
  title: 'Steps',
  plots: [
    {
      id: 'step_time',
      title: 'Single support: adjusted and planned',
      unit: 's',
      leastSpan: 0.1,
      wide: true,
      lines: [line('step_time', 'measured'), line('step_time_planned', 'planned')],
    },
    {
      id: 'load_left',
      title: 'Load of the left foot',
      unit: 'N',
      leastSpan: 50,
      fromZero: true,
      digits: 0,
      lines: [line('load_left', 'measured')],
    },
    {
      id: 'load_right',
      title: 'Load of the right foot',
      unit: 'N',
      leastSpan: 50,
      fromZero: true,
      digits: 0,
      lines: [line('load_right', 'measured')],
    },
    {
      id: 'push_force',
      title: 'Push',
      unit: 'N',
      leastSpan: 10,
      fromZero: true,
      wide: true,
      digits: 0,
      lines: [line('push_force', 'measured')],
    },
  ],
};

const momentum: PlotGroup = {
  id: 'momentum',
  title: 'Momentum',
  plots: (['x', 'y', 'z'] as const).flatMap((axis): PlotSpec[] => [
    {
      id: `momentum_${axis}`,
      title: `Momentum ${axis}`,
      unit: 'N s',
      leastSpan: 1,
      digits: 2,
      lines: [line(`momentum_${axis}`, 'measured')],
    },
    {
      id: `angular_momentum_${axis}`,
      title: `Angular momentum ${axis}, about the CoM`,
      unit: 'N m s',
      leastSpan: 0.2,
      digits: 2,
      lines: [line(`angular_momentum_${axis}`, 'measured')],
    },
  ]),
};

/** One plot for each joint; those of the two legs stand side by side. */
function torques(joints: readonly string[]): PlotGroup {
  const left = joints.filter((joint) => /left/i.test(joint));
  const partner = (joint: string): string =>
    joint.replace('left', 'right').replace('Left', 'Right').replace('LEFT', 'RIGHT');
  const pairs = left.filter((joint) => joints.includes(partner(joint)));
  const paired = new Set([...pairs, ...pairs.map(partner)]);
  const order = [
    ...pairs.flatMap((joint) => [joint, partner(joint)]),
    ...joints.filter((joint) => !paired.has(joint)),
  ];
  return {
    id: 'torques',
    title: 'Torques',
    plots: order.map((joint) => ({
      id: torqueSeries(joint),
      title: joint.replaceAll('_', ' '),
      unit: 'N m',
      leastSpan: 1,
      digits: 1,
      lines: [line(torqueSeries(joint), 'measured')],
    })),
  };
}

/** The groups for a robot with these joints. */
export function plotGroups(joints: readonly string[]): PlotGroup[] {
  return [balance, steps, ...(joints.length > 0 ? [torques(joints)] : []), momentum];
}
