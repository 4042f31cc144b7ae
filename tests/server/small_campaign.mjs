// A campaign of four short trials on the pendulum: two directions, a push that is taken and one that is not.
export const smallCampaign = {
  version: 1,
  name: 'small',
  seed: 3,
  base: {
    robot: 'kasaei', plant: 'lipm', settle_s: 1, observe_s: 1,
    push: { duration_s: 0.05, trigger: { phase: 'single_support', leg: 'left', fraction: 0.1 } },
  },
  design: { kind: 'grid' },
  factors: { 'push.direction_deg': [0, 90], 'push.impulse_ns': [2, 150] },
};
/** More trials than are done before somebody can look. */
export const longCampaign = { ...smallCampaign, name: 'long', design: { kind: 'grid', repeats: 2500 } };
