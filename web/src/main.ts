// Wires store, stream, views and panels together and draws once an animation frame.

import 'uplot/dist/uPlot.min.css';
import { Api, linesOf } from './api';
import { byId, setText } from './dom';
import { KeyPrompt, tabStore } from './key';
import { csvOf, download, pictureOf } from './export';
import { Keys } from './keys';
import { Pace } from './pace';
import { CampaignsPanel } from './panels/campaigns';
import { ConditionBar } from './panels/condition';
import { EventsPanel } from './panels/events';
import { ExplainPanel } from './panels/explain';
import { HelpPanel } from './panels/help';
import { PushPanel } from './panels/push';
import { RobotsPanel } from './panels/robots';
import { RunsPanel } from './panels/runs';
import { StepsPanel } from './panels/steps';
import { SimulationPanel } from './panels/simulation';
import { TrialPanel } from './panels/trial';
import { TuningPanel } from './panels/tuning';
import { ValuesPanel } from './panels/values';
import { WalkPanel } from './panels/walk';
import { PushForm } from './push_form';
import { Reading } from './reading';
import { Store, historySeconds, rateHz, usedChannels } from './store';
import { Stream } from './stream';
import { Tabs } from './tabs';
import { ThemeSwitch } from './theme';
import type { Theme } from './theme';
import type { AimMode } from './views/aim';
import type { Layer } from './views/ground_marks';
import type { Role } from './views/plot_specs';
import { Plots } from './views/plots';
import type { Preset, SceneView } from './views/scene';
import { TimeWindow } from './views/time_window';
import { Timeline } from './views/timeline';
import { TopView } from './views/top_view';

declare global {
  interface Window {
    /** The numbers that are really drawn, for tests and for the curious. */
    stagger: { scene_state(): Record<string, unknown> };
  }
}

/** What the server's world is: everything that commands it goes by this. */
const store = new Store();
/** What the views show: the same, or a run that is replayed. */
const shown = new Store();
const prompt = new KeyPrompt(tabStore);
const api = new Api('/api/v1', () => tabStore.read(), () => prompt.ask());
const keys = new Keys();
const pace = new Pace();
const address = new URL('/api/v1/stream', window.location.href);
address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';

const stream = new Stream(
  {
    url: address.href,
    rateHz,
    channels: usedChannels,
    openSocket: (url) => new WebSocket(url),
    ticket: () => api.ticket(),
  },
  {
    connection: (connection) => store.setConnection(connection),
    hello: (hello) => {
      pace.restart();
      store.setHello(hello);
      robotReading.replace();
    },
    data: (data) => {
      store.setFrame(data);
      runs.look();
      pace.received(performance.now());
    },
    event: (event) => store.addEvent(event),
    heartbeat: (heartbeat) => store.hearRunning(heartbeat.running, performance.now()),
    gap: (count) => store.addDropped(count),
    complaint: (text) => setText(byId('transport-error', HTMLElement), text),
  },
);
store.on('running', () => pace.restart());
store.on('simulation', () => {
  const { simulation: told, frame } = store;
  if (told !== null && frame !== null && told.running) pace.compared(told.timeS, frame.t);
});

/** The robot of this session, and those that can be chosen. */
const robotReading = new Reading(
  () => Promise.all([api.robot(store.hello?.robot ?? ''), api.robots()]),
  ([robot, robots]) => {
    store.setRobot(robot);
    store.setRobots(robots);
  },
  (error) =>
    setText(
      byId('scene-note', HTMLElement),
      `The robot's description did not load. ${linesOf(error).join(' ')}`,
    ),
);

const themes = new ThemeSwitch();
let theme: Theme | null = null;
themes.follow((next) => (theme = next));
if (theme === null) throw new Error('the page has no theme');
const firstTheme: Theme = theme;

const times = new TimeWindow(historySeconds);
const topView = new TopView(byId('top-view', HTMLCanvasElement), shown, firstTheme);
const plots = new Plots(shown, firstTheme, times);
const timeline = new Timeline(
  byId('timeline', HTMLCanvasElement),
  shown,
  firstTheme,
  times,
  plots,
);
const runs = new RunsPanel(store, shown, api, { topView, plots, times });
let scene: SceneView | null = null;
runs.onReplay = (replaying) => {
  document.body.dataset['shows'] = replaying ? 'replay' : 'live';
  if (scene !== null) scene.aiming = !replaying;
};
runs.onOther = (other) => scene?.showGhost(other);
themes.follow((next) => {
  scene?.setTheme(next);
  topView.setTheme(next);
  plots.setTheme(next);
  timeline.setTheme(next);
});

const tabs = new Tabs('control-tabs');
const values = new ValuesPanel(shown);
const events = new EventsPanel(store);
const form = new PushForm(store);
const push = new PushPanel(store, api, form, keys);
const simulation = new SimulationPanel(store, api, keys);
const trial = new TrialPanel(store, api, push, form);
new WalkPanel(store, api, keys, () => simulation.commanded());
const explain = new ExplainPanel(store, shown, api);
const tuning = new TuningPanel(store, api);
const robots = new RobotsPanel(store, api);
const campaigns = new CampaignsPanel(store, api);
const steps = new StepsPanel(store, api, topView, () => simulation.commanded());
const bar = new ConditionBar(store, stream, (text) => events.announce(text));

const press = (id: string, run: () => void): void =>
  byId(id, HTMLButtonElement).addEventListener('click', run);
