import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { Connection, Socket, StreamHandlers } from '../src/stream';
import { Stream, silenceLimitMs, waitBeforeAttempt } from '../src/stream';
import { data, hello } from './messages';

class FakeSocket implements Socket {
  onmessage: Socket['onmessage'] = null;
  onclose: Socket['onclose'] = null;
  readonly sent: string[] = [];
  closed = false;

  send(text: string): void {
    this.sent.push(text);
  }

  close(): void {
    this.closed = true;
  }

  say(message: unknown): void {
    this.onmessage?.({ data: JSON.stringify(message) } as MessageEvent<unknown>);
  }

  end(code: number, reason = ''): void {
    this.onclose?.({ code, reason } as CloseEvent);
  }
}

const beat = { op: 'heartbeat', tick: 1, t: 0.001, running: true, dropped: 0 };

describe('Stream', () => {
  let sockets: FakeSocket[];
  let connections: Connection[];
  let handlers: { [K in keyof StreamHandlers]: ReturnType<typeof vi.fn> };
  let stream: Stream;

  const socket = (): FakeSocket => {
    const last = sockets[sockets.length - 1];
    if (last === undefined) throw new Error('no socket was opened');
    return last;
  };
  const kinds = (): string[] => connections.map((connection) => connection.kind);

  beforeEach(() => {
    vi.useFakeTimers();
    sockets = [];
    connections = [];
    handlers = {
      connection: vi.fn((connection: Connection) => connections.push(connection)),
      hello: vi.fn(),
      data: vi.fn(),
      event: vi.fn(),
      heartbeat: vi.fn(),
      gap: vi.fn(),
      complaint: vi.fn(),
    };
    stream = new Stream(
      {
        url: 'ws://test/stream',
        rateHz: 100,
        channels: ['dcm', 'com'],
        openSocket: () => {
          sockets.push(new FakeSocket());
          return socket();
        },
      },
      handlers,
    );
    stream.start();
  });

  afterEach(() => {
    stream.stop();
    vi.useRealTimers();
  });

  it('is open once hello has come, and subscribes to what the server has', () => {
    expect(kinds()).toEqual(['connecting']);
    socket().say(hello());
    expect(kinds()).toEqual(['connecting', 'open']);
    expect(handlers.hello).toHaveBeenCalledTimes(1);
    expect(socket().sent.map((text) => JSON.parse(text) as unknown)).toEqual([
      { op: 'subscribe', rate_hz: 100, channels: ['dcm'], events: true },
    ]);
  });

  it('subscribes again when the session changes, without a new connection', () => {
    socket().say(hello('a'));
    socket().say(hello('b', ['com']));
    expect(sockets.length).toBe(1);
    expect(handlers.hello).toHaveBeenCalledTimes(2);
    expect(JSON.parse(socket().sent[1] ?? '')).toMatchObject({ channels: ['dcm', 'com'] });
    expect(kinds()).toEqual(['connecting', 'open']);
  });

  it('passes data, events and heartbeats on', () => {
    socket().say(hello());
    socket().say(data(0, 0.01, { dcm: [1, 2] }));
    socket().say({ op: 'event', tick: 10, t: 0.01, kind: 'step', text: 'step 1', values: {} });
    socket().say(beat);
    expect(handlers.data).toHaveBeenCalledWith(
      expect.objectContaining({ tick: 10, v: { dcm: [1, 2] } }),
    );
    expect(handlers.event).toHaveBeenCalledWith(expect.objectContaining({ kind: 'step' }));
    expect(handlers.heartbeat).toHaveBeenCalledWith(expect.objectContaining({ running: true }));
  });

  it('counts dropped messages from the gaps of seq, from the first message on', () => {
    socket().say(hello());
    socket().say(data(5, 0.01));
    socket().say(data(6, 0.02));
    expect(handlers.gap).not.toHaveBeenCalled();
    socket().say(data(10, 0.03));
    expect(handlers.gap).toHaveBeenCalledExactlyOnceWith(3);
    socket().say(hello('b'));
    socket().say(data(0, 0.01));
    socket().say(data(20, 0.01));
    expect(handlers.gap).toHaveBeenLastCalledWith(19);
  });

  it('takes nothing before hello', () => {
    socket().say(data(0, 0.01));
    expect(handlers.data).not.toHaveBeenCalled();
  });

  it('complains about what it does not understand and goes on', () => {
    socket().say(hello());
    socket().say({ op: 'poem' });
    socket().say({ op: 'error', detail: 'no such channel' });
    expect(handlers.complaint).toHaveBeenCalledTimes(2);
    expect(handlers.complaint).toHaveBeenLastCalledWith('no such channel');
    socket().say(data(0, 0.01));
    expect(handlers.data).toHaveBeenCalledTimes(1);
  });

  it('refuses another protocol', () => {
    socket().say({ ...hello(), protocol: 2 });
    expect(handlers.hello).not.toHaveBeenCalled();
    expect(handlers.complaint).toHaveBeenCalledTimes(1);
  });

  it('is lost after three silent heartbeats, not before, and reconnects by itself', () => {
    socket().say(hello());
    for (let i = 0; i < 20; i += 1) {
      vi.advanceTimersByTime(1000);
      socket().say(beat);
    }
    expect(kinds()).toEqual(['connecting', 'open']);
    vi.advanceTimersByTime(silenceLimitMs - 500);
    expect(kinds()).toEqual(['connecting', 'open']);
    const first = socket();
    vi.advanceTimersByTime(1000);
    expect(connections[2]).toMatchObject({ kind: 'lost', reason: 'the server has fallen silent' });
    expect(first.closed).toBe(true);
    vi.advanceTimersByTime(1000);
    expect(sockets.length).toBe(2);
    socket().say(hello('b'));
    expect(kinds().slice(2)).toEqual(['lost', 'connecting', 'open']);
  });

  it('waits longer after each failure, up to a limit, and starts over after a success', () => {
    expect([1, 2, 3, 4, 5, 6, 50].map(waitBeforeAttempt)).toEqual([
      500, 1000, 2000, 4000, 8000, 8000, 8000,
    ]);
    for (const wait of [500, 1000, 2000, 4000, 8000]) {
      const before = sockets.length;
      socket().end(1006);
      const lost = connections[connections.length - 1];
      expect(lost).toMatchObject({ kind: 'lost', retryAt: Date.now() + wait });
      vi.advanceTimersByTime(wait - 1);
      expect(sockets.length).toBe(before);
      vi.advanceTimersByTime(1);
      expect(sockets.length).toBe(before + 1);
    }
    socket().say(hello());
    socket().end(1006);
    expect(connections[connections.length - 1]).toMatchObject({ retryAt: Date.now() + 500 });
  });

  it('says why the server closed', () => {
    const reasons: string[] = [];
    for (const [code, reason] of [
      [1001, ''],
      [1008, ''],
      [1013, ''],
      [1011, 'out of memory'],
      [1006, ''],
    ] as const) {
      socket().end(code, reason);
      const lost = connections[connections.length - 1];
      reasons.push(lost?.kind === 'lost' ? lost.reason : '');
      stream.retryNow();
    }
    expect(reasons).toEqual([
      'the server stopped',
      'the server did not understand this page',
      'this page was too slow for the server',
      'out of memory',
      'the server does not answer',
    ]);
  });

  it('tries at once when asked, and only once', () => {
    socket().end(1006);
    stream.retryNow();
    stream.retryNow();
    expect(sockets.length).toBe(2);
    vi.advanceTimersByTime(400);
    expect(sockets.length).toBe(2);
  });

  it('does not take a long sleep of its own tab for a silent server', () => {
    socket().say(hello());
    // The tab's clock jumps: no timer ran meanwhile, and the messages still wait to be read.
    vi.setSystemTime(Date.now() + 60_000);
    vi.advanceTimersByTime(500);
    socket().say(beat);
    vi.advanceTimersByTime(500);
    expect(kinds()).toEqual(['connecting', 'open']);
  });

  it('gives up a server that never says hello', () => {
    vi.advanceTimersByTime(6000);
    expect(kinds()).toContain('lost');
  });

  it('does not hear a socket that it has left', () => {
    const old = socket();
    const say = old.onmessage;
    old.end(1006);
    stream.retryNow();
    socket().say(hello());
    say?.({ data: JSON.stringify(data(0, 9)) } as MessageEvent<unknown>);
    expect(handlers.data).not.toHaveBeenCalled();
  });

  it('stops for good', () => {
    socket().say(hello());
    stream.stop();
    expect(socket().closed).toBe(true);
    vi.advanceTimersByTime(60_000);
    expect(sockets.length).toBe(1);
  });

  it('brings the ticket that it is given, and none that comes too late', async () => {
    stream.stop();
    const urls: string[] = [];
    const tickets: ((ticket: string) => void)[] = [];
    const other = new Stream(
      {
        url: 'ws://test/stream',
        rateHz: 100,
        channels: [],
        openSocket: (url) => {
          urls.push(url);
          return new FakeSocket();
        },
        ticket: () => new Promise((resolve) => tickets.push(resolve)),
      },
      handlers,
    );
    other.start();
    expect(urls).toEqual([]);
    tickets[0]?.('a b');
    await vi.advanceTimersByTimeAsync(0);
    expect(urls).toEqual(['ws://test/stream?ticket=a%20b']);
    other.start();
    other.stop();
    tickets[1]?.('late');
    await vi.advanceTimersByTimeAsync(0);
    expect(urls).toHaveLength(1);
  });

  it('tries again when there is no ticket', async () => {
    stream.stop();
    connections.length = 0;
    const other = new Stream(
      {
        url: 'ws://test/stream',
        rateHz: 100,
        channels: [],
        openSocket: () => new FakeSocket(),
        ticket: () => Promise.reject(new Error('a key is needed')),
      },
      handlers,
    );
    other.start();
    await vi.advanceTimersByTimeAsync(0);
    expect(connections.map((connection) => connection.kind)).toEqual(['connecting', 'lost']);
    expect(connections[1]).toMatchObject({ reason: 'a key is needed' });
    other.stop();
  });
});
