// What is drawn on the ground under the robot in 3D: the same things as in the view from above.

import * as THREE from 'three';
import type { Store } from '../store';
import type { Theme } from '../theme';
import { polygonFrom, soleCorners, stepsFrom } from './transform';
import type { Point } from './transform';

/** Above the floor, so that nothing flickers against it [m]. */
const lift = 0.004;
const mostCorners = 16;

/** An outline on the ground of up to a few corners. */
class Outline {
  readonly object: THREE.LineLoop<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  private readonly positions = new Float32Array(3 * mostCorners);

  constructor() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(this.positions, 3));
    this.object = new THREE.LineLoop(geometry, new THREE.LineBasicMaterial());
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  set(points: readonly Point[]): void {
    const count = Math.min(points.length, mostCorners);
    this.object.visible = count > 2;
    points
      .slice(0, count)
      .forEach((point, i) => this.positions.set([point.x, point.y, lift], 3 * i));
    const { geometry } = this.object;
    geometry.setDrawRange(0, count);
    const attribute = geometry.getAttribute('position');
    attribute.needsUpdate = true;
  }
}

type Mark = THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;

export class GroundMarks {
  readonly object = new THREE.Group();
  private readonly polygon = new Outline();
  private readonly planned = new Outline();
  private readonly adjusted = new Outline();
  private readonly com: Mark;
  private readonly dcm: Mark;
  private readonly zmp: Mark;
  private readonly plumb: THREE.Line<THREE.BufferGeometry, THREE.LineBasicMaterial>;

  constructor(theme: Theme) {
    const flat = (geometry: THREE.BufferGeometry): Mark => {
      const mark = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial());
      mark.visible = false;
      return mark;
    };
    this.com = flat(new THREE.CircleGeometry(0.018, 24));
    this.dcm = flat(new THREE.CircleGeometry(0.024, 4));
    this.zmp = flat(new THREE.PlaneGeometry(0.028, 0.028));
    this.plumb = new THREE.Line(
      new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(0, 0, 1)]),
      new THREE.LineBasicMaterial({ transparent: true, opacity: 0.5 }),
    );
    this.plumb.visible = false;
    this.plumb.frustumCulled = false;
    this.object.add(
      this.polygon.object,
      this.planned.object,
      this.adjusted.object,
      this.com,
      this.dcm,
      this.zmp,
      this.plumb,
    );
    this.setTheme(theme);
  }

  setTheme(theme: Theme): void {
    this.polygon.object.material.color.set(theme.limit);
    this.planned.object.material.color.set(theme.planned);
    this.planned.object.material.transparent = true;
    this.planned.object.material.opacity = 0.5;
    this.adjusted.object.material.color.set(theme.planned);
    for (const mark of [this.com, this.dcm, this.zmp]) mark.material.color.set(theme.measured);
    this.plumb.material.color.set(theme.measured);
  }

  update(store: Store): void {
    const unit = store.robot?.comHeightM ?? 1;
    const sole = store.robot?.sole ?? { lengthM: 0.15, widthM: 0.075 };
    this.polygon.set(polygonFrom(store.values('support_polygon')));
    const walking = store.walkingState !== 'idle';
    const step = (name: 'planned_step' | 'adjusted_step'): Point[] => {
      const first = walking ? stepsFrom(store.values(name))[0] : undefined;
      return first === undefined ? [] : soleCorners(first, sole.lengthM, sole.widthM);
    };
    this.planned.set(step('planned_step'));
    this.adjusted.set(step('adjusted_step'));
    const place = (mark: Mark, values: readonly number[], level: number): void => {
      const [x, y] = values;
      mark.visible = x !== undefined && y !== undefined;
      mark.position.set(x ?? 0, y ?? 0, lift * level);
      mark.scale.setScalar(unit);
    };
    place(this.zmp, store.values('zmp'), 1.5);
    place(this.com, store.values('com'), 2);
    place(this.dcm, store.values('dcm'), 2.5);
    const [x, y, z] = store.values('com');
    this.plumb.visible = z !== undefined;
    this.plumb.position.set(x ?? 0, y ?? 0, 0);
    this.plumb.scale.set(1, 1, z ?? 1);
  }

  state(): Record<string, unknown> {
    return {
      com: [this.com.position.x, this.com.position.y],
      dcm: [this.dcm.position.x, this.dcm.position.y],
      zmp: [this.zmp.position.x, this.zmp.position.y],
      adjusted_step: this.adjusted.object.visible,
    };
  }
}
