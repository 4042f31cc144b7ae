// Wires store, stream, views and panels together and draws once an animation frame.

import 'uplot/dist/uPlot.min.css';
import { Api, linesOf } from './api';
import { byId, setText } from './dom';
import { ConditionBar } from './panels/condition';
import { EventsPanel } from './panels/events';
import { PushPanel } from './panels/push';
import { SimulationPanel } from './panels/simulation';
import { ValuesPanel } from './panels/values';
import { WalkPanel } from './panels/walk';
import { Store, rateHz, usedChannels } from './store';
import { Stream } from './stream';
import type { Theme } from './theme';
import { followTheme } from './theme';
import { Plots } from './views/plots';
import type { Preset, SceneView } from './views/scene';
import { TopView } from './views/top_view';

declare global {
  interface Window {
    /** The numbers that are really drawn, for tests and for the curious. */
    stagger: { scene_state(): Record<string, unknown> };
  }
}

const store = new Store();
const api = new Api();
const address = new URL('/api/v1/stream', window.location.href);
address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';

const stream = new Stream(
  {
    url: address.href,
    rateHz,
    channels: usedChannels,
    openSocket: (url) => new WebSocket(url),
  },
  {
    connection: (connection) => store.setConnection(connection),
    hello: (hello) => {
      store.setHello(hello);
      void readRobot(hello.robot);
    },
    data: (data) => store.setFrame(data),
    event: (event) => store.addEvent(event),
    heartbeat: (heartbeat) => store.setRunning(heartbeat.running),
    gap: (count) => store.addDropped(count),
    complaint: (text) => setText(byId('transport-error', HTMLElement), text),
  },
);

/** The robots that can be chosen, and the one of this session. */
async function readRobot(name: string): Promise<void> {
  try {
    const robot = await api.robot(name);
    if (store.hello?.robot === name) store.setRobot(robot);
    store.setRobots(await api.robots());
  } catch (error) {
    setText(
      byId('scene-note', HTMLElement),
      `The robot's description did not load. ${linesOf(error).join(' ')}`,
    );
  }
}

let theme: Theme | null = null;
let scene: SceneView | null = null;
let topView: TopView | null = null;
let plots: Plots | null = null;

followTheme((next) => {
  theme = next;
  scene?.setTheme(next);
  topView?.setTheme(next);
  plots?.setTheme(next);
});
if (theme === null) throw new Error('the page has no theme');

topView = new TopView(byId('top-view', HTMLCanvasElement), store, theme);
plots = new Plots(byId('plots', HTMLElement), store, theme);
byId('zoom-in', HTMLButtonElement).addEventListener('click', () => topView?.zoom(1.25));
byId('zoom-out', HTMLButtonElement).addEventListener('click', () => topView?.zoom(0.8));

const values = new ValuesPanel(store);
const events = new EventsPanel(store);
const push = new PushPanel(store, api);
const simulation = new SimulationPanel(store, api);
new WalkPanel(store, api, () => void simulation.read());
const bar = new ConditionBar(store, stream, (text) => events.announce(text));

/** The 3D view is the page's large piece: it comes after the rest works. */
async function loadScene(): Promise<void> {
  try {
    const { SceneView } = await import('./views/scene');
    if (theme === null) return;
    const view = new SceneView(byId('scene', HTMLCanvasElement), store, api, theme);
    for (const button of document.querySelectorAll<HTMLButtonElement>('[data-preset]')) {
      button.addEventListener('click', () => view.preset(button.dataset['preset'] as Preset));
    }
    const follow = byId('follow', HTMLInputElement);
    follow.addEventListener('change', () => (view.follow = follow.checked));
    scene = view;
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    setText(
      byId('scene-note', HTMLElement),
      `There is no 3D view: ${reason}. Everything else works.`,
    );
  }
}

window.stagger = {
  scene_state: () => ({
    condition: store.condition,
    session_id: store.hello?.sessionId ?? null,
    robot: store.hello?.robot ?? null,
    plant: store.hello?.plant ?? null,
    tick: store.frame?.tick ?? null,
    t: store.frame?.t ?? null,
    frames_received: store.framesReceived,
    frames_dropped: store.framesDropped,
    events: store.events.length,
    scene: scene?.state() ?? null,
    top_view: topView?.state() ?? null,
    plots: plots?.state() ?? null,
    pushes: push.state(),
  }),
};

function draw(nowMs: number): void {
  bar.update();
  events.update();
  values.update(nowMs);
  topView?.update(nowMs);
  plots?.update(nowMs);
  scene?.update(nowMs);
  requestAnimationFrame(draw);
}

stream.start();
requestAnimationFrame(draw);
void loadScene();
