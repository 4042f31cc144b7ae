// The robot in the 3D view: its URDF on the full-body plant, a plain pendulum on the LIPM.

import * as THREE from 'three';
import { ColladaLoader } from 'three/examples/jsm/loaders/ColladaLoader.js';
import { STLLoader } from 'three/examples/jsm/loaders/STLLoader.js';
import type { URDFRobot } from 'urdf-loader';
import URDFLoader from 'urdf-loader';
import type { Api, RobotInfo } from '../api';
import type { Store } from '../store';
import type { Theme } from '../theme';

export interface Figure {
  readonly object: THREE.Object3D;
  /** Puts the figure where the newest frame says. */
  pose(store: Store): void;
  setTheme(theme: Theme): void;
  /** Numbers that are really drawn. */
  state(): Record<string, unknown>;
  dispose(): void;
}

function disposeAll(object: THREE.Object3D): void {
  object.traverse((child) => {
    if (!(child instanceof THREE.Mesh || child instanceof THREE.Line)) return;
    (child.geometry as THREE.BufferGeometry).dispose();
    const material = child.material as THREE.Material | THREE.Material[];
    for (const one of Array.isArray(material) ? material : [material]) one.dispose();
  });
}

function round(v: THREE.Vector3): [number, number, number] {
  return [v.x, v.y, v.z];
}

/** The full body: links and joints of the URDF, posed by the base's pose and the joints' angles. */
class UrdfFigure implements Figure {
  readonly object = new THREE.Group();
  private meshes = 0;
  private readonly base: THREE.Object3D;
  private readonly basePose = new THREE.Matrix4();
  private readonly rootFromBase = new THREE.Matrix4();
  private readonly dressed = new Set<THREE.Material>();

  constructor(
    private readonly robot: URDFRobot,
    baseLink: string,
  ) {
    this.object.matrixAutoUpdate = false;
    this.object.add(robot);
    this.base = robot.links[baseLink] ?? robot;
    // What the simulation says is drawn, also beyond a limit of the URDF.
    for (const joint of Object.values(robot.joints)) joint.ignoreLimits = true;
  }

  /** Meshes may come later than the links; each is dressed when it is there. */
  dress(): void {
    this.meshes = 0;
    this.object.traverse((child) => {
      if (!(child instanceof THREE.Mesh)) return;
      this.meshes += 1;
      child.castShadow = true;
      child.receiveShadow = true;
      const material: unknown = child.material;
      if (!(material instanceof THREE.MeshPhongMaterial) || this.dressed.has(material)) return;
      this.dressed.add(material);
      material.shininess = 12;
      material.specular.setScalar(0.12);
      // The loader takes a URDF's colours for linear light; people mean those of a screen.
      if (material.map === null) material.color.convertSRGBToLinear();
    });
  }

  pose(store: Store): void {
    const [x, y, z] = store.values('base_position');
    const [qw, qx, qy, qz] = store.values('base_orientation');
    if (x === undefined || y === undefined || z === undefined) return;
    if (qw === undefined || qx === undefined || qy === undefined || qz === undefined) return;
    store.eachJoint((name, position) => {
      this.robot.setJointValue(name, position);
    });
    this.basePose.compose(
      new THREE.Vector3(x, y, z),
      new THREE.Quaternion(qx, qy, qz, qw),
      new THREE.Vector3(1, 1, 1),
    );
    // Where the base is not the URDF's root, the root stands off it by the joints between.
    this.rootFromBase.identity();
    for (let at = this.base; at !== this.robot && at.parent !== null; at = at.parent) {
      at.updateMatrix();
      this.rootFromBase.premultiply(at.matrix);
    }
    this.object.matrix.copy(this.basePose).multiply(this.rootFromBase.invert());
    this.object.matrixWorldNeedsUpdate = true;
  }

  setTheme(): void {
    // A robot has the colours of its URDF.
  }

  state(): Record<string, unknown> {
    this.object.updateMatrixWorld(true);
    const position = new THREE.Vector3();
    const orientation = new THREE.Quaternion();
    const scale = new THREE.Vector3();
    this.base.matrixWorld.decompose(position, orientation, scale);
    const joints: Record<string, number> = {};
    for (const [name, joint] of Object.entries(this.robot.joints)) {
      if (joint.jointType !== 'fixed') joints[name] = joint.angle;
    }
    const links: Record<string, [number, number, number]> = {};
    for (const [name, link] of Object.entries(this.robot.links)) {
      links[name] = round(new THREE.Vector3().setFromMatrixPosition(link.matrixWorld));
    }
    return {
      kind: 'urdf',
      meshes: this.meshes,
      base_position: round(position),
      base_orientation: [orientation.w, orientation.x, orientation.y, orientation.z],
      joints,
      links,
    };
  }

  dispose(): void {
    disposeAll(this.object);
  }
}

/** The LIPM: a point mass on a leg without mass that ends in the ZMP, and where the feet are. */
class PendulumFigure implements Figure {
  readonly object = new THREE.Group();
  private readonly ball: THREE.Mesh<THREE.SphereGeometry, THREE.MeshStandardMaterial>;
  private readonly leg: THREE.Mesh<THREE.CylinderGeometry, THREE.MeshStandardMaterial>;
  private readonly feet: readonly [
    THREE.Mesh<THREE.BoxGeometry, THREE.MeshStandardMaterial>,
    THREE.Mesh<THREE.BoxGeometry, THREE.MeshStandardMaterial>,
  ];
  private readonly zmp = new THREE.Vector3();

