// The floor of the 3D view: squares of 0.25 m that go on without end, and the robot's shadow.

import * as THREE from 'three';
import type { Theme } from '../theme';

const size = 40;
const squaresPerMetre = 4;
const pixelsPerSquare = 64;

export class Ground {
  readonly object = new THREE.Group();
  private readonly squares: THREE.Mesh<THREE.PlaneGeometry, THREE.MeshBasicMaterial>;
  private readonly canvas = document.createElement('canvas');
  private readonly texture: THREE.CanvasTexture;

  constructor(theme: Theme, anisotropy: number) {
    this.canvas.width = squaresPerMetre * pixelsPerSquare;
    this.canvas.height = this.canvas.width;
    this.texture = new THREE.CanvasTexture(this.canvas);
    this.texture.wrapS = THREE.RepeatWrapping;
    this.texture.wrapT = THREE.RepeatWrapping;
    this.texture.repeat.set(size, size);
    this.texture.anisotropy = anisotropy;
    this.texture.colorSpace = THREE.SRGBColorSpace;
    const plane = new THREE.PlaneGeometry(size, size);
    this.squares = new THREE.Mesh(plane, new THREE.MeshBasicMaterial({ map: this.texture }));
    const shadow = new THREE.Mesh(
      plane,
      new THREE.ShadowMaterial({ opacity: 0.22, depthWrite: false, polygonOffset: true }),
    );
    // Just below the soles, so that nothing flickers against them.
    this.squares.position.z = -0.002;
    shadow.position.z = -0.001;
    shadow.receiveShadow = true;
    this.object.add(this.squares, shadow);
    this.setTheme(theme);
  }

  setTheme(theme: Theme): void {
    const c = this.canvas.getContext('2d');
    if (c === null) return;
    const { width } = this.canvas;
    c.globalAlpha = 1;
    c.fillStyle = theme.ground;
    c.fillRect(0, 0, width, width);
    c.fillStyle = theme.muted;
    for (let i = 0; i < squaresPerMetre; i += 1) {
      // The lines of whole metres are the strong ones.
      c.globalAlpha = i === 0 ? 0.5 : 0.2;
      const thickness = i === 0 ? 2 : 1.5;
      c.fillRect(i * pixelsPerSquare, 0, thickness, width);
      c.fillRect(0, i * pixelsPerSquare, width, thickness);
    }
    this.texture.needsUpdate = true;
  }

  /** Goes along with the robot in whole metres, so that it seems to lie still. */
  follow(x: number, y: number): void {
    this.object.position.set(Math.round(x), Math.round(y), 0);
  }
}
