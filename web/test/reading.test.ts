import { describe, expect, it } from 'vitest';
import { Reading } from '../src/reading';

/** A server whose answers come when the test says so. */
function slowServer(): {
  ask: () => Promise<number>;
  answer: (value: number) => Promise<void>;
  fail: (error: Error) => Promise<void>;
  asked: () => number;
} {
  const waiting: { resolve: (value: number) => void; reject: (error: Error) => void }[] = [];
  let asked = 0;
  const settle = async (): Promise<void> => {
    for (let i = 0; i < 5; i += 1) await Promise.resolve();
  };
  return {
    ask: () => {
      asked += 1;
      return new Promise((resolve, reject) => waiting.push({ resolve, reject }));
    },
    answer: async (value) => {
      waiting.shift()?.resolve(value);
      await settle();
    },
    fail: async (error) => {
      waiting.shift()?.reject(error);
      await settle();
    },
    asked: () => asked,
  };
}

describe('Reading', () => {
  it('asks one question at a time', async () => {
    const server = slowServer();
    const seen: number[] = [];
    const reading = new Reading(server.ask, (value) => seen.push(value));
    reading.look();
    reading.look();
    expect(server.asked()).toBe(1);
    await server.answer(1);
    expect(seen).toEqual([1]);
    expect(server.asked()).toBe(1);
    reading.look();
    expect(server.asked()).toBe(2);
  });

  it('asks once more after news, however much of it there was', async () => {
    const server = slowServer();
    const seen: number[] = [];
    const reading = new Reading(server.ask, (value) => seen.push(value));
    reading.look();
    reading.refresh();
    reading.refresh();
    await server.answer(1);
    expect(server.asked()).toBe(2);
    await server.answer(2);
    expect(seen).toEqual([1, 2]);
    expect(server.asked()).toBe(2);
  });

  it('does not use an answer that was asked for before a change of its own', async () => {
    const server = slowServer();
    const seen: number[] = [];
    const reading = new Reading(server.ask, (value) => seen.push(value));
    reading.look();
    reading.replace();
    await server.answer(1);
    await server.answer(2);
    expect(seen).toEqual([2]);
    reading.replace();
    await server.answer(3);
    expect(seen).toEqual([2, 3]);
  });

  it('tells what failed and goes on', async () => {
    const server = slowServer();
    const seen: number[] = [];
    const failures: unknown[] = [];
    const reading = new Reading(server.ask, (value) => seen.push(value), (error) => failures.push(error));
    const away = new Error('away');
    reading.look();
    reading.refresh();
    await server.fail(away);
    await server.answer(2);
    expect(failures).toEqual([away]);
    expect(seen).toEqual([2]);
  });
});
