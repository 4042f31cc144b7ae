// The other run of a replay in the 3D view: a figure of its own, pale, and seen through.

import * as THREE from 'three';
import type { Api } from '../api';
import type { Store } from '../store';
import type { Theme } from '../theme';
import { figureFor } from './figure';
import type { Figure } from './figure';

export class Ghost {
  readonly object = new THREE.Group();
  private readonly pale = new THREE.MeshLambertMaterial({ transparent: true, opacity: 0.35 });
  private store: Store | null = null;
  private figure: Figure | null = null;

  constructor(
    private readonly api: Api,
    private readonly changed: () => void,
  ) {}

  setTheme({ muted }: Theme): void {
    this.pale.color.set(muted);
  }

  /** Shows what that store has from now on; null: nothing. */
  show(store: Store | null, theme: Theme): void {
    this.store = store;
    this.setFigure(null);
    if (store === null || store.hello === null || store.robot === null) return;
    const changed = (): void => {
      this.fade();
      this.changed();
    };
    figureFor(this.api, store.hello.plant, store.robot, theme, changed).then(
      (figure) => {
        if (store === this.store) this.setFigure(figure);
        else figure.dispose();
      },
      // Without its model the run is in the other views all the same.
      () => undefined,
    );
  }

  update(): void {
    if (this.store !== null) this.figure?.pose(this.store);
  }

  state(): Record<string, unknown> | null {
    return this.figure?.state() ?? null;
  }

  private setFigure(figure: Figure | null): void {
    if (this.figure !== null) {
      this.object.remove(this.figure.object);
      this.figure.dispose();
    }
    this.figure = figure;
    if (figure !== null) this.object.add(figure.object);
    this.fade();
    this.changed();
  }

  private fade(): void {
    this.object.traverse((child) => {
      if (!(child instanceof THREE.Mesh) || child.material === this.pale) return;
      const own = child.material as THREE.Material | THREE.Material[];
      for (const one of Array.isArray(own) ? own : [own]) one.dispose();
      child.material = this.pale;
      child.castShadow = false;
    });
  }
}
