// The push that acts now, in 3D: an arrow that ends where the force acts, with the force beside it.

import * as THREE from 'three';
import { byId, setText } from '../dom';
import type { Store } from '../store';
import type { Theme } from '../theme';

const gravity = 9.81;

export class PushArrow {
  readonly object = new THREE.Group();
  private readonly label = byId('push-label', HTMLElement);
  private readonly material = new THREE.MeshBasicMaterial({
    // The point of attack is often inside the body: the arrow is drawn over it.
    depthTest: false,
    transparent: true,
    fog: false,
  });
  private readonly shaft: THREE.Mesh;
  private readonly head: THREE.Mesh;
  private drawn: Record<string, unknown> | null = null;

  constructor(theme: Theme) {
    // Both lie along +z and end in the origin.
    const shaft = new THREE.CylinderGeometry(0.011, 0.011, 1, 12);
    shaft.rotateX(Math.PI / 2);
    shaft.translate(0, 0, -0.5);
    const head = new THREE.ConeGeometry(0.035, 0.11, 24);
    head.rotateX(Math.PI / 2);
    head.translate(0, 0, -0.055);
    this.shaft = new THREE.Mesh(shaft, this.material);
    this.head = new THREE.Mesh(head, this.material);
    this.object.add(this.shaft, this.head);
    this.object.visible = false;
    this.object.renderOrder = 10;
    for (const part of this.object.children) part.renderOrder = 10;
    this.setTheme(theme);
  }

  setTheme(theme: Theme): void {
    this.material.color.set(theme.ink);
  }

  update(store: Store, camera: THREE.Camera, width: number, height: number): void {
    const [fx = 0, fy = 0, fz = 0] = store.values('push_force');
    const [px = 0, py = 0, pz = 0] = store.values('push_point');
    const size = Math.hypot(fx, fy, fz);
    this.object.visible = size > 0;
    this.label.hidden = size === 0;
    this.drawn = null;
    if (size === 0) return;
    const unit = store.robot?.comHeightM ?? 1;
    const weight = (store.robot?.massKg ?? 30) * gravity;
    // As long as the CoM is high when the force is the robot's weight; never too short to be seen.
    const length = unit * Math.min(1.2, Math.max(0.45, size / weight));
    const tip = new THREE.Vector3(px, py, pz);
    const direction = new THREE.Vector3(fx, fy, fz).divideScalar(size);
    const tail = tip.clone().addScaledVector(direction, -length);
    this.object.position.copy(tip);
    this.object.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), direction);
    this.head.scale.setScalar(unit);
    this.shaft.position.z = -0.1 * unit;
    this.shaft.scale.set(unit, unit, length - 0.1 * unit);
    const at = tail.project(camera);
    const left = ((at.x + 1) / 2) * width;
    const top = ((1 - at.y) / 2) * height;
    setText(this.label, `${size.toFixed(0)} N`);
    this.label.style.transform = `translate(${left.toFixed(1)}px, ${top.toFixed(1)}px)`;
    this.drawn = { tip: tip.toArray(), force_n: [fx, fy, fz], length_m: length };
  }

  state(): Record<string, unknown> | null {
    return this.drawn;
  }
}
