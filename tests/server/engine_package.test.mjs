// The engine as others get it: installed, found by an outside project, linked into a controller.
// Each build is tried with the flags that it was made with: a sanitizer's library would not link
// into a program without them, nor one for another instruction set.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { binary, command, root } from './support.mjs';

const build = path.dirname(path.dirname(binary));
const cache = fs.readFileSync(path.join(build, 'CMakeCache.txt'), 'utf8');
const cached = (name) => cache.match(RegExp(`^${name}:[A-Z]+=(.*)$`, 'm'))?.[1] ?? '';
const type = cached('CMAKE_BUILD_TYPE');
const flags = [cached('CMAKE_CXX_FLAGS'), cached(`CMAKE_CXX_FLAGS_${type.toUpperCase()}`),
  cached('STAGGER_NATIVE') === 'ON' ? '-march=native' : ''].join(' ');

const temporary = fs.mkdtempSync(path.join(os.tmpdir(), 'stagger-package-'));
const prefix = path.join(temporary, 'installed');
const consumer = path.join(temporary, 'consumer');
after(() => fs.rmSync(temporary, { recursive: true }));

/** Runs a program to its end: {code, output}. */
function run(program, ...args) {
  const options = { encoding: 'utf8', timeout: 300_000, maxBuffer: 1 << 26 };
  const { status, stdout, stderr, error } = spawnSync(program, args, options);
  if (error) throw error;
  return { code: status, output: stdout + stderr };
}
function succeed(...args) {
  const { code, output } = run(...args);
  assert.equal(code, 0, `${args.join(' ')}\n${output}`);
  return output;
}
const configure = (source, out, more = '') =>
  run('cmake', '-S', source, '-B', out, '-G', cached('CMAKE_GENERATOR'),
    `-DCMAKE_CXX_COMPILER=${cached('CMAKE_CXX_COMPILER')}`, `-DCMAKE_BUILD_TYPE=${type}`,
    `-DCMAKE_CXX_FLAGS_${type.toUpperCase()}=${flags} ${more}`, `-DCMAKE_PREFIX_PATH=${prefix}`);
const files = (folder) =>
  fs.readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const name = path.join(folder, entry.name);
    return entry.isDirectory() ? files(name) : [name];
  }).sort();
const installed = (ending) => files(prefix).filter((name) => name.endsWith(ending));
const library = () => installed('.a')[0];

before(() => {
  // Installed in one place and moved to another: a package may know of no folder but its own.
  const staging = path.join(temporary, 'staging');
  succeed('cmake', '--install', build, '--component', 'engine', '--prefix', staging);
  fs.renameSync(staging, prefix);
  fs.cpSync(path.join(root, 'tests/consumer'), consumer, { recursive: true });
});

test('headers of the engine, its library and the package files, and nothing else', () => {
  const names = files(prefix).map((name) => path.relative(prefix, name));
  const headers = files(path.join(root, 'engine')).filter((name) => name.endsWith('.h'))
    .map((name) => `include/stagger/${path.relative(root, name)}`);
  assert.ok(headers.includes('include/stagger/engine/walking_engine.h'));
  assert.deepEqual(names.filter((name) => name.startsWith('include/')), headers);
  const others = names.filter((name) => !name.startsWith('include/'));
  assert.deepEqual(others.map((name) => path.basename(name)).sort(), ['libstagger_engine.a',
    'staggerConfig.cmake', 'staggerConfigVersion.cmake',
    `staggerTargets-${type.toLowerCase()}.cmake`, 'staggerTargets.cmake'].sort());
});

test('the whole project installs too, with the same package in it', () => {
  const whole = path.join(temporary, 'whole');
  succeed('cmake', '--install', build, '--prefix', whole);
  for (const name of files(prefix)) {
    const copy = path.join(whole, path.relative(prefix, name));
    assert.deepEqual(fs.readFileSync(copy), fs.readFileSync(name), copy);
  }
});

