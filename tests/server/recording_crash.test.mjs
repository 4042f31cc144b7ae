// kill -9 in the middle of recording.
import assert from 'node:assert/strict';
import test from 'node:test';
import { killWhileRecording } from './recording_crash.mjs';

test('after kill -9 all but the last second is read, finished, catalogued and replayed', async () => {
  for (const ms of [400, 1300, 2100]) {
    const result = await killWhileRecording(ms);
    assert.ok(result.lost_ms <= 1000, `${result.lost_ms} ms are lost`);
    assert.ok(result.cut_ticks <= result.ticks, 'the repair has lost ticks');
    assert.equal(result.replay, 0);
  }
});
