// Flat shapes on the ground in 3D: areas with an outline, and marks, all at the ground's height.

import * as THREE from 'three';
import type { Point } from './transform';

const mostCorners = 16;

/** Height of the ground at a place [m]. */
export type Height = (x: number, y: number) => number;

/** A convex area of up to sixteen corners: filled faintly, outlined clearly. */
export class Area {
  readonly object = new THREE.Group();
  private readonly positions = new Float32Array(3 * mostCorners);
  private readonly geometry = new THREE.BufferGeometry();
  private readonly line: THREE.LineLoop<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  private readonly face: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;

  /** `lift` [m] keeps areas that lie on one another from flickering. */
  constructor(
    private readonly lift: number,
    fill: number,
    line = 1,
  ) {
    this.geometry.setAttribute('position', new THREE.BufferAttribute(this.positions, 3));
    const fan: number[] = [];
    for (let i = 1; i + 1 < mostCorners; i += 1) fan.push(0, i, i + 1);
    const faces = new THREE.BufferGeometry();
    faces.setAttribute('position', this.geometry.getAttribute('position'));
    faces.setIndex(fan);
    this.line = new THREE.LineLoop(
      this.geometry,
      new THREE.LineBasicMaterial({ transparent: true, opacity: line }),
    );
    this.face = new THREE.Mesh(
      faces,
      new THREE.MeshBasicMaterial({
        transparent: true,
        opacity: fill,
        side: THREE.DoubleSide,
        depthWrite: false,
      }),
    );
    for (const part of [this.face, this.line]) {
      part.frustumCulled = false;
      this.object.add(part);
    }
    this.object.visible = false;
  }

  setColour(colour: string): void {
    this.line.material.color.set(colour);
    this.face.material.color.set(colour);
  }

  fade(share: number): void {
    this.line.material.opacity = share;
  }

  set(points: readonly Point[], height: Height): void {
    const count = Math.min(points.length, mostCorners);
    this.object.visible = count > 2;
    if (count < 3) return;
    points.slice(0, count).forEach(({ x, y }, i) => {
      this.positions.set([x, y, height(x, y) + this.lift], 3 * i);
    });
    this.geometry.setDrawRange(0, count);
    this.face.geometry.setDrawRange(0, 3 * (count - 2));
    this.geometry.getAttribute('position').needsUpdate = true;
  }
}

export type Mark = THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;

/** A flat mark; `circle` with four corners is a diamond. */
export function flatMark(geometry: THREE.BufferGeometry): Mark {
  const mark = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
  mark.visible = false;
  return mark;
}

/** A row of small balls: a way through the air. */
export class Dots {
  readonly object: THREE.InstancedMesh<THREE.SphereGeometry, THREE.MeshBasicMaterial>;

  constructor(capacity: number, radius: number) {
    this.object = new THREE.InstancedMesh(
      new THREE.SphereGeometry(radius, 10, 8),
      new THREE.MeshBasicMaterial(),
      capacity,
    );
    this.object.frustumCulled = false;
    this.object.count = 0;
    this.capacity = capacity;
  }

  private readonly capacity: number;

  set(points: readonly (Point & { z: number })[], lift: number): void {
    const matrix = new THREE.Matrix4();
    const count = Math.min(points.length, this.capacity);
    points.slice(0, count).forEach(({ x, y, z }, i) => {
      this.object.setMatrixAt(i, matrix.makeTranslation(x, y, z + lift));
    });
    this.object.count = count;
    this.object.instanceMatrix.needsUpdate = true;
  }
}

/** Thin arrows that begin where a force acts. */
export class Arrows {
  readonly object = new THREE.Group();
  private readonly shafts: THREE.InstancedMesh<THREE.CylinderGeometry, THREE.MeshBasicMaterial>;
  private readonly heads: THREE.InstancedMesh<THREE.ConeGeometry, THREE.MeshBasicMaterial>;
  private readonly material = new THREE.MeshBasicMaterial();

  constructor(private readonly capacity: number) {
    const shaft = new THREE.CylinderGeometry(0.004, 0.004, 1, 8);
    shaft.translate(0, 0.5, 0);
    const head = new THREE.ConeGeometry(0.013, 0.035, 12);
    head.translate(0, 0.0175, 0);
    this.shafts = new THREE.InstancedMesh(shaft, this.material, capacity);
    this.heads = new THREE.InstancedMesh(head, this.material, capacity);
    for (const part of [this.shafts, this.heads]) {
      part.frustumCulled = false;
      part.count = 0;
      this.object.add(part);
    }
  }

  setColour(colour: string): void {
    this.material.color.set(colour);
  }

  /** Each force [N] is drawn `perNewton` m long from its point. */
  set(
    forces: readonly { point: THREE.Vector3; force: THREE.Vector3 }[],
    perNewton: number,
    unit: number,
  ): void {
    const up = new THREE.Vector3(0, 1, 0);
    const turn = new THREE.Quaternion();
    const matrix = new THREE.Matrix4();
    const count = Math.min(forces.length, this.capacity);
    forces.slice(0, count).forEach(({ point, force }, i) => {
      const size = force.length();
      const direction = size > 0 ? force.clone().divideScalar(size) : up;
      turn.setFromUnitVectors(up, direction);
      const length = Math.max(1e-4, size * perNewton);
      matrix.compose(point, turn, new THREE.Vector3(unit, length, unit));
      this.shafts.setMatrixAt(i, matrix);
      const tip = point.clone().addScaledVector(direction, length);
      matrix.compose(tip, turn, new THREE.Vector3(unit, unit, unit));
      this.heads.setMatrixAt(i, matrix);
    });
    for (const part of [this.shafts, this.heads]) {
      part.count = count;
      part.instanceMatrix.needsUpdate = true;
    }
  }
}
