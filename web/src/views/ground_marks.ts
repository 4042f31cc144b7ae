// What the 3D view tells beside the body: steps past and to come, the swing foot's way, regions,
// CoM, DCM, ZMP and the ground's forces. The same things as in the view from above.

import * as THREE from 'three';
import type { Store } from '../store';
import type { Theme } from '../theme';
import { Area, Arrows, Dots, flatMark } from './ground_shapes';
import type { Mark } from './ground_shapes';
import { overlapOf, pathFrom, polygonFrom, soleCorners, stepsFrom } from './transform';
import type { Foot, Point } from './transform';

/** Above the floor, so that nothing flickers against it [m]. */
const lift = 0.004;
const shownFootprints = 12;
const shownSteps = 3;
const gravity = 9.81;

export type Layer = 'forces' | 'regions' | 'steps';

export class GroundMarks {
  readonly object = new THREE.Group();
  private readonly polygon = new Area(lift, 0.08);
  private readonly reach = new Area(0.4 * lift, 0.05, 0.5);
  private readonly capture = new Area(0.6 * lift, 0.1, 0.9);
  private readonly planned = new Area(0.8 * lift, 0, 0.5);
  private readonly adjusted = new Area(lift, 0.25);
  private readonly coming = Array.from({ length: shownSteps }, () => new Area(0.8 * lift, 0.04, 0.4));
  private readonly prints = Array.from({ length: shownFootprints }, () => new Area(0.7 * lift, 0.1));
  private readonly swing = new Dots(12, 0.006);
  private readonly forces = new Arrows(16);
  private readonly ball: Mark;
  private readonly com: Mark;
  private readonly dcm: Mark;
  private readonly zmp: Mark;
  private readonly plumb: THREE.Line<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  private readonly layers: Record<Layer, boolean> = { forces: true, regions: true, steps: true };
  private theme: Theme;
  private capturable: boolean | null = null;
  private forceCount = 0;

