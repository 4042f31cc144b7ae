// What a hostile client does to a server, for the test and for the bench. Loopback only. Each attack
// returns what ends it; none expects an answer.
import crypto from 'node:crypto';
import net from 'node:net';
import { sleep } from './support.mjs';

/** A raw connection that bears whatever the server does to it. */
export function connect(server) {
  const socket = net.connect({ host: '127.0.0.1', port: server.port });
  socket.on('error', () => {});
  return socket;
}

/** Sends raw bytes on a connection of its own; all that comes until the server ends it. */
export function raw(server, bytes, ms = 20_000) {
  return new Promise((resolve) => {
    const socket = connect(server);
    let text = '';
    const timer = setTimeout(() => socket.destroy(), ms);
    socket.on('data', (data) => (text += data.toString('latin1')));
    socket.on('close', () => {
      clearTimeout(timer);
      resolve(text);
    });
    socket.write(bytes);
  });
}

export const status = (text) => Number(/^HTTP\/1\.1 (\d+)/.exec(text)?.[1] ?? 0);

export const host = (server) => `Host: 127.0.0.1:${server.port}\r\n`;

/** Many connections that do something every now and then, until they are ended. */
function crowd(server, count, greet, drip, every_ms = 200) {
  let running = true;
  const sockets = new Set();
  const enter = () => {
    const socket = connect(server);
    sockets.add(socket);
    socket.on('connect', () => greet(socket));
    // Who is thrown out comes again, but does not make this machine busy with that alone.
    socket.on('close', () => {
      sockets.delete(socket);
      if (running) setTimeout(() => running && enter(), 100).unref();
    });
  };
  // Some at a time: all at once, this process would be the one that is slow.
  let entered = 0;
  const door = setInterval(() => {
    for (let i = 0; i < 25 && entered < count; ++i, ++entered) enter();
    if (entered === count) clearInterval(door);
  }, 20);
  const timer = setInterval(() => {
    for (const socket of sockets) if (socket.writable) drip(socket);
  }, every_ms);
  return () => {
    running = false;
    clearInterval(door);
    clearInterval(timer);
    for (const socket of sockets) socket.destroy();
  };
}

/** Heads that never end, a byte at a time. */
export const slowHeads = (server, count) =>
  crowd(server, count, (socket) => socket.write(`GET / HTTP/1.1\r\n${host(server)}X: `),
    (socket) => socket.write('x'));

const slowBodiesOf = (length) => (server, count) =>
  crowd(server, count,
    (socket) =>
      socket.write(`POST /api/v1/pushes HTTP/1.1\r\n${host(server)}` +
        `Content-Type: application/json\r\nContent-Length: ${length}\r\n\r\n{`),
    (socket) => socket.write(' '));

/** Bodies that never end, a byte at a time: such as any command could have, and longer ones. */
export const slowBodies = slowBodiesOf(1000);
export const slowLongBodies = slowBodiesOf(100_000);

/** Chunks that never end. */
export const slowChunks = (server, count) =>
  crowd(server, count,
    (socket) =>
      socket.write(`POST /api/v1/pushes HTTP/1.1\r\n${host(server)}` +
        'Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n'),
    (socket) => socket.write('1\r\n \r\n'));

/** Ask for much, and take none of it. */
export const slowReaders = (server, count) =>
  crowd(server, count,
    (socket) => {
      socket.pause();
      const one = `GET /api/v1/robots HTTP/1.1\r\n${host(server)}\r\n`;
      socket.write(one.repeat(900));
    },
    () => {});

/** Connections that say nothing at all. */
export const silent = (server, count) => crowd(server, count, () => {}, () => {});

/** Come and go: some ask and leave, some leave at once, some are cut off. */
export async function quickConnections(server, count, at_once = 50) {
  let left = count;
  const one = (kind) =>
    new Promise((resolve) => {
      const socket = connect(server);
      const timer = setTimeout(() => socket.destroy(), 10_000);
      socket.on('close', () => {
        clearTimeout(timer);
        resolve();
      });
      socket.on('connect', () => {
        if (kind === 0) {
          socket.resume();
          socket.end(`GET /health HTTP/1.1\r\n${host(server)}Connection: close\r\n\r\n`);
        } else if (kind === 1) {
          socket.destroy();
        } else {
          socket.write('GET /hea');
          socket.resetAndDestroy();
        }
      });
    });
  const worker = async () => {
    while (left > 0) await one(left-- % 3);
  };
  await Promise.all(Array.from({ length: at_once }, worker));
}

const frame = (first, length, payload = Buffer.alloc(0), masked = true) => {
  const head = Buffer.alloc(10);
  head[0] = first;
  head[1] = (masked ? 0x80 : 0) | 127;
  head.writeBigUInt64BE(BigInt(length), 2);
  return Buffer.concat([head, Buffer.alloc(masked ? 4 : 0), payload]);
};

/** Frames as no honest client sends them. */
export const badFrames = {
  'an endless length': frame(0x81, 2n ** 62n, Buffer.from('{}')),
  'a length with the sign bit': frame(0x81, 2n ** 63n + 1n),
  'more than may be': frame(0x82, 8 << 20, Buffer.alloc(64 << 10)),
  'a frame that stops in mid-head': Buffer.from([0x81]),
  'a frame that stops in mid-payload': frame(0x81, 1000, Buffer.from('{"op":')),
  'no mask': frame(0x81, 2, Buffer.from('{}'), false),
  'a reserved kind': frame(0x83, 2, Buffer.from('{}')),
  'reserved bits': frame(0xf1, 2, Buffer.from('{}')),
  'a long ping': frame(0x89, 5000, Buffer.alloc(5000)),
  'a ping in pieces': frame(0x09, 2, Buffer.from('{}')),
  'a continuation of nothing': frame(0x80, 2, Buffer.from('{}')),
  'a message that never ends': Buffer.concat([
    frame(0x01, 1, Buffer.from('{')),
    ...Array.from({ length: 2000 }, () => frame(0x00, 1024, Buffer.alloc(1024, 32))),
  ]),
  'what is not UTF-8': frame(0x81, 4, Buffer.from([0xff, 0xfe, 0x80, 0xc0])),
};

/** Opens a stream by hand and sends the bytes behind the handshake. */
export async function sendFrames(server, bytes, stay_ms) {
  const socket = connect(server);
  socket.resume();
  const closed = new Promise((resolve) => socket.on('close', resolve));
  socket.write(
    `GET /api/v1/stream HTTP/1.1\r\n${host(server)}Upgrade: websocket\r\nConnection: Upgrade\r\n` +
      `Sec-WebSocket-Key: ${crypto.randomBytes(16).toString('base64')}\r\n` +
      'Sec-WebSocket-Version: 13\r\n\r\n',
  );
  socket.write(bytes);
  await Promise.race([closed, sleep(stay_ms)]);
  socket.destroy();
}

/** Asks for the server's health again and again: how often, how it went, the longest wait [ms]. */
export function healthyClient(server) {
  const seen = { answered: 0, failed: [], longest_ms: 0 };
  let running = true;
  const done = (async () => {
    while (running) {
      const start = performance.now();
      try {
        const answer = await server.get('/api/v1/simulation');
        if (answer.status === 200) seen.answered += 1;
        else seen.failed.push(answer.status);
      } catch (error) {
        seen.failed.push(String(error));
      }
      seen.longest_ms = Math.max(seen.longest_ms, performance.now() - start);
      await sleep(20);
    }
  })();
  return async () => {
    running = false;
    await done;
    return seen;
  };
}
