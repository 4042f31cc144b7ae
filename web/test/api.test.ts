import { afterEach, describe, expect, it, vi } from 'vitest';
import { Api, Problem, parseRobot, problemFrom } from '../src/api';
import { parsePush } from '../src/push_body';

describe('problemFrom', () => {
  it('reads RFC 9457 and puts each field into one line', () => {
    const problem = problemFrom(
      422,
      JSON.stringify({
        type: 'about:blank',
        title: 'Invalid request',
        status: 422,
        detail: '2 fields are not as they should be',
        errors: [
          { pointer: '/impulse_ns', detail: 'is -3; allowed: more than 0 to 200 N s' },
          { pointer: '/trigger/fraction', detail: 'is 2; allowed: 0 to less than 1' },
        ],
      }),
    );
    expect(problem.lines()).toEqual([
      'impulse_ns is -3; allowed: more than 0 to 200 N s',
      'trigger.fraction is 2; allowed: 0 to less than 1',
    ]);
  });

  it('says title and detail when no field is to blame', () => {
    const problem = problemFrom(409, '{"title":"Conflict","detail":"the simulation runs"}');
    expect(problem.lines()).toEqual(['Conflict: the simulation runs']);
  });

  it('copes with an answer that is no problem document', () => {
    expect(problemFrom(502, '<html>').lines()).toEqual(['The server answered 502']);
  });
});

describe('parsePush', () => {
  it('takes the direction from the vector that the server resolved', () => {
    const push = parsePush({
      id: 7,
      state: 'done',
      start_tick: 12,
      spec: { link: 'torso', direction: [0, -1, 0], impulse_ns: 15, duration_s: 0.1 },
      delivered_ns: [0, -15, 0],
    });
    expect(push.directionDeg).toBe(-90);
    expect(push.deliveredNs).toBe(15);
    expect(push.startTick).toBe(12);
  });
});

describe('parseRobot', () => {
  it('takes the sole of the paper where the server tells none', () => {
    expect(parseRobot({ name: 'r' }).sole).toEqual({ lengthM: 0.15, widthM: 0.075 });
    const sole = { length_m: 0.2, width_m: 0.1 };
    expect(parseRobot({ name: 'r', sole }).sole).toEqual({ lengthM: 0.2, widthM: 0.1 });
  });

  it('takes links as names or as objects with a name', () => {
    expect(parseRobot({ links: ['a', { name: 'b' }, 3] }).links).toEqual(['a', 'b']);
  });
});

describe('Api', () => {
  afterEach(() => vi.unstubAllGlobals());

  it('posts JSON and reads the answer', async () => {
    const fetched = vi.fn<(path: string, request: RequestInit) => Promise<Response>>(() =>
      Promise.resolve(new Response('{"tick":12,"time_s":0.012}')),
    );
    vi.stubGlobal('fetch', fetched);
    expect(await new Api().step(3)).toEqual({ tick: 12, timeS: 0.012 });
    const [path, request] = fetched.mock.calls[0] ?? [];
    expect(path).toBe('/api/v1/simulation/step');
    expect(request).toMatchObject({
      method: 'POST',
      headers: { 'Content-Type': 'application/json' },
      body: '{"ticks":3}',
    });
  });

  it('throws the problem of the server', async () => {
    vi.stubGlobal('fetch', () =>
      Promise.resolve(new Response('{"title":"Conflict","detail":"pause first"}', { status: 409 })),
    );
    const error = await new Api().step(1).catch((caught: unknown) => caught);
    expect(error).toBeInstanceOf(Problem);
    expect(error).toMatchObject({ status: 409, detail: 'pause first' });
  });

  it('says so when nobody answers', async () => {
    vi.stubGlobal('fetch', () => Promise.reject(new TypeError('connection refused')));
    await expect(new Api().pause()).rejects.toThrow('The server does not answer');
  });
});

describe('a key', () => {
  afterEach(() => vi.unstubAllGlobals());

  const answers = (status: number): ReturnType<typeof vi.fn> => {
    const fetched = vi.fn(() => Promise.resolve(new Response('{"ticket":"t"}', { status })));
    vi.stubGlobal('fetch', fetched);
    return fetched;
  };
  const sent = (fetched: ReturnType<typeof vi.fn>): Record<string, string> =>
    (fetched.mock.calls[0]?.[1] as { headers: Record<string, string> }).headers;

  it('goes with every request, in a header', async () => {
    const fetched = answers(200);
    const api = new Api('/api/v1', () => 'secret');
    expect(await api.ticket()).toBe('t');
    expect(fetched.mock.calls[0]?.[0]).toBe('/api/v1/tickets');
    expect(sent(fetched)).toMatchObject({ Authorization: 'Bearer secret' });
  });

  it('is left out when there is none', async () => {
    const fetched = answers(200);
    await new Api().simulation();
    expect(sent(fetched)).toEqual({});
  });

  it('is asked for when the server wants one', async () => {
    answers(401);
    const refused = vi.fn();
    await expect(new Api('/api/v1', () => '', refused).simulation()).rejects.toThrow(Problem);
    expect(refused).toHaveBeenCalledOnce();
  });
});
