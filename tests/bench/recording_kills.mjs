// kill -9 in the middle of recording, at random moments: how much is lost?
//   node tests/bench/recording_kills.mjs [KILLS]
import { killWhileRecording } from '../server/recording_crash.mjs';

const kills = Number(process.argv[2] ?? 20);
let worst = 0;
for (let i = 1; i <= kills; ++i) {
  const after = Math.round(200 + 4800 * Math.random()); // [ms]
  const { ticks, lost_ms, replay } = await killWhileRecording(after);
  if (replay !== 0 || lost_ms > 1000) throw new Error(`kill ${i}: ${lost_ms} ms lost, replay ${replay}`);
  worst = Math.max(worst, lost_ms);
  console.log(`kill ${i} after ${after} ms: ${ticks} ticks read, ${lost_ms} ms lost, replay equal`);
}
console.log(`${kills} kills: at most ${worst} ms lost`);