  constructor(robot: RobotInfo | null, theme: Theme) {
    const unit = robot?.comHeightM ?? 1;
    const { lengthM, widthM } = robot?.sole ?? { lengthM: 0.15, widthM: 0.075 };
    const material = (): THREE.MeshStandardMaterial =>
      new THREE.MeshStandardMaterial({ roughness: 0.7 });
    this.ball = new THREE.Mesh(new THREE.SphereGeometry(0.07 * unit, 32, 20), material());
    const cylinder = new THREE.CylinderGeometry(0.014 * unit, 0.014 * unit, 1, 16);
    cylinder.rotateX(Math.PI / 2);
    this.leg = new THREE.Mesh(cylinder, material());
    const foot = (): THREE.Mesh<THREE.BoxGeometry, THREE.MeshStandardMaterial> => {
      const thickness = 0.02 * unit;
      const box = new THREE.BoxGeometry(lengthM, widthM, thickness);
      box.translate(0, 0, thickness / 2);
      return new THREE.Mesh(box, material());
    };
    this.feet = [foot(), foot()];
    for (const mesh of [this.ball, this.leg, ...this.feet]) {
      mesh.castShadow = true;
      this.object.add(mesh);
    }
    this.setTheme(theme);
  }

  pose(store: Store): void {
    const [x, y, z] = store.values('com');
    const [zmpX, zmpY] = store.values('zmp');
    if (x === undefined || y === undefined || z === undefined) return;
    this.ball.position.set(x, y, z);
    (['left_foot', 'right_foot'] as const).forEach((name, i) => {
      const [footX, footY, footZ, yaw] = store.values(name);
      const foot = this.feet[i];
      if (foot === undefined || footX === undefined || footY === undefined) return;
      foot.position.set(footX, footY, footZ ?? 0);
      foot.rotation.set(0, 0, yaw ?? 0);
    });
    if (zmpX === undefined || zmpY === undefined) return;
    this.zmp.set(zmpX, zmpY, 0);
    this.leg.position.addVectors(this.zmp, this.ball.position).multiplyScalar(0.5);
    this.leg.scale.set(1, 1, Math.max(1e-6, this.zmp.distanceTo(this.ball.position)));
    this.leg.lookAt(this.ball.position);
  }

  setTheme(theme: Theme): void {
    this.ball.material.color.set(theme.measured);
    this.leg.material.color.set(theme.muted);
    for (const foot of this.feet) foot.material.color.set(theme.muted);
  }

  state(): Record<string, unknown> {
    return {
      kind: 'pendulum',
      com: round(this.ball.position),
      leg_foot: round(this.zmp),
      left_foot: [...round(this.feet[0].position), this.feet[0].rotation.z],
      right_foot: [...round(this.feet[1].position), this.feet[1].rotation.z],
    };
  }

  dispose(): void {
    disposeAll(this.object);
  }
}

/** What stands for this robot on that plant; `changed` is called when a mesh has arrived later. */
export async function figureFor(
  api: Api,
  plant: string,
  robot: RobotInfo,
  theme: Theme,
  changed: () => void,
): Promise<Figure> {
  if (plant === 'lipm') return new PendulumFigure(robot, theme);
  return loadRobotFigure(api, robot.name, robot.baseLink, changed);
}

async function loadRobotFigure(
  api: Api,
  name: string,
  baseLink: string,
  changed: () => void,
): Promise<Figure> {
  const urdf = await api.robotUrdf(name);
  const files = api.robotFiles(name);
  const manager = new THREE.LoadingManager();
  const parse = (collision: boolean): URDFRobot => {
    const loader = new URDFLoader(manager);
    loader.workingPath = files;
    loader.packages = () => files.replace(/\/$/, '');
    // As the loader's own, with the key.
    loader.loadMeshCb = (path, loading, material, done) => {
      const fail = (error: unknown): void =>
        done(new THREE.Object3D(), error instanceof Error ? error : new Error(String(error)));
      if (/\.stl$/i.test(path)) {
        const stl = new STLLoader(loading).setRequestHeader(api.headers());
        stl.load(path, (shape) => done(new THREE.Mesh(shape, material)), undefined, fail);
      } else if (/\.dae$/i.test(path)) {
        const collada = new ColladaLoader(loading).setRequestHeader(api.headers());
        collada.load(path, (file) => done(file?.scene ?? new THREE.Object3D()), undefined, fail);
      } else {
        fail(new Error(`no loader for ${path}`));
      }
    };
    loader.parseVisual = !collision;
    loader.parseCollision = collision;
    return loader.parse(urdf);
  };
  // A model without a look of its own is shown as it collides.
  const looks = new DOMParser().parseFromString(urdf, 'application/xml').querySelector('visual');
  const robot = parse(looks === null);
  const figure = new UrdfFigure(robot, baseLink);
  figure.dress();
  manager.onLoad = () => {
    figure.dress();
    changed();
  };
  return figure;
}
