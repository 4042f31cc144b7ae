// The 3D view: the robot on the ground, the push that acts on it, a camera that goes along.

import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Api } from '../api';
import { linesOf } from '../api';
import { byId, setText } from '../dom';
import type { Store } from '../store';
import type { Theme } from '../theme';
import { Aim } from './aim';
import type { AimListener, AimMode } from './aim';
import { figureFor } from './figure';
import type { Figure } from './figure';
import { Ghost } from './ghost';
import { Ground } from './ground';
import { GroundMarks } from './ground_marks';
import type { Layer } from './ground_marks';
import { Painter } from './painter';
import { PushArrow } from './push_arrow';
import { lag } from './transform';

export type Preset = 'behind' | 'side' | 'front' | 'top';

/** Azimuth from the robot's front, counted to its left, and elevation of each preset [deg]. */
const presets: Readonly<Record<Preset, readonly [number, number]>> = {
  behind: [-145, 16],
  side: [-90, 8],
  front: [-35, 14],
  top: [180, 88],
};
const followTau = 0.35;
/** The camera looks at this share of the CoM's height. */
const eyeShare = 0.9;
/** Shares of the pixels each way; the next one down where pictures take longer than this, up where less [ms]. */
const qualities = [1, 0.7, 0.5, 0.35] as const;
const slowPeriodMs = 50;
const quickPeriodMs = 24;
/** A change of quality is judged by so many pictures. */
const picturesToJudge = 20;
/** Where nothing has moved for so long there is time for all pixels [ms]. */
const restMs = 300;

