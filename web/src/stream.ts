// The WebSocket to the server: connects, subscribes, notices silence, reconnects ever more slowly.

import type { Data, Heartbeat, Hello, StreamEvent } from './protocol';
import { parseMessage } from './protocol';

/** How the connection stands. `open` means that hello has come. */
export type Connection =
  | { readonly kind: 'connecting' }
  | { readonly kind: 'open' }
  | { readonly kind: 'lost'; readonly reason: string; readonly retryAt: number };

export interface StreamHandlers {
  connection(connection: Connection): void;
  hello(hello: Hello): void;
  data(data: Data): void;
  event(event: StreamEvent): void;
  heartbeat(heartbeat: Heartbeat): void;
  /** That many data messages of this client were dropped by the server. */
  gap(count: number): void;
  /** The server refused something or spoke another language. */
  complaint(text: string): void;
}

/** What is used of a WebSocket: tests give their own. */
export interface Socket {
  onmessage: ((event: MessageEvent<unknown>) => void) | null;
  onclose: ((event: CloseEvent) => void) | null;
  send(text: string): void;
  close(): void;
}

export interface StreamOptions {
  readonly url: string;
  readonly rateHz: number;
  /** Channels that the page uses; those that the server does not have are left out. */
  readonly channels: readonly string[];
  readonly openSocket: (url: string) => Socket;
  /** Fetches the ticket that the server wants in the address; none is sent without this. */
  readonly ticket?: () => Promise<string>;
}

/** The server sends a heartbeat each second; three missed ones mean that it is gone. */
export const silenceLimitMs = 3500;
const watchPeriodMs = 500;
/** A connection that has not brought hello by then is given up. */
const helloLimitMs = 5000;
const firstWaitMs = 500;
const longestWaitMs = 8000;

/** Wait before the n-th attempt in a row [ms]: doubles from 0.5 s to 8 s. */
export function waitBeforeAttempt(failures: number): number {
  return Math.min(longestWaitMs, firstWaitMs * 2 ** Math.max(0, failures - 1));
}

function closeReason(code: number, reason: string): string {
  if (code === 1001) return 'the server stopped';
  if (code === 1008) return 'the server did not understand this page';
  if (code === 1013) return 'this page was too slow for the server';
  return reason !== '' ? reason : 'the server does not answer';
}

export class Stream {
  private socket: Socket | null = null;
  private open = false;
  private failures = 0;
  /** Counts, so that a ticket that comes too late opens nothing. */
  private attempt = 0;
  private rateHz: number;
  private published: readonly string[] = [];
  private lastSeq: number | null = null;
  private lastHeard = 0;
  private lastWatched = 0;
  private retryTimer: ReturnType<typeof setTimeout> | null = null;
  private watchTimer: ReturnType<typeof setInterval> | null = null;

  constructor(
    private readonly options: StreamOptions,
    private readonly handlers: StreamHandlers,
  ) {
    this.rateHz = options.rateHz;
  }

  start(): void {
    this.stop();
    this.connect();
    this.lastWatched = Date.now();
    this.watchTimer = setInterval(() => this.watch(), watchPeriodMs);
  }

  stop(): void {
    if (this.watchTimer !== null) clearInterval(this.watchTimer);
    this.watchTimer = null;
    this.cancelRetry();
    this.drop();
  }

  /** Asks for so many frames a second of simulation time from now on. */
  setRate(rateHz: number): void {
    this.rateHz = rateHz;
    if (this.open) this.subscribe();
  }

  /** Tries at once instead of waiting. */
  retryNow(): void {
    if (this.retryTimer === null) return;
    this.cancelRetry();
    this.connect();
  }

  private connect(): void {
    this.open = false;
    this.lastSeq = null;
    this.lastHeard = Date.now();
    this.handlers.connection({ kind: 'connecting' });
    const { ticket, url } = this.options;
    if (ticket === undefined) {
      this.openSocket(url);
      return;
    }
    this.attempt += 1;
    const { attempt } = this;
    ticket().then(
      (text) => {
        if (attempt === this.attempt) this.openSocket(`${url}?ticket=${encodeURIComponent(text)}`);
      },
      (error: unknown) => {
        const reason = error instanceof Error ? error.message : 'the server does not answer';
        if (attempt === this.attempt) this.lose(reason);
      },
    );
  }

  private openSocket(url: string): void {
    let socket: Socket;
    try {
      socket = this.options.openSocket(url);
    } catch (error) {
      this.lose(error instanceof Error ? error.message : 'the address is not valid');
      return;
    }
    this.socket = socket;
    socket.onmessage = (event) => {
      if (socket === this.socket && typeof event.data === 'string') this.receive(event.data);
    };
    socket.onclose = (event) => {
      if (socket === this.socket) this.lose(closeReason(event.code, event.reason));
    };
  }

  private receive(text: string): void {
    this.lastHeard = Date.now();
    const message = parseMessage(text);
    if (message === null) {
      this.handlers.complaint('The server sent a message that this page does not know.');
      return;
    }
    if (message.op === 'hello') {
      this.welcome(message);
      return;
    }
    if (!this.open) return;
    switch (message.op) {
      case 'data':
        if (this.lastSeq !== null && message.seq > this.lastSeq + 1) {
          this.handlers.gap(message.seq - this.lastSeq - 1);
        }
        this.lastSeq = message.seq;
        this.handlers.data(message);
        break;
      case 'event':
        this.handlers.event(message);
        break;
      case 'heartbeat':
        this.handlers.heartbeat(message);
        break;
      case 'error':
        this.handlers.complaint(message.detail);
        break;
      case 'subscribed':
        break;
    }
  }

  private welcome(hello: Hello): void {
    this.published = hello.channels.map((channel) => channel.name);
    this.lastSeq = null;
    this.failures = 0;
    this.handlers.hello(hello);
    this.subscribe();
    if (!this.open) {
      this.open = true;
      this.handlers.connection({ kind: 'open' });
    }
  }

  private subscribe(): void {
    this.lastSeq = null;
    this.socket?.send(
      JSON.stringify({
        op: 'subscribe',
        rate_hz: this.rateHz,
        channels: this.options.channels.filter((name) => this.published.includes(name)),
        events: true,
      }),
    );
  }

  private watch(): void {
    const now = Date.now();
    const late = now - this.lastWatched > 3 * watchPeriodMs;
    this.lastWatched = now;
    // After a long sleep of this tab the messages that have come meanwhile are still to be read.
    if (late) {
      this.lastHeard = Math.max(this.lastHeard, now - watchPeriodMs);
      return;
    }
    if (this.socket === null) return;
    const limit = this.open ? silenceLimitMs : helloLimitMs;
    if (now - this.lastHeard > limit) this.lose('the server has fallen silent');
  }

  private lose(reason: string): void {
    this.drop();
    this.failures += 1;
    const wait = waitBeforeAttempt(this.failures);
    this.cancelRetry();
    this.retryTimer = setTimeout(() => {
      this.retryTimer = null;
      this.connect();
    }, wait);
    this.handlers.connection({ kind: 'lost', reason, retryAt: Date.now() + wait });
  }

  private drop(): void {
    const socket = this.socket;
    this.attempt += 1;
    this.socket = null;
    this.open = false;
    if (socket === null) return;
    socket.onmessage = null;
    socket.onclose = null;
    socket.close();
  }

  private cancelRetry(): void {
    if (this.retryTimer !== null) clearTimeout(this.retryTimer);
    this.retryTimer = null;
  }
}
