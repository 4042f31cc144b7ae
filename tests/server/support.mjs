// Starts the real binary on a free port and talks to it. Loopback only; everything is bounded.
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import net from 'node:net';
import crypto from 'node:crypto';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import WebSocket from 'ws';

export const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
export const binary = process.env.STAGGER_BIN ?? path.join(root, 'build/bin/stagger');
// What users make goes to a folder of each test file's own, never to that of whoever runs the tests.
const data = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-data-'));
process.on('exit', () => fs.rmSync(data, { recursive: true, force: true }));
const environment = {
  STAGGER_ROBOTS: path.join(root, 'robots'),
  ...process.env,
  STAGGER_DATA: data,
};
// Sanitizer builds on a loaded machine are many times slower; nothing here waits for the clock.
export const patience = 120_000;
/** For what campaigns of a server do: they get what all others leave of the processor. */
export const longPatience = 300_000;

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Rejects when the promise takes too long, so that a test ends with a name instead of hanging. */
export function within(promise, what, ms = patience) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`${what}: nothing after ${ms} ms`)), ms);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

/** Waits until the (asynchronous) condition gives something truthy; returns that. */
export async function eventually(condition, what, ms = patience) {
  const end = Date.now() + ms;
  for (;;) {
    const result = await condition();
    if (result) return result;
    if (Date.now() > end) throw new Error(`${what}: not within ${ms} ms`);
    await sleep(20);
  }
}

/** Runs a command to its end: {code, stdout, stderr}. */
export async function command(args, input = '', watch = () => {}, variables = {}) {
  const child = spawn(binary, args, { env: { ...environment, ...variables }, stdio: 'pipe' });
  watch(child);
  const output = { stdout: '', stderr: '' };
  child.stdout.on('data', (data) => (output.stdout += data));
  child.stderr.on('data', (data) => (output.stderr += data));
  child.stdin.on('error', () => {}); // a command may end without reading
  child.stdin.end(input);
  const ended = new Promise((resolve) => child.on('close', resolve));
  try {
    return { code: await within(ended, `stagger ${args.join(' ')}`), ...output };
  } finally {
    child.kill('SIGKILL');
  }
}

/** A command that gets SIGINT as soon as it has written to standard error. */
export async function interrupted(args) {
  return command(args, '', (child) => child.stderr.once('data', () => child.kill('SIGINT')));
}

/** A server of its own for a test: `await using` is too new, so end it with end() or kill(). */
export class Server {
  static start(...args) {
    return Server.startWith({}, ...args);
  }
  /** The same with environment variables of its own. */
  static async startWith(variables, ...args) {
    const server = new Server();
    // Where the plant does not matter, the cheap one.
    const plant = args.includes('--plant') ? [] : ['--plant', 'lipm'];
    const all = ['serve', '--port', '0', ...plant, ...args];
    // Recordings of its own, which go with it.
    server.data = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-data-'));
    const env = { ...environment, STAGGER_DATA: server.data, ...variables };
    server.child = spawn(binary, all, { env, stdio: ['ignore', 'pipe', 'pipe'] });
    const data = server.data;
    server.removeData = () => fs.rmSync(data, { recursive: true, force: true });
    server.stderr = '';
    server.child.stderr.on('data', (data) => (server.stderr += data));
    server.ended = new Promise((resolve) =>
      server.child.on('close', (code, signal) => resolve({ code, signal })),
    );
    let stdout = '';
    const url = new Promise((resolve, reject) => {
      server.child.stdout.on('data', (data) => {
        stdout += data;
        const found = /serving on (http:\S+)/.exec(stdout);
        if (found) resolve(found[1]);
      });
      server.ended.then(() => reject(new Error(`the server ended: ${server.stderr}`)));
    });
    url.catch(() => {});
    server.url = await within(url, 'the server');
    server.port = Number(new URL(server.url).port);
    return server;
  }