test('headers include the engine, Eigen and the standard library alone', () => {
  for (const header of installed('.h')) {
    const text = fs.readFileSync(header, 'utf8');
    for (const [, quoted, angled] of text.matchAll(/^\s*#\s*include\s*(?:"(.*)"|<(.*)>)/gm)) {
      const where = `${header}: ${quoted ?? angled}`;
      if (quoted) {
        assert.ok(fs.existsSync(path.join(prefix, 'include/stagger', quoted)), where);
      } else {
        assert.match(angled, /^(Eigen\/[A-Z]\w*|[a-z_]+)$/, where); // <numbers>, not <unistd.h>
      }
    }
  }
});

test('the package asks for Eigen alone', () => {
  const text = installed('.cmake').map((name) => fs.readFileSync(name, 'utf8')).join('\n');
  const packages = text.matchAll(/^\s*find_(?:dependency|package)\s*\(\s*(\w+)/gm);
  assert.deepEqual([...packages].map((match) => match[1]), ['Eigen3']);
  const linked = text.matchAll(/INTERFACE_LINK_LIBRARIES\s+"(.*)"/g);
  assert.deepEqual([...linked].map((match) => match[1]), ['Eigen3::Eigen']);
  assert.ok(!text.includes(root), 'it names the folder that it was built in');
});

test('a controller outside the checkout walks, takes a push and comes to rest', () => {
  const out = path.join(temporary, 'controller');
  const { code, output } = configure(consumer, out);
  assert.equal(code, 0, output);
  succeed('cmake', '--build', out);
  const controller = path.join(out, 'controller');
  const walked = run(controller);
  assert.match(walked.output, /^rests after \d+ steps and 1\.\d\d m, pushed with 10 N s\n$/);
  assert.equal(walked.code, 0);
  // It would say so if it had fallen.
  const thrown = run(controller, '60');
  assert.match(thrown.output, /^fell /);
  assert.equal(thrown.code, 1);
});

test('a program of another matrix layout does not link', () => {
  // What -march does to a program, done on any machine.
  const out = path.join(temporary, 'shifted');
  const { code, output } = configure(consumer, out, '-DEIGEN_MAX_STATIC_ALIGN_BYTES=0');
  assert.equal(code, 0, output);
  const built = run('cmake', '--build', out);
  assert.notEqual(built.code, 0);
  assert.match(built.output, /undefined reference to .*MatrixAlignment<0/);
});

test('the version is the program\'s, and a later one is refused', async () => {
  const version = (await command(['--version'])).stdout.trim();
  const ask = (wanted) => {
    const source = path.join(temporary, `wants-${wanted}`);
    fs.mkdirSync(source);
    fs.writeFileSync(path.join(source, 'CMakeLists.txt'), `cmake_minimum_required(VERSION 3.25)
      project(asks LANGUAGES CXX)
      find_package(stagger ${wanted} REQUIRED)`);
    return configure(source, path.join(source, 'build'));
  };
  const same = ask(`${version} EXACT`);
  assert.equal(same.code, 0, same.output);
  const later = ask('99');
  assert.notEqual(later.code, 0);
  assert.match(later.output, /compatible with requested\s+version\s+"99"/);
  assert.match(later.output, RegExp(`version: ${version.replaceAll('.', '\\.')}`));
});

test('the engine calls no lock, clock, log or file, and on the tick no heap', () => {
  /** What each object of a library calls: {object: [symbol]}. */
  const calls = (archive) => {
    const all = {};
    let object;
    for (const line of succeed('nm', '--undefined-only', '--demangle', archive).split('\n')) {
      if (line.endsWith('.o:')) all[(object = path.basename(line, '.cpp.o:'))] = [];
      else if (line.trim()) all[object].push(line.trim().replace(/^\w /, ''));
    }
    return all;
  };
  const outside = new RegExp([
    '^(pthread|sem|mtx|cnd)_', '^(syscall|futex)$',
    '^std::(mutex|thread|condition_variable|this_thread)',
    '^spdlog::', 'fmt::', 'printf', '^f?puts', '^putchar', '^f(open|read|write|flush)\\b',
    '^std::basic_[io]?f?stream', '^std::(cout|cerr|clog|ostream)',
    '^std::chrono::', '^(clock|time|gettimeofday|clock_gettime|nanosleep)$',
    '^s?rand(om)?$', '^getenv$',
  ].join('|'));
  const heap = new RegExp([
    '^(malloc|calloc|realloc|free|aligned_alloc|posix_memalign)$', '^operator (new|delete)',
    '^__cxa_(throw|guard_acquire)$', // a static of a function is behind a lock
  ].join('|'));

  const engine = calls(library());
  assert.ok('walking_engine' in engine);
  for (const [object, symbols] of Object.entries(engine)) {
    // What is checked and reckoned out once, when the engine is made; it may write the text of an
    // error. std::cerr and the like would still be seen.
    const once = ['parameters', 'measurement', 'riccati', 'lqg', 'convex_set', 'capturability', 'capture_region'];
    const formatting = /^std::(ostream|basic_ostream<)|^vsnprintf$/;
    const allowed = (symbol) => once.includes(object) && formatting.test(symbol);
    assert.deepEqual(symbols.filter((symbol) => outside.test(symbol) && !allowed(symbol)), [], object);
    if (once.includes(object)) continue;
    assert.deepEqual(symbols.filter((symbol) => heap.test(symbol)), [], object);
  }
  // The patterns know such calls when they see them.
  const server = Object.values(calls(path.join(build, 'server/libstagger_server.a'))).flat();
  for (const name of ['pthread_mutex_lock', 'spdlog::', 'std::chrono::']) {
    assert.ok(server.some((symbol) => symbol.startsWith(name) && outside.test(symbol)), name);
  }
  for (const name of ['operator new', '__cxa_throw']) {
    assert.ok(server.some((symbol) => symbol.startsWith(name) && heap.test(symbol)), name);
  }
});
