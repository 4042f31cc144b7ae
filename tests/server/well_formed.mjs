// Is it XML?
import assert from 'node:assert/strict';

/** Every opened tag is closed, in order; attributes are quoted; ids are unique. Returns the tags. */
export function wellFormed(xml) {
  const open = [];
  const tags = [];
  const ids = new Set();
  const body = xml.replace(/^<!DOCTYPE html>\n/, '');
  const markup = /<(\/?)([a-zA-Z][\w-]*)((?:\s+[\w:-]+="[^"<]*")*)\s*(\/?)>|<|&(?!(?:amp|lt|gt|quot|#39);)/g;
  for (const [text, closing, name, attributes, empty] of body.matchAll(markup)) {
    assert.ok(name, `stray ${text}`);
    if (closing) {
      assert.equal(open.pop(), name);
      continue;
    }
    tags.push(name);
    if (!empty) open.push(name);
    const id = /\sid="([^"]*)"/.exec(attributes)?.[1];
    if (id === undefined) continue;
    assert.ok(!ids.has(id), `id ${id} twice`);
    ids.add(id);
  }
  assert.deepEqual(open, []);
  return tags;
}