  /** One request on a connection of its own: {status, headers, text, json}. */
  request(method, target, { body, headers = {} } = {}) {
    const whole = body === undefined || typeof body === 'string' || Buffer.isBuffer(body);
    const text = whole ? body : JSON.stringify(body);
    const all = { ...headers };
    if (text !== undefined) {
      all['content-type'] ??= 'application/json';
      all['content-length'] = Buffer.byteLength(text);
    }
    const answer = new Promise((resolve, reject) => {
      const options = { method, path: target, headers: all, agent: false };
      const request = http.request(`${this.url}`, options, (response) => {
        let received = '';
        response.setEncoding('utf8');
        response.on('data', (data) => (received += data));
        response.on('end', () => {
          let json;
          if (/[/+]json/.test(response.headers['content-type'] ?? '') && received) {
            json = JSON.parse(received);
          }
          resolve({ status: response.statusCode, headers: response.headers, text: received, json });
        });
      });
      request.on('error', reject);
      request.end(text);
    });
    return within(answer, `${method} ${target}`);
  }
  get(target, options) {
    return this.request('GET', target, options);
  }
  post(target, body, options) {
    return this.request('POST', target, { body, ...options });
  }
  async state() {
    return (await this.get('/api/v1/simulation')).json;
  }
  pause() {
    return this.post('/api/v1/simulation/pause');
  }
  step(ticks) {
    return this.post('/api/v1/simulation/step', { ticks });
  }

  stream(options) {
    return Stream.open(this, options);
  }

  /** SIGTERM; {code, signal, ms}. */
  async stop() {
    const start = Date.now();
    this.child.kill('SIGTERM');
    const result = await within(this.ended, 'the end of the server');
    return { ...result, ms: Date.now() - start };
  }
  /** At the end of every test, whatever has happened. */
  async kill() {
    this.child.kill('SIGKILL');
    await this.ended;
    this.removeData();
    this.expectNoReports();
  }
  /** An orderly end, so that sanitizers get to say what they have seen. */
  async end() {
    try {
      const { code, signal } = await this.stop();
      if (code !== 0) throw new Error(`ended with ${code ?? signal}: ${this.stderr}`);
    } finally {
      await this.kill();
    }
  }
  expectNoReports() {
    if (/Sanitizer|runtime error:/.test(this.stderr)) throw new Error(this.stderr);
  }
}

/** A binary data message (docs/stream.md) as the JSON that says the same. */
export function decode(layout, bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (view.getUint8(0) !== 1) throw new Error(`a message of kind ${view.getUint8(0)}`);
  const width = view.getUint8(1);
  const rates = view.getUint16(2, true);
  const count = view.getUint32(4, true);
  const carried = layout.filter(({ rate }) => rates & (1 << rate));
  const lists = carried.filter(({ max_repeat }) => max_repeat > 1);
  const start = Math.ceil((32 + lists.length) / 8) * 8;
  if (bytes.byteLength !== start + count * width) throw new Error('a message of another length');
  let offset = start;
  const next = () => {
    const value = width === 8 ? view.getFloat64(offset, true) : view.getFloat32(offset, true);
    offset += width;
    return Number.isFinite(value) ? value : null;
  };
  const v = {};
  for (const { name, fields, max_repeat } of carried) {
    const repeat = max_repeat > 1 ? view.getUint8(32 + lists.findIndex((l) => l.name === name)) : 1;
    v[name] = Array.from({ length: repeat * fields.length }, next);
  }
  const [seq, tick] = [8, 16].map((at) => Number(view.getBigUint64(at, true)));
  return { op: 'data', seq, tick, t: view.getFloat64(24, true), v };
}

