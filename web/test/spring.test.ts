import { describe, expect, it } from 'vitest';
import { parsePush } from '../src/push_body';
import type { PushResource } from '../src/push_body';
import type { PushBody } from '../src/push_request';
import { SpringPull, pieceS } from '../src/spring';

describe('SpringPull', () => {
  it('sends the force of a piece as its impulse, and records when it began', async () => {
    const sent: PushBody[] = [];
    const push = (body: PushBody): Promise<PushResource> => {
      sent.push(body);
      return Promise.resolve(parsePush({ id: 1, tick: 2345, spec: body }));
    };
    const grip = { link: 'torso', point: [0, 0, 0.1] } as const;
    const pull = new SpringPull({ push }, grip, () => undefined, () => Promise.resolve());
    pull.pull([30, 40, 0]);
    await pull.end();
    const body = {
      link: 'torso',
      point: [0, 0, 0.1],
      direction: [0.6, 0.8, 0],
      impulse_ns: 50 * pieceS,
      duration_s: pieceS,
      profile: 'rectangular',
    };
    expect(sent).toEqual([body]);
    expect(pull.pieces).toEqual([{ id: 1, body: { ...body, at_s: 2.345 } }]);
    expect(pull.impulseNs).toBe(50 * pieceS);
  });

  it('goes on from the end of the piece before', async () => {
    const sent: PushBody[] = [];
    let pull: SpringPull | null = null;
    let waits = 0;
    pull = new SpringPull(
      {
        push: (body: PushBody) => {
          sent.push(body);
          return Promise.resolve(parsePush({ id: sent.length, tick: 1000, spec: body }));
        },
      },
      { link: null, point: null },
      () => undefined,
      () => {
        waits += 1;
        if (waits === 4) void pull?.end();
        return Promise.resolve();
      },
    );
    pull.pull([10, 0, 0]);
    await new Promise((resolve) => setTimeout(resolve, 5));
    expect(sent.map((body) => body.at_s)).toEqual([undefined, 1.1, 1.2, 1.3]);
    expect(sent.every((body) => body.link === undefined)).toBe(true);
  });

  it('tells of a push that was refused, and ends', async () => {
    const errors: unknown[] = [];
    const pull = new SpringPull(
      { push: () => Promise.reject(new Error('no')) },
      { link: null, point: null },
      (error) => errors.push(error),
      () => Promise.resolve(),
    );
    pull.pull([10, 0, 0]);
    await pull.end();
    expect(errors).toHaveLength(1);
  });
});