export class SceneView {
  private readonly painter: Painter;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(36, 1, 0.02, 80);
  private readonly controls: OrbitControls;
  private readonly sun = new THREE.DirectionalLight(0xffffff, 2.6);
  private readonly sky = new THREE.HemisphereLight(0xf4f7fb, 0x7d848c, 1.25);
  private readonly ground: Ground;
  private readonly marks: GroundMarks;
  private readonly arrow: PushArrow;
  private readonly aim: Aim;
  private readonly ghost: Ghost;
  private readonly aimLabel = byId('aim-label', HTMLElement);
  private readonly note = byId('scene-note', HTMLElement);
  private figure: Figure | null = null;
  private wanted = '';
  private dirty = true;
  private drawnVersion = -1;
  private lastTime = 0;
  private lastDrawn = 0;
  private isJudged = true;
  private settled = false;
  private framesDrawn = 0;
  private drawnTick: number | null = null;
  /** From a drawing to the next chance of one, smoothed [ms]; a slow machine gets a coarser picture. */
  private period = 0.5 * (slowPeriodMs + quickPeriodMs);
  private level = 0;
  private drawnLevel = 0;
  private judged = 0;
  follow = true;
  /** Whether a drag on the robot pushes: what is replayed is not there to be pushed. */
  aiming = true;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly store: Store,
    private readonly api: Api,
    private theme: Theme,
    listener: AimListener,
  ) {
    this.painter = new Painter(canvas);
    if (this.painter.isSlow) this.level = qualities.length - 1;
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.enableDamping = false;
    this.controls.addEventListener('change', () => (this.dirty = true));

    this.sky.position.set(0, 0, 1);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 4;
    this.sun.shadow.bias = -0.0006;
    this.ground = new Ground(theme, this.painter.anisotropy);
    this.marks = new GroundMarks(theme);
    this.arrow = new PushArrow(theme);
    this.scene.add(this.sky, this.sun, this.sun.target, this.ground.object);
    this.aim = new Aim(
      canvas,
      this.camera,
      store,
      () => (this.aiming ? (this.figure?.object ?? null) : null),
      (held) => (this.controls.enabled = !held),
      listener,
      () => (this.dirty = true),
    );
    this.ghost = new Ghost(api, () => (this.dirty = true));
    this.scene.add(this.marks.object, this.arrow.object, this.aim.object, this.ghost.object);
    this.setTheme(theme);
    this.preset('behind');

    new ResizeObserver(() => (this.dirty = true)).observe(canvas);
    store.on('hello', () => {
      this.settled = false;
      this.chooseFigure();
    });
    store.on('robot', () => this.chooseFigure());
    this.chooseFigure();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.scene.background = new THREE.Color(theme.ground);
    this.scene.fog = new THREE.Fog(theme.ground, 5, 15);
    this.ground.setTheme(theme);
    this.marks.setTheme(theme);
    this.figure?.setTheme(theme);
    this.arrow.setTheme(theme);
    this.ghost.setTheme(theme);
    this.aim.setTheme(theme);
    this.dirty = true;
  }

  /** Looks at the robot from one of the named sides. */
  preset(name: Preset): void {
    const unit = this.store.robot?.comHeightM ?? 1;
    const [azimuthDeg, elevationDeg] = presets[name];
    const azimuth = (azimuthDeg * Math.PI) / 180;
    const elevation = (elevationDeg * Math.PI) / 180;
    const distance = 3.8 * unit;
    const { target } = this.controls;
    target.z = this.store.terrain.height(target.x, target.y) + eyeShare * unit;
    this.camera.position.set(
      target.x + distance * Math.cos(elevation) * Math.cos(azimuth),
      target.y + distance * Math.cos(elevation) * Math.sin(azimuth),
      target.z + distance * Math.sin(elevation),
    );
    this.controls.update();
    this.dirty = true;
  }

  setMode(mode: AimMode): void {
    this.aim.mode = mode;
  }

  /** A second run beside what is shown; null: none. */
  showGhost(store: Store | null): void {
    this.ghost.show(store, this.theme);
  }

  clearAim(): void {
    this.aim.clear();
  }

  show(layer: Layer, on: boolean): void {
    this.marks.show(layer, on);
    this.dirty = true;
  }

  update(nowMs: number): void {
    const sinceMs = nowMs - this.lastTime;
    const dt = Math.min(1, Math.max(0, sinceMs / 1000));
    this.lastTime = nowMs;
    const moving = this.followRobot(dt);
    if (moving) this.dirty = true;
    if (this.painter.busy) return;
    if (!this.isJudged) this.adapt(nowMs - this.lastDrawn);
    const news = this.dirty || this.drawnVersion !== this.store.version;
    const rests = this.drawnLevel > 0 && nowMs - this.lastDrawn > restMs;
    if (!news && !rests) return;
    this.dirty = false;
    this.drawnVersion = this.store.version;
    this.lastDrawn = nowMs;
    this.isJudged = false;
    this.drawnLevel = news ? this.level : 0;
    this.fit();
    if (this.store.frame !== null) {
      this.figure?.pose(this.store);
      this.ghost.update();
      this.marks.update(this.store);
    }
    this.marks.object.visible = this.store.frame !== null;
    if (this.figure !== null) this.figure.object.visible = this.store.frame !== null;
    this.arrow.update(this.store, this.camera, this.canvas.clientWidth, this.canvas.clientHeight);
    this.ground.update(
      this.store.terrain,
      this.store.frame?.t ?? 0,
      this.controls.target.x,
      this.controls.target.y,
    );
    this.aim.update();
    this.placeAimLabel();
    const tick = this.store.frame?.tick ?? null;
    this.painter.paint(this.scene, this.camera, () => {
      this.framesDrawn += 1;
      this.drawnTick = tick;
    });
  }

  state(): Record<string, unknown> {
    return {
      tick: this.drawnTick,
      frames_drawn: this.framesDrawn,
      figure: this.figure?.state() ?? null,
      ghost: this.ghost.state(),
      marks: this.marks.state(),
      push_arrow: this.arrow.state(),
      ground: this.ground.state(),
      quality: qualities[this.drawnLevel],
      /** Nothing has moved since it was drawn with all pixels. */
      at_rest: this.drawnLevel === 0 && !this.dirty && !this.painter.busy && this.painter.fits,
      /** Where the centre of mass is on the canvas [px]. */
      com_px: this.comOnCanvas(),
      camera: {
        position: this.camera.position.toArray(),
        target: this.controls.target.toArray(),
        follow: this.follow,
      },
    };
  }

  private comOnCanvas(): [number, number] | null {
    const [x, y, z] = this.store.values('com');
    if (x === undefined || y === undefined || z === undefined) return null;
    // The camera may have been moved since the last drawing.
    this.camera.updateMatrixWorld();
    const at = new THREE.Vector3(x, y, z).project(this.camera);
    const { clientWidth, clientHeight } = this.canvas;
    return [((at.x + 1) / 2) * clientWidth, ((1 - at.y) / 2) * clientHeight];
  }

  /** The figure that the session needs; an answer that comes too late is thrown away. */
  private chooseFigure(): void {
    const { hello, robot } = this.store;
    if (hello === null) return;
    const known = robot?.name === hello.robot ? robot : null;
    const wanted = `${hello.plant} ${hello.robot} ${known?.baseLink ?? '?'} ${known?.sole.lengthM}`;
    if (wanted === this.wanted) return;
    // The base link and the size come with the robot; it is on its way.
    if (known === null) return;
    this.wanted = wanted;
    this.preset('behind');
    const changed = (): void => {
      this.dirty = true;
    };
    figureFor(this.api, hello.plant, known, this.theme, changed).then(
      (figure) => {
        if (wanted === this.wanted) this.setFigure(figure);
        else figure.dispose();
      },
      (error: unknown) => {
        if (wanted !== this.wanted) return;
        this.wanted = '';
        this.setFigure(null);
        setText(this.note, `The robot's model did not load. ${linesOf(error).join(' ')}`);
      },
    );
  }

  private setFigure(figure: Figure | null): void {
    if (this.figure !== null) {
      this.scene.remove(this.figure.object);
      this.figure.dispose();
    }
    this.figure = figure;
    if (figure !== null) {
      this.scene.add(figure.object);
      figure.setTheme(this.theme);
      setText(this.note, '');
    }
    this.dirty = true;
  }

  private followRobot(dt: number): boolean {
    const [x, y] = this.store.values('com');
    if (x === undefined || y === undefined || !this.follow) return false;
    const { target } = this.controls;
    const dx = (this.settled ? lag(target.x, x, dt, followTau) : x) - target.x;
    const dy = (this.settled ? lag(target.y, y, dt, followTau) : y) - target.y;
    const level = this.store.terrain.height(x, y) + eyeShare * (this.store.robot?.comHeightM ?? 1);
    const dz = (this.settled ? lag(target.z, level, dt, followTau) : level) - target.z;
    this.settled = true;
    if (Math.hypot(dx, dy, dz) < 1e-5) return false;
    target.x += dx;
    target.y += dy;
    target.z += dz;
    this.camera.position.x += dx;
    this.camera.position.y += dy;
    this.camera.position.z += dz;
    this.controls.update();
    this.sun.position.set(target.x - 2, target.y - 3.2, 4.6);
    this.sun.target.position.set(target.x, target.y, 0);
    return true;
  }

  private placeAimLabel(): void {
    const { label } = this.aim;
    this.aimLabel.hidden = label === null;
    if (label === null) return;
    const at = label.at.project(this.camera);
    const left = ((at.x + 1) / 2) * this.canvas.clientWidth;
    const top = ((1 - at.y) / 2) * this.canvas.clientHeight;
    setText(this.aimLabel, label.text);
    this.aimLabel.style.transform = `translate(${left.toFixed(1)}px, ${top.toFixed(1)}px)`;
  }

  /**
   * Draws with fewer pixels where drawing takes so long that what is shown would fall behind: `sinceMs` went by
   * from a drawing to the next chance of one.
   */
  private adapt(sinceMs: number): void {
    this.isJudged = true;
    // A page that was hidden had no chance.
    this.period += 0.1 * (Math.min(sinceMs, 500) - this.period);
    this.judged += 1;
    if (this.judged < picturesToJudge) return;
    const step = this.period > slowPeriodMs ? 1 : this.period < quickPeriodMs ? -1 : 0;
    const level = Math.min(qualities.length - 1, Math.max(0, this.level + step));
    if (level === this.level) return;
    this.level = level;
    this.judged = 0;
  }

  private fit(): void {
    const ratio = (qualities[this.drawnLevel] ?? 1) * Math.min(2, window.devicePixelRatio || 1);
    if (!this.painter.fit(ratio)) return;
    this.camera.aspect = this.canvas.clientWidth / this.canvas.clientHeight;
    this.camera.updateProjectionMatrix();
  }
}