/** A stream client that keeps all messages. */
export class Stream {
  static async open(server, options = {}) {
    const stream = new Stream();
    stream.messages = [];
    const { path: target = '/api/v1/stream', ...rest } = options;
    stream.waiting = new Set();
    stream.socket = new WebSocket(`ws://127.0.0.1:${server.port}${target}`, rest);
    stream.closed = new Promise((resolve) =>
      stream.socket.on('close', (code, reason) => resolve({ code, reason: String(reason) })),
    );
    stream.socket.on('message', (data, isBinary) => {
      stream.messages.push(isBinary ? decode(stream.layout, data) : JSON.parse(data));
      const newest = stream.messages.at(-1);
      if (newest.op === 'subscribed') stream.layout = newest.layout;
      for (const wake of stream.waiting) wake();
    });
    const opened = new Promise((resolve, reject) => {
      stream.socket.on('open', resolve);
      stream.socket.on('error', reject);
    });
    await within(opened, 'the stream');
    return stream;
  }

  send(message) {
    this.socket.send(typeof message === 'string' ? message : JSON.stringify(message));
  }
  /** The messages of that kind so far. */
  all(op) {
    return this.messages.filter((message) => message.op === op);
  }
  /** The first message that fits, whether it has come already or comes yet. */
  first(fits, what = 'a message') {
    let wake;
    const found = new Promise((resolve) => {
      wake = () => {
        const message = this.messages.find(fits);
        if (message) resolve(message);
      };
      this.waiting.add(wake);
      wake();
    });
    return within(found, what).finally(() => this.waiting.delete(wake));
  }
  async subscribe(options = {}) {
    const before = this.all('subscribed').length;
    this.send({ op: 'subscribe', ...options });
    return this.first(
      (message) => message.op === 'subscribed' && this.all('subscribed').length > before,
      'subscribed',
    );
  }
  async close() {
    this.socket.close();
    return within(this.closed, 'the close');
  }
}

/** A client that does the handshake, asks for everything, and then never reads again. */
export async function stalledClient(server, rate_hz = 1000) {
  const socket = net.connect({ host: '127.0.0.1', port: server.port });
  const handshake = [
    'GET /api/v1/stream HTTP/1.1',
    `Host: 127.0.0.1:${server.port}`,
    'Upgrade: websocket',
    'Connection: Upgrade',
    `Sec-WebSocket-Key: ${crypto.randomBytes(16).toString('base64')}`,
    'Sec-WebSocket-Version: 13',
  ];
  const upgraded = new Promise((resolve, reject) => {
    socket.once('error', reject);
    socket.once('data', (data) => {
      socket.pause(); // nothing is read from here on
      /^HTTP\/1.1 101/.test(String(data)) ? resolve() : reject(new Error(String(data)));
    });
  });
  socket.write(handshake.join('\r\n') + '\r\n\r\n');
  await within(upgraded, 'the handshake');
  socket.on('error', () => {});
  const payload = Buffer.from(JSON.stringify({ op: 'subscribe', rate_hz }));
  const mask = crypto.randomBytes(4);
  const masked = Buffer.from(payload.map((byte, i) => byte ^ mask[i % 4]));
  socket.write(Buffer.concat([Buffer.from([0x81, 0x80 | payload.length]), mask, masked]));
  return socket;
}

/** A body of multipart/form-data out of parts [name, content, file name], with its headers. */
export function form(parts) {
  const boundary = 'a-boundary-of-our-own';
  const pieces = parts.flatMap(([name, content, file]) => {
    const filename = file === undefined ? '' : `; filename="${file}"`;
    const head = `--${boundary}\r\nContent-Disposition: form-data; name="${name}"${filename}\r\n\r\n`;
    return [head, content, '\r\n'];
  });
  const body = Buffer.concat([...pieces, `--${boundary}--\r\n`].map((piece) => Buffer.from(piece)));
  return { body, headers: { 'content-type': `multipart/form-data; boundary=${boundary}` } };
}

/** What every error must look like. */
export function isProblem(answer, status) {
  return (
    answer.status === status &&
    /^application\/problem\+json/.test(answer.headers['content-type']) &&
    answer.json.status === status &&
    typeof answer.json.title === 'string' &&
    typeof answer.json.detail === 'string'
  );
}
