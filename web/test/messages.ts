// Messages as the server writes them, for the tests.

export function hello(session = 'a', extra: readonly string[] = []): Record<string, unknown> {
  const pair = [
    { name: 'x', unit: 'm' },
    { name: 'y', unit: 'm' },
  ];
  const channel = (name: string, components: unknown): unknown => ({
    name,
    frame: 'world',
    meaning: name,
    components,
    max_repeat: 1,
  });
  return {
    op: 'hello',
    protocol: 1,
    session_id: session,
    robot: 'kasaei',
    plant: 'bullet',
    tick_s: 0.001,
    channels: [
      channel('dcm', pair),
      channel('dcm_reference', pair),
      channel('fallen', [{ name: 'fallen', unit: '1' }]),
      channel('state', [{ name: 'code', unit: '1' }]),
      channel('joint_position', [
        { name: 'left_knee', unit: 'rad' },
        { name: 'right_knee', unit: 'rad' },
      ]),
      ...extra.map((name) => channel(name, pair)),
    ],
    states: ['idle', 'initialize', 'single_support', 'double_support'],
  };
}

export function data(
  seq: number,
  t: number,
  v: Readonly<Record<string, unknown>> = {},
): Record<string, unknown> {
  return { op: 'data', seq, tick: Math.round(t * 1000), t, v };
}
