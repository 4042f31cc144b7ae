// Pushing with the pointer: a drag that begins on the robot aims a push, or pulls at it as a spring
// does. Nothing is sent from here; whoever listens is told exact numbers.

import * as THREE from 'three';
import { impulseFor } from '../push_request';
import type { Vector } from '../push_request';
import type { Store } from '../store';
import type { Theme } from '../theme';

export type AimMode = 'aim' | 'spring';

/** Where the robot was taken hold of. */
export interface Grip {
  readonly link: string | null;
  /** In the link's frame [m]; null on the pendulum. */
  readonly point: Vector | null;
}

export interface AimListener {
  /** Let go: the push that was aimed at. */
  aimed(grip: Grip, directionDeg: number, impulseNs: number): void;
  springBegan(grip: Grip): void;
  /** The spring's force now, in the frame of the heading [N]. */
  springPulls(force: Vector): void;
  springEnded(): void;
}

/** A drag as long as the CoM is high changes the robot's velocity by this much [m/s]. */
const deltaVPerHeight = 0.5;
/** A spring that is pulled as far as the CoM is high pulls with this share of the weight. */
const weightPerHeight = 0.5;
const gravity = 9.81;
/** Shorter drags are clicks [px]. */
const leastDrag = 8;

export class Aim {
  readonly object = new THREE.Group();
  mode: AimMode = 'aim';
  private readonly line: THREE.Mesh<THREE.CylinderGeometry, THREE.MeshBasicMaterial>;
  private readonly head: THREE.Mesh<THREE.ConeGeometry, THREE.MeshBasicMaterial>;
  private readonly raycaster = new THREE.Raycaster();
  private text = '';
  private way = new THREE.Vector3();
  /** What is held, and where in its frame: the arrow goes along with it. */
  private anchor: { node: THREE.Object3D; local: THREE.Vector3 } | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly camera: THREE.PerspectiveCamera,
    private readonly store: Store,
    private readonly target: () => THREE.Object3D | null,
    private readonly hold: (held: boolean) => void,
    private readonly listener: AimListener,
    private readonly redraw: () => void,
  ) {
    const material = new THREE.MeshBasicMaterial({
      depthTest: false,
      transparent: true,
      fog: false,
    });
    const shaft = new THREE.CylinderGeometry(0.008, 0.008, 1, 12);
    shaft.translate(0, 0.5, 0);
    this.line = new THREE.Mesh(shaft, material);
    this.head = new THREE.Mesh(new THREE.ConeGeometry(0.03, 0.09, 20), material);
    this.object.add(this.line, this.head);
    for (const part of this.object.children) part.renderOrder = 11;
    this.object.visible = false;
    // Before the camera's own controls, which would turn the view.
    canvas.addEventListener('pointerdown', (event) => this.down(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.hover(event));
  }

  setTheme(theme: Theme): void {
    this.line.material.color.set(theme.planned);
  }

  /** What is aimed at now, in words, and where in the world the words belong; null when nothing. */
  get label(): { text: string; at: THREE.Vector3 } | null {
    if (this.anchor === null) return null;
    return { text: this.text, at: this.object.position.clone().add(this.way) };
  }

  /** The robot moves on while somebody aims. */
  update(): void {
    if (this.anchor === null) return;
    const { node, local } = this.anchor;
    node.updateWorldMatrix(true, false);
    this.object.position.copy(node.localToWorld(local.clone()));
  }

  clear(): void {
    this.object.visible = false;
    this.anchor = null;
    this.redraw();
  }

  /** The place of the robot under the pointer. */
  pick(event: MouseEvent): { grip: Grip; hit: THREE.Vector3; node: THREE.Object3D } | null {
    const target = this.target();
    if (target === null || this.store.frame === null) return null;
    const { clientWidth, clientHeight } = this.canvas;
    const at = new THREE.Vector2(
      (2 * event.offsetX) / clientWidth - 1,
      1 - (2 * event.offsetY) / clientHeight,
    );
    this.camera.updateMatrixWorld();
    this.raycaster.setFromCamera(at, this.camera);
    const [first] = this.raycaster.intersectObject(target, true);
    if (first === undefined) return null;
    for (let node: THREE.Object3D | null = first.object; node !== null; node = node.parent) {
      if ('isURDFLink' in node && node.isURDFLink === true) {
        const { x, y, z } = node.worldToLocal(first.point.clone());
        const round = (value: number): number => Number(value.toFixed(4));
        const point: Vector = [round(x), round(y), round(z)];
        return { grip: { link: node.name, point }, hit: first.point.clone(), node };
      }
    }
    return { grip: { link: null, point: null }, hit: first.point.clone(), node: first.object };
  }

  private hover(event: PointerEvent): void {
    if (event.buttons !== 0 || event.pointerType === 'touch') return;
    this.canvas.style.cursor = this.pick(event) === null ? '' : 'crosshair';
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || !event.isPrimary) return;
    const picked = this.pick(event);
    if (picked === null) return;
    this.hold(true);
    const { grip, hit, node } = picked;
    const local = node.worldToLocal(hit.clone());
    const spring = this.mode === 'spring' || event.shiftKey;
    const start = new THREE.Vector2(event.clientX, event.clientY);
    let way = new THREE.Vector3();
    let began = false;
    const move = (now: PointerEvent): void => {
      const drag = new THREE.Vector2(now.clientX, now.clientY).sub(start);
      if (!began && drag.length() < leastDrag) return;
      if (!began && spring) this.listener.springBegan(grip);
      began = true;
      this.anchor = { node, local };
      way = this.onGround(drag, hit);
      this.show(way, spring);
      if (spring) this.listener.springPulls(this.forceOf(way));
    };
    const end = (last: PointerEvent): void => {
      this.canvas.removeEventListener('pointermove', move);
      this.canvas.removeEventListener('pointerup', end);
      this.canvas.removeEventListener('pointercancel', end);
      this.hold(false);
      if (!began) return;
      if (spring) {
        this.listener.springEnded();
        this.clear();
      } else if (last.type === 'pointerup') {
        this.listener.aimed(grip, this.degreesOf(way), this.impulseOf(way));
      } else {
        this.clear();
      }
    };
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.addEventListener('pointermove', move);
    this.canvas.addEventListener('pointerup', end);
    this.canvas.addEventListener('pointercancel', end);
  }

  /** A drag on the screen as a way over the ground: sideways is sideways, up is away. */
  private onGround(drag: THREE.Vector2, hit: THREE.Vector3): THREE.Vector3 {
    const distance = this.camera.position.distanceTo(hit);
    const perPixel =
      (2 * distance * Math.tan((this.camera.fov * Math.PI) / 360)) / this.canvas.clientHeight;
    const forward = this.camera.getWorldDirection(new THREE.Vector3());
    const right = new THREE.Vector3(0, 0, 1).cross(forward).negate().normalize();
    // Seen from the side the ground is foreshortened; not more than is of use.
    const slant = Math.max(0.4, Math.abs(forward.z));
    const away = new THREE.Vector3(0, 0, 1).cross(right).normalize();
    return right
      .multiplyScalar(drag.x * perPixel)
      .addScaledVector(away, (-drag.y * perPixel) / slant);
  }

  private show(way: THREE.Vector3, spring: boolean): void {
    const unit = this.store.robot?.comHeightM ?? 1;
    const length = Math.max(1e-3, way.length());
    const up = new THREE.Vector3(0, 1, 0);
    const turn = new THREE.Quaternion().setFromUnitVectors(up, way.clone().divideScalar(length));
    this.object.quaternion.copy(turn);
    this.line.scale.set(unit, length, unit);
    this.head.position.set(0, length, 0);
    this.head.scale.setScalar(unit);
    this.object.visible = true;
    this.way = way.clone();
    this.text = spring
      ? `${Math.hypot(...this.forceOf(way)).toFixed(0)} N`
      : `${this.impulseOf(way)} N s, ${this.degreesOf(way)}°`;
    this.redraw();
  }

  /** In the frame of the heading, whole degrees: what is shown is what is sent. */
  private degreesOf(way: THREE.Vector3): number {
    const turn = Math.atan2(way.y, way.x) - this.store.heading;
    const degrees = Math.round((turn * 180) / Math.PI);
    return ((degrees % 360) + 360) % 360;
  }

  private impulseOf(way: THREE.Vector3): number {
    const unit = this.store.robot?.comHeightM ?? 1;
    const mass = this.store.robot?.massKg ?? 30;
    return impulseFor((way.length() / unit) * deltaVPerHeight, mass);
  }

  private forceOf(way: THREE.Vector3): Vector {
    const unit = this.store.robot?.comHeightM ?? 1;
    const mass = this.store.robot?.massKg ?? 30;
    const stiffness = (weightPerHeight * mass * gravity) / unit;
    const c = Math.cos(this.store.heading);
    const s = Math.sin(this.store.heading);
    const x = stiffness * (c * way.x + s * way.y);
    const y = stiffness * (-s * way.x + c * way.y);
    return [x, y, 0];
  }
}
