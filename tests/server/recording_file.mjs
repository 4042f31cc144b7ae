// Recordings as other programs read them: @mcap/core, and messages by the schema in the file.
import fs from 'node:fs';
import { McapIndexedReader, McapStreamReader } from '@mcap/core';
import * as fzstd from 'fzstd';

const decompressHandlers = {
  zstd: (buffer, size) => fzstd.decompress(buffer, new Uint8Array(Number(size))),
};

/** The fields of a ros1msg definition: {name, type, list, unit}, nested ones by type. */
export function parseDefinition(text) {
  const types = {};
  for (const part of text.split(/^=+\n/m)) {
    const lines = part.split('\n');
    const name = /^MSG: (\S+)/.exec(lines[0])?.[1] ?? '';
    types[name] = lines.flatMap((line) => {
      const found = /^(\S+?)(\[\])? (\w+)\s*#\s*(?:\[(.*?)\])?/.exec(line);
      if (!found || line.startsWith('#')) return [];
      return [{ type: found[1], list: Boolean(found[2]), name: found[3], unit: found[4] }];
    });
  }
  return types;
}

/** Decodes a message of encoding ros1 whose numbers are uint64 and float64. */
export function decode(types, data) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  let at = 0;
  const read = (type) => {
    if (type === 'uint64') return view.getBigUint64((at += 8) - 8, true);
    if (type === 'float64') return view.getFloat64((at += 8) - 8, true);
    return Object.fromEntries(
      types[type].map((field) => {
        if (!field.list) return [field.name, read(field.type)];
        const count = view.getUint32((at += 4) - 4, true);
        return [field.name, Array.from({ length: count }, () => read(field.type))];
      }),
    );
  };
  const message = read('');
  if (at !== data.byteLength) throw new Error(`${data.byteLength - at} bytes are left over`);
  return message;
}

const definitions = new Map(); // by schema: a recording has thousands of messages of each

function definitionOf(schema) {
  if (!definitions.has(schema)) {
    definitions.set(schema, parseDefinition(new TextDecoder().decode(schema.data)));
  }
  return definitions.get(schema);
}

function taken(records, { schema, channel, message, metadata }) {
  if (schema) records.schemas.set(schema.id, schema);
  if (channel) records.channels.set(channel.id, channel);
  if (metadata) records.metadata.push(metadata);
  if (!message) return;
  const { topic, schemaId } = records.channels.get(message.channelId);
  const described = records.schemas.get(schemaId);
  const value =
    described.encoding === 'ros1msg'
      ? decode(definitionOf(described), message.data)
      : JSON.parse(new TextDecoder().decode(message.data));
  (records.topics[topic] ??= []).push({ time: message.logTime, value });
}

const empty = () => ({ schemas: new Map(), channels: new Map(), metadata: [], topics: {} });

/** By the index at the file's end, checksums included. */
export async function readIndexed(file) {
  const bytes = fs.readFileSync(file);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const records = { ...empty(), statistics: reader.statistics, chunks: reader.chunkIndexes };
  for (const schema of reader.schemasById.values()) taken(records, { schema });
  for (const channel of reader.channelsById.values()) taken(records, { channel });
  for await (const metadata of reader.readMetadata()) taken(records, { metadata });
  for await (const message of reader.readMessages({ validateCrcs: true })) taken(records, { message });
  return records;
}

/** From the beginning, as far as the file goes. */
export function readStreaming(file) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(fs.readFileSync(file));
  const records = empty();
  for (let record; (record = reader.nextRecord()); ) {
    taken(records, {
      schema: record.type === 'Schema' ? record : undefined,
      channel: record.type === 'Channel' ? record : undefined,
      metadata: record.type === 'Metadata' ? record : undefined,
      message: record.type === 'Message' ? record : undefined,
    });
  }
  return { ...records, done: reader.done() };
}

/** CSV with a header of "name [unit]": {units, rows}. */
export function parseCsv(text) {
  const [header, ...lines] = text.trimEnd().split('\r\n');
  const units = {};
  const names = header.split(',').map((cell) => {
    const [, name, unit] = /^(.*?)(?: \[(.*)\])?$/.exec(cell);
    units[name] = unit;
    return name;
  });
  const rows = lines.map((line) =>
    Object.fromEntries(line.split(',').map((cell, i) => [names[i], cell])),
  );
  return { units, rows };
}
