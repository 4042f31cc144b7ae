// The floor of the 3D view: squares of 0.25 m without end, tilted, tiled, moving or slippery as the
// terrain says, and the robot's shadow on it.

import * as THREE from 'three';
import type { Terrain } from '../terrain';
import { tileSize } from '../terrain';
import type { Theme } from '../theme';

const size = 40;
const squaresPerMetre = 4;
const pixelsPerSquare = 64;
/** Tiles shown each way from the robot. */
const tilesAround = 8;
const tileDepth = 0.06;
/** Samples for a pixel that looks at the lines from aslant: more is not seen, and slow without a graphics card. */
const mostAnisotropy = 4;

export class Ground {
  readonly object = new THREE.Group();
  private readonly plane = new THREE.Group();
  private readonly squares: THREE.Mesh<THREE.PlaneGeometry, THREE.MeshBasicMaterial>;
  private readonly tiles: THREE.InstancedMesh<THREE.BoxGeometry, THREE.MeshLambertMaterial>;
  private readonly patches = new THREE.Group();
  private readonly patchMaterial = new THREE.MeshBasicMaterial({
    transparent: true,
    opacity: 0.28,
    depthWrite: false,
  });
  private readonly canvas = document.createElement('canvas');
  private readonly texture: THREE.CanvasTexture;
  private terrain: Terrain | null = null;
  private tilesAt = '';

  constructor(theme: Theme, anisotropy: number) {
    this.canvas.width = squaresPerMetre * pixelsPerSquare;
    this.canvas.height = this.canvas.width;
    this.texture = new THREE.CanvasTexture(this.canvas);
    this.texture.wrapS = THREE.RepeatWrapping;
    this.texture.wrapT = THREE.RepeatWrapping;
    this.texture.repeat.set(size, size);
    this.texture.anisotropy = Math.min(mostAnisotropy, anisotropy);
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
    this.plane.add(this.squares, shadow);
    const around = 2 * tilesAround + 1;
    const gap = 0.004;
    this.tiles = new THREE.InstancedMesh(
      new THREE.BoxGeometry(tileSize - gap, tileSize - gap, tileDepth),
      new THREE.MeshLambertMaterial(),
      around * around,
    );
    this.tiles.receiveShadow = true;
    this.tiles.frustumCulled = false;
    this.object.add(this.plane, this.tiles, this.patches);
    this.setTheme(theme);
  }

  setTheme(theme: Theme): void {
    this.patchMaterial.color.set(theme.muted);
    this.tiles.material.color.set(theme.ground);
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
  update(terrain: Terrain, t: number, x: number, y: number): void {
    if (terrain !== this.terrain) this.build(terrain);
    const [dx, dy] = terrain.shift(t);
    const [cx, cy] = [Math.round(x - dx) + dx, Math.round(y - dy) + dy];
    this.plane.position.set(cx, cy, terrain.kind === 'uneven' ? 0 : terrain.height(cx, cy));
    this.patches.position.set(dx, dy, 0);
    if (terrain.kind === 'uneven') this.layTiles(terrain, x, y);
  }

  state(): Record<string, unknown> {
    return {
      kind: this.terrain?.kind ?? 'flat',
      tiles: this.tiles.visible ? this.tiles.count : 0,
      patches: this.patches.children.length,
    };
  }

  private build(terrain: Terrain): void {
    this.terrain = terrain;
    this.tilesAt = '';
    const uneven = terrain.kind === 'uneven';
    this.tiles.visible = uneven;
    this.squares.visible = !uneven;
    const normal = new THREE.Vector3(0, 0, 1);
    if (terrain.kind === 'slope') {
      const rise = Math.sin(terrain.angle);
      normal.set(
        -rise * Math.cos(terrain.uphill),
        -rise * Math.sin(terrain.uphill),
        Math.cos(terrain.angle),
      );
    }
    this.plane.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    for (const patch of this.patches.children) {
      if (patch instanceof THREE.Mesh) (patch.geometry as THREE.BufferGeometry).dispose();
    }
    this.patches.clear();
    for (const { xMin, xMax, yMin, yMax } of terrain.patches) {
      const corner = (px: number, py: number): THREE.Vector3 =>
        new THREE.Vector3(px, py, terrain.height(px, py) + 0.002);
      const geometry = new THREE.BufferGeometry().setFromPoints([
        corner(xMin, yMin),
        corner(xMax, yMin),
        corner(xMax, yMax),
        corner(xMin, yMax),
      ]);
      geometry.setIndex([0, 1, 2, 0, 2, 3]);
      this.patches.add(new THREE.Mesh(geometry, this.patchMaterial));
    }
  }

  private layTiles(terrain: Terrain, x: number, y: number): void {
    const column = Math.floor(x / tileSize + 0.5);
    const row = Math.floor(y / tileSize + 0.5);
    const at = `${column} ${row}`;
    if (at === this.tilesAt) return;
    this.tilesAt = at;
    const matrix = new THREE.Matrix4();
    const shade = new THREE.Color();
    let k = 0;
    for (let i = column - tilesAround; i <= column + tilesAround; i += 1) {
      for (let j = row - tilesAround; j <= row + tilesAround; j += 1) {
        const top = terrain.tileHeight(i, j);
        matrix.makeTranslation(i * tileSize, j * tileSize, top - tileDepth / 2 - 0.002);
        this.tiles.setMatrixAt(k, matrix);
        // The higher, the lighter: millimetres would not be seen otherwise.
        const share = terrain.unevenness > 0 ? top / terrain.unevenness : 0;
        this.tiles.setColorAt(k, shade.setScalar(0.72 + 0.28 * share));
        k += 1;
      }
    }
    this.tiles.instanceMatrix.needsUpdate = true;
    if (this.tiles.instanceColor !== null) this.tiles.instanceColor.needsUpdate = true;
  }
}
