// Reads flight.mcap of a run as viewers do, by its index and as a stream, and compares it with the run's other files.
//   node read_test.mjs RUN
// Exit status: 0 all agrees, 1 something does not, 77 the reader's libraries are not installed (npm ci).
import { open, readFile } from 'node:fs/promises';
import { createReadStream } from 'node:fs';
import { join } from 'node:path';

let McapIndexedReader, McapStreamReader, protobuf, fzstd;
try {
  ({ McapIndexedReader, McapStreamReader } = await import('@mcap/core'));
  protobuf = (await import('protobufjs')).default;
  await import('protobufjs/ext/descriptor/index.js');
  fzstd = await import('fzstd');
} catch (error) {
  console.log(`skipped: ${error.message.split('\n')[0]}`);
  process.exit(77);
}

const run = process.argv[2];
const decompressHandlers = { zstd: (bytes) => fzstd.decompress(bytes) };
let failures = 0;
function expect(holds, what) {
  if (holds) return;
  failures += 1;
  console.log(`failed: ${what}`);
}

/** Messages by topic, each {t_s, data}. */
async function readIndexed(file) {
  const handle = await open(file);
  const { size } = await handle.stat();
  const readable = {
    size: async () => BigInt(size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      await handle.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const topics = new Map();
  for await (const message of reader.readMessages({ validateCrcs: true })) add(topics, reader.channelsById, message);
  await handle.close();
  return { topics, reader };
}

async function readStreamed(file) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const channels = new Map();
  const topics = new Map();
  for await (const part of createReadStream(file)) {
    reader.append(part);
    for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
      if (record.type === 'Channel') channels.set(record.id, record);
      if (record.type === 'Message') add(topics, channels, record);
    }
  }
  expect(reader.done(), 'the stream ends with the footer');
  return topics;
}

function add(topics, channels, message) {
  const { topic } = channels.get(message.channelId);
  if (!topics.has(topic)) topics.set(topic, []);
  topics.get(topic).push({ t_s: Number(message.logTime) * 1e-9, data: Buffer.from(message.data) });
}

const { topics, reader } = await readIndexed(join(run, 'flight.mcap'));
const streamed = await readStreamed(join(run, 'flight.mcap'));
expect(reader.chunkIndexes.length > 0, 'chunks are indexed');
expect([...reader.chunkIndexes].every((chunk) => chunk.messageIndexOffsets.size > 0), 'each chunk has an index of messages');
for (const [topic, messages] of topics) {
  const others = streamed.get(topic) ?? [];
  expect(messages.length === others.length, `${topic}: ${messages.length} by index, ${others.length} streamed`);
  const same = messages.every((message, i) => message.t_s === others[i].t_s && message.data.equals(others[i].data));
  expect(same, `${topic}: the same by index and streamed`);
}

/** Of a topic, decoded by the schema that the file itself brings. */
function decoded(topic) {
  const channel = [...reader.channelsById.values()].find((one) => one.topic === topic);
  const schema = reader.schemasById.get(channel.schemaId);
  const root = protobuf.Root.fromDescriptor(schema.data);
  const type = root.lookupType(schema.name);
  return topics.get(topic).map(({ t_s, data }) => ({ t_s, ...type.toObject(type.decode(data), { defaults: true }) }));
}

const result = JSON.parse(await readFile(join(run, 'result.json')));
const truth = (await readFile(join(run, 'truth.tum'), 'utf8')).trim().split('\n').map((line) => line.split(' ').map(Number));
const obstacles = (await readFile(join(run, 'obstacles.csv'), 'utf8')).trim().split('\n').length - 1;

/** Of the frame header, the marker SOF0. */
function jpegSize(bytes) {
  for (let at = 2; at < bytes.length; at += 2 + bytes.readUInt16BE(at + 2))
    if (bytes[at + 1] === 0xc0) return [bytes.readUInt16BE(at + 7), bytes.readUInt16BE(at + 5)];
  return [0, 0];
}

for (const side of ['left', 'right']) {
  const images = decoded(`/camera/${side}/image`);
  const [calibration] = decoded(`/camera/${side}/calibration`);
  expect(images.length >= result.frames / 2 - 1 && images.length < result.frames / 2 + 2,
         `${side}: ${images.length} images, every second of ${result.frames} frames`);
  const [width, height] = jpegSize(Buffer.from(images[0].data));
  expect(images[0].format === 'jpeg' && width === calibration.width && height === calibration.height,
         `${side}: a JPEG of the calibration's size`);
  expect(calibration.K.length === 9 && calibration.P.length === 12 && calibration.K[0] > 0, `${side}: a calibration`);
  expect(images.every((image) => image.frame_id === `${side}_camera`), `${side}: the camera's frame`);
}

const stride = (cloud) => cloud.point_stride;
const points = (cloud) => cloud.data.length / stride(cloud);
const hits = decoded('/hits').reduce((sum, cloud) => sum + points(cloud), 0);
expect(hits === result.detections, `${hits} hits in the log, ${result.detections} in the result`);
const maps = decoded('/map').length;
expect(maps > result.frames / 4 - 2 && maps < result.frames / 3, `${maps} maps, one for each fourth of ${result.frames} frames`);
const [trunks] = decoded('/obstacles');
const [crowns] = decoded('/crowns');
expect(points(crowns) === 0, 'no crowns in plain scenery');
expect(obstacles === 0 || points(trunks) >= 6 * obstacles, 'points on each obstacle');

// The true pose at the moments that truth.tum has, too.
const poses = new Map(decoded('/pose/true').map((one) => [one.t_s.toFixed(6), one.pose]));
let compared = 0;
for (const [t_s, x, y, z, qx, qy, qz, qw] of truth) {
  const pose = poses.get(t_s.toFixed(6));
  if (!pose) continue;
  compared += 1;
  const { position: p, orientation: q } = pose;
  const apart_m = Math.hypot(p.x - x, p.y - y, p.z - z);
  const turn = Math.abs(q.x * qx + q.y * qy + q.z * qz + q.w * qw);
  if (apart_m > 1e-3 || turn < 1 - 1e-5) expect(false, `the pose at ${t_s} s`);
}
expect(compared > truth.length / 10, `${compared} poses compared`);
expect(decoded('/tf').some((one) => one.child_frame_id === 'aircraft'), 'the aircraft in the transforms');
const scalars = decoded('/scalars');
expect(Math.abs(scalars.at(-1).t_s - result.simulated_s) < 1e-6, 'numbers up to the end');
expect(decoded('/plan').length > 0, 'plans');
const log = decoded('/log');
expect(log.at(-1).message === result.outcome, `the log ends with ${result.outcome}`);

const messages = [...topics.values()].reduce((sum, list) => sum + list.length, 0);
console.log(`${messages} messages in ${topics.size} topics: ${failures === 0 ? 'agree with the run' : `${failures} failures`}`);
process.exit(failures === 0 ? 0 : 1);