press('zoom-in', () => topView.zoom(1.25));
press('zoom-out', () => topView.zoom(0.8));
press('top-follow', () => topView.follow());
press('plot-closer', () => zoomPlots(0.5));
press('plot-wider', () => zoomPlots(2));
press('plot-now', () => {
  setFrozen(false);
  times.reset();
  plots.redraw();
});
press('plot-freeze', () => setFrozen(!plots.isFrozen));
press('plot-csv', () => {
  const text = csvOf(plots.table, times.range(plots.newest));
  download('stagger.csv', new Blob([text], { type: 'text/csv' }));
});
press('plot-png', () => {
  const heading = `${byId('bar-robot', HTMLElement).textContent ?? ''}, seed ${shown.hello?.seed ?? ''}`;
  void pictureOf(plots.shown, heading, theme ?? firstTheme).then((picture) =>
    download('stagger.png', picture),
  );
});
for (const button of document.querySelectorAll<HTMLButtonElement>('[data-role]')) {
  button.addEventListener('click', () => {
    const on = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', String(on));
    plots.toggle(button.dataset['role'] as Role, on);
  });
}
const themeButton = byId('theme', HTMLButtonElement);
const showTheme = (): void => setText(themeButton, `Theme: ${themes.current}`);
const nextTheme = (): void => {
  themes.next();
  showTheme();
};
themeButton.addEventListener('click', nextTheme);
showTheme();

function zoomPlots(factor: number): void {
  times.zoom(factor, null, plots.newest);
  plots.redraw();
}

function setFrozen(frozen: boolean): void {
  plots.setFrozen(frozen);
  byId('plot-freeze', HTMLButtonElement).setAttribute('aria-pressed', String(frozen));
}

const follow = byId('follow', HTMLInputElement);
keys.add({
  key: 'f',
  group: 'View',
  text: 'Follow the robot, or not',
  run: () => follow.click(),
});
(['behind', 'side', 'front', 'top'] as const).forEach((preset, i) => {
  keys.add({
    key: String(i + 1),
    group: 'View',
    text: `Look from ${preset === 'top' ? 'above' : preset === 'front' ? 'the front' : preset === 'side' ? 'the side' : 'behind'}`,
    run: () => scene?.preset(preset),
  });
});
keys.add({ key: 'g', group: 'View', text: 'Freeze the plots', run: () => setFrozen(!plots.isFrozen) });
keys.add({ key: 't', group: 'Page', text: 'Light, dark, or as the system', run: nextTheme });
let tabNumber = 0;
keys.add({
  key: ']',
  group: 'Page',
  text: 'Next panel',
  run: () => tabs.showNumber((tabNumber = (tabNumber + 1) % tabs.count)),
});
new HelpPanel(keys);

/** The 3D view is the page's large piece: it comes after the rest works. */
async function loadScene(): Promise<void> {
  try {
    const { SceneView } = await import('./views/scene');
    const canvas = byId('scene', HTMLCanvasElement);
    const view = new SceneView(canvas, shown, api, theme ?? firstTheme, push);
    push.onAimDone = () => view.clearAim();
    for (const button of document.querySelectorAll<HTMLButtonElement>('[data-preset]')) {
      button.addEventListener('click', () => view.preset(button.dataset['preset'] as Preset));
    }
    const modes = document.querySelectorAll<HTMLButtonElement>('[data-mode]');
    for (const button of modes) {
      button.addEventListener('click', () => {
        for (const one of modes) one.setAttribute('aria-pressed', String(one === button));
        view.setMode(button.dataset['mode'] as AimMode);
      });
    }
    for (const box of document.querySelectorAll<HTMLInputElement>('[data-layer]')) {
      box.addEventListener('change', () => view.show(box.dataset['layer'] as Layer, box.checked));
    }
    follow.addEventListener('change', () => (view.follow = follow.checked));
    view.follow = follow.checked;
    view.aiming = !runs.replaying;
    view.showGhost(runs.otherStore);
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
    theme: theme?.name ?? null,
    session_id: store.hello?.sessionId ?? null,
    robot: store.hello?.robot ?? null,
    plant: store.hello?.plant ?? null,
    tick: store.frame?.tick ?? null,
    t: store.frame?.t ?? null,
    frames_received: store.framesReceived,
    frames_dropped: store.framesDropped,
    events: store.events.length,
    behind_ms: store.behindMs,
    rate_hz: pace.rateHz,
    scene: scene?.state() ?? null,
    top_view: topView.state(),
    plots: plots.state(),
    timeline: timeline.state(),
    pushes: push.state(),
    trial: trial.state(),
    steps: steps.state(),
    explain: explain.state(),
    runs: runs.state(),
    tuning: tuning.state(),
    robots: robots.state(),
    campaigns: campaigns.state(),
  }),
};

/** What was drawn is compared with what must have happened by now. */
function keepPace(nowMs: number): void {
  const { frame, running } = store;
  if (frame === null || running !== true || document.hidden) return;
  const rate = pace.drawn(nowMs);
  store.behindMs = pace.behindMs;
  if (rate !== null) stream.setRate(rate);
}

function draw(nowMs: number): void {
  runs.update(nowMs);
  bar.update(topView.state());
  events.update();
  values.update(nowMs);
  explain.update(nowMs);
  topView.update(nowMs);
  plots.update(nowMs);
  timeline.update(nowMs);
  scene?.update(nowMs);
  keepPace(performance.now());
  requestAnimationFrame(draw);
}

stream.start();
requestAnimationFrame(draw);
void loadScene();
