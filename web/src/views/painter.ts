// Puts pictures of the 3D scene on a canvas without making the page wait for them.

import * as THREE from 'three';

/** How often it is asked whether a picture is done [ms]. */
const lookMs = 2;

/** What draws WebGL by the processor, at a tenth of the pace, calls itself so; a browser may refuse to say it is slow. */
const softwareRenderers = /swiftshader|llvmpipe|softpipe|software|basic render/i;

function hasGraphicsCard(): boolean {
  const gl = document
    .createElement('canvas')
    .getContext('webgl2', { failIfMajorPerformanceCaveat: true });
  if (gl === null) return false;
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const name: unknown = gl.getParameter(names?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return !softwareRenderers.test(String(name));
}

/**
 * With a graphics card it draws on the canvas itself. Without one, a browser that shows a canvas waits until the
 * processor has drawn it, and reads and draws nothing else meanwhile: so the picture is drawn aside, without what
 * costs most, smooth edges and shadows, and put on the canvas when it is done.
 */
export class Painter {
  /** A picture is being drawn; no other one is begun. */
  busy = false;
  readonly anisotropy: number;
  private readonly renderer: THREE.WebGLRenderer;
  /** Where a picture that was drawn aside is put; null: there is no need. */
  private readonly board: CanvasRenderingContext2D | null;

  constructor(private readonly canvas: HTMLCanvasElement) {
    const direct = hasGraphicsCard();
    this.renderer = new THREE.WebGLRenderer(
      direct
        ? { canvas, antialias: true }
        : { antialias: false, preserveDrawingBuffer: true },
    );
    this.renderer.shadowMap.enabled = direct;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.anisotropy = this.renderer.capabilities.getMaxAnisotropy();
    this.board = direct ? null : canvas.getContext('2d', { alpha: false });
  }

  /** Whether the processor draws. */
  get isSlow(): boolean {
    return this.board !== null;
  }

  /** Whether the next picture has the size of the canvas's place on the page. */
  get fits(): boolean {
    const size = this.renderer.getSize(new THREE.Vector2());
    return size.x === this.canvas.clientWidth && size.y === this.canvas.clientHeight;
  }

  /** `ratio`: pixels of the picture for one of the page. Returns whether the size has changed. */
  fit(ratio: number): boolean {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return false;
    if (this.fits && this.renderer.getPixelRatio() === ratio) return false;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    return true;
  }

  /** Begins a picture; `shown` is called once it is on the canvas. */
  paint(scene: THREE.Scene, camera: THREE.Camera, shown: () => void): void {
    this.renderer.render(scene, camera);
    if (this.board === null) {
      shown();
      return;
    }
    this.busy = true;
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const done = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const look = (): void => {
      if (done !== null && gl.clientWaitSync(done, 0, 0) === gl.TIMEOUT_EXPIRED) {
        setTimeout(look, lookMs);
        return;
      }
      gl.deleteSync(done);
      this.putOnBoard();
      this.busy = false;
      shown();
    };
    setTimeout(look, lookMs);
  }

  private putOnBoard(): void {
    const { canvas, board } = this;
    const { domElement: picture } = this.renderer;
    if (canvas.width !== picture.width) canvas.width = picture.width;
    if (canvas.height !== picture.height) canvas.height = picture.height;
    board?.drawImage(picture, 0, 0);
  }
}