  constructor(theme: Theme) {
    this.theme = theme;
    this.com = flatMark(new THREE.CircleGeometry(0.018, 24));
    this.dcm = flatMark(new THREE.CircleGeometry(0.024, 4));
    this.zmp = flatMark(new THREE.PlaneGeometry(0.028, 0.028));
    this.ball = flatMark(new THREE.SphereGeometry(0.026, 24, 16));
    // Inside of the body: drawn over it.
    this.ball.material.depthTest = false;
    this.ball.material.transparent = true;
    this.ball.material.opacity = 0.85;
    this.ball.renderOrder = 8;
    this.plumb = new THREE.Line(
      new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(0, 0, 1)]),
      new THREE.LineBasicMaterial({ transparent: true, opacity: 0.5 }),
    );
    this.plumb.visible = false;
    this.plumb.frustumCulled = false;
    for (const { object } of [
      this.reach,
      this.capture,
      ...this.prints,
      ...this.coming,
      this.planned,
      this.adjusted,
      this.polygon,
      this.swing,
      this.forces,
    ]) {
      this.object.add(object);
    }
    this.object.add(this.com, this.dcm, this.zmp, this.ball, this.plumb);
    this.setTheme(theme);
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.polygon.setColour(theme.limit);
    this.reach.setColour(theme.planned);
    for (const area of [this.planned, this.adjusted, ...this.coming]) area.setColour(theme.planned);
    for (const area of this.prints) area.setColour(theme.muted);
    this.swing.object.material.color.set(theme.planned);
    this.forces.setColour(theme.measured);
    for (const mark of [this.com, this.dcm, this.zmp, this.ball]) {
      mark.material.color.set(theme.measured);
    }
    this.plumb.material.color.set(theme.measured);
  }

  show(layer: Layer, on: boolean): void {
    this.layers[layer] = on;
  }

  update(store: Store): void {
    const unit = store.robot?.comHeightM ?? 1;
    const { terrain } = store;
    const height = (x: number, y: number): number => terrain.height(x, y);
    this.polygon.set(polygonFrom(store.values('support_polygon')), height);
    this.drawRegions(store, height);
    this.drawSteps(store, height);
    const [x = 0, y = 0, z] = store.values('com');
    const place = (mark: Mark, values: readonly number[], level: number): void => {
      const [px, py] = values;
      mark.visible = px !== undefined && py !== undefined;
      mark.position.set(px ?? 0, py ?? 0, height(px ?? 0, py ?? 0) + lift * level);
      mark.scale.setScalar(unit);
    };
    place(this.zmp, store.values('zmp'), 1.5);
    place(this.com, store.values('com'), 2);
    place(this.dcm, store.values('dcm'), 2.5);
    this.ball.visible = z !== undefined && store.hello?.plant !== 'lipm';
    this.ball.position.set(x, y, z ?? 0);
    this.ball.scale.setScalar(unit);
    this.plumb.visible = z !== undefined;
    const floor = height(x, y);
    this.plumb.position.set(x, y, floor);
    this.plumb.scale.set(1, 1, (z ?? 1) - floor);
    this.drawForces(store, unit);
  }

  state(): Record<string, unknown> {
    return {
      com: [this.com.position.x, this.com.position.y],
      dcm: [this.dcm.position.x, this.dcm.position.y],
      zmp: [this.zmp.position.x, this.zmp.position.y],
      com_ball: this.ball.position.toArray(),
      adjusted_step: this.adjusted.object.visible,
      reachable_footholds: this.reach.object.visible,
      capture_region: this.capture.object.visible,
      capturable: this.capturable,
      coming_steps: this.coming.filter(({ object }) => object.visible).length,
      footprints: this.prints.filter(({ object }) => object.visible).length,
      swing_path: this.swing.object.count,
      ground_forces: this.forceCount,
    };
  }

  private drawRegions(store: Store, height: (x: number, y: number) => number): void {
    const on = this.layers.regions;
    const reach = on ? polygonFrom(store.values('reachable_footholds')) : [];
    const capture = on ? polygonFrom(store.values('capture_region')) : [];
    this.capturable = capture.length > 2 ? overlapOf(capture, reach).length > 0 : null;
    this.capture.setColour(this.capturable === false ? this.theme.limit : this.theme.good);
    this.reach.set(reach, height);
    this.capture.set(capture, height);
  }

  private drawSteps(store: Store, height: (x: number, y: number) => number): void {
    const sole = store.robot?.sole ?? { lengthM: 0.15, widthM: 0.075 };
    const corners = (foot: Foot | undefined): Point[] =>
      foot === undefined ? [] : soleCorners(foot, sole.lengthM, sole.widthM);
    const walking = store.walkingState !== 'idle' && this.layers.steps;
    const steps = (name: 'planned_step' | 'adjusted_step' | 'preview'): Foot[] =>
      walking ? stepsFrom(store.values(name)) : [];
    this.planned.set(corners(steps('planned_step')[0]), height);
    this.adjusted.set(corners(steps('adjusted_step')[0]), height);
    const preview = steps('preview');
    this.coming.forEach((area, i) => area.set(corners(preview[i + 1]), height));
    const past = this.layers.steps ? store.footprints.slice(-shownFootprints) : [];
    this.prints.forEach((area, i) => {
      area.set(corners(past[i]), height);
      area.fade(0.2 + (0.6 * (i + 1)) / shownFootprints);
    });
    this.swing.set(walking ? pathFrom(store.values('swing_path')) : [], 0.01);
  }

  private drawForces(store: Store, unit: number): void {
    const values = this.layers.forces ? store.values('ground_forces') : [];
    const forces: { point: THREE.Vector3; force: THREE.Vector3 }[] = [];
    for (let i = 0; i + 5 < values.length; i += 6) {
      forces.push({
        point: new THREE.Vector3().fromArray(values, i),
        force: new THREE.Vector3().fromArray(values, i + 3),
      });
    }
    this.forceCount = forces.length;
    // The weight on one point would reach up half of the CoM's height.
    const weight = (store.robot?.massKg ?? 30) * gravity;
    this.forces.set(forces, (0.5 * unit) / weight, unit);
  }
}
