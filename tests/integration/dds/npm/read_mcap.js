// SPDX-License-Identifier: BSD-3-Clause
// Opens an MCAP file of `isobar` with Foxglove's reader, once through its index and once as a stream without it, checks
// every checksum, decodes every message by the definition that the file holds, compares these definitions with
// Foxglove's own, and prints one line of JSON: for each topic its type, count, first and last message.
//   node read_mcap.js FILE [RUN]     RUN: folder of the run, whose trajectory and map the file must hold
// Exit code 0: passed, 1: failed, 77: node_modules are missing.
"use strict";
const assert = require("node:assert/strict");
const fs = require("node:fs");

let mcap, parse, MessageReader, definitions, fzstd;
try {
  mcap = require("@mcap/core");
  ({ parse } = require("@foxglove/rosmsg"));
  ({ MessageReader } = require("@foxglove/rosmsg2-serialization"));
  ({ ros2humble: definitions } = require("@foxglove/rosmsg-msgs-common"));
  fzstd = require("fzstd");
} catch {
  console.log("skipped: run npm ci in tests/integration/dds/npm first");
  process.exit(77);
}
const decompressHandlers = { zstd: (bytes) => fzstd.decompress(bytes) };

/** Members of a parsed definition as text, without what the two sources spell differently. */
function members(definition) {
  return definition.definitions.map((m) => `${m.type.replace("/msg/", "/")}${m.isArray ? `[${m.arrayLength ?? ""}]` : ""} ${m.name}`);
}

/** Each part of a definition must have the members of Foxglove's copy of the ROS definition. */
function checkDefinition(schemaName, parsed) {
  for (const part of parsed) {
    const name = (part.name ?? schemaName).replace("/msg/", "/");
    const known = definitions[name];
    if (known) assert.deepEqual(members(part), members({ definitions: known.definitions.filter((m) => !m.isConstant) }), name);
  }
}

/** The file against the run's own files. */
function checkRun(topics, run) {
  const rows = fs.readFileSync(`${run}/trajectory.tum`, "utf8").split("\n").filter((line) => line && !line.startsWith("#"));
  assert.equal(topics["/pose"].count, rows.length, "a pose for each line of trajectory.tum");
  assert.equal(topics["/path"].first.poses.length, rows.length);
  for (const [row, message] of [[rows[0], topics["/pose"].first], [rows[rows.length - 1], topics["/pose"].last]]) {
    const [stamp, x, y, z] = row.split(" ");
    const { sec, nanosec } = message.header.stamp;
    assert.equal(`${sec}.${String(nanosec).padStart(9, "0")}`, stamp, "stamps to the nanosecond");
    const { position } = message.pose.pose;
    for (const [a, b] of [[position.x, x], [position.y, y], [position.z, z]]) assert.ok(Math.abs(a - Number(b)) < 1e-9);
    assert.equal(message.header.frame_id, "map");
  }
  const vertices = Number(/element vertex +(\d+)/.exec(fs.readFileSync(`${run}/map.ply`, "latin1"))[1]);
  assert.equal(topics["/map_cloud"].first.width, vertices, "every point of the map");
  assert.equal(topics["/map_cloud"].first.data.length, 12 * vertices);
}

/** Large arrays by their length only. */
function shortened(value) {
  if (ArrayBuffer.isView(value)) return value.length > 40 ? { length: value.length } : Array.from(value);
  if (Array.isArray(value)) return value.length > 4 ? { length: value.length, first: shortened(value[0]) } : value.map(shortened);
  if (typeof value === "bigint") return Number(value);
  if (value && typeof value === "object")
    return Object.fromEntries(Object.entries(value).map(([key, member]) => [key, shortened(member)]));
  return value;
}

async function main() {
  const bytes = fs.readFileSync(process.argv[2]);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
  };
  const reader = await mcap.McapIndexedReader.Initialize({ readable, decompressHandlers });
  const decoders = new Map();
  const topics = {};
  let indexed = 0;
  let previous = 0n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    assert.equal(schema.encoding, "ros2msg");
    assert.equal(channel.messageEncoding, "cdr");
    if (!decoders.has(channel.id)) {
      const parsed = parse(new TextDecoder().decode(schema.data), { ros2: true });
      checkDefinition(schema.name, parsed);
      decoders.set(channel.id, new MessageReader(parsed));
      topics[channel.topic] = { type: schema.name, count: 0 };
    }
    assert.ok(message.logTime >= previous, "messages in order of time");
    previous = message.logTime;
    const topic = topics[channel.topic];
    const decoded = decoders.get(channel.id).readMessage(message.data);
    if (topic.count === 0) topic.first = shortened(decoded);
    topic.last = decoded;
    topic.count += 1;
    indexed += 1;
  }
  for (const topic of Object.values(topics)) topic.last = shortened(topic.last);
  assert.equal(BigInt(indexed), reader.statistics.messageCount, "the count of the statistics");

  if (process.argv[3]) checkRun(topics, process.argv[3]);

  // As a reader without an index sees it: a file that was cut has none.
  const stream = new mcap.McapStreamReader({ decompressHandlers, validateCrcs: true });
  stream.append(bytes);
  let streamed = 0;
  for (let record = stream.nextRecord(); record; record = stream.nextRecord()) if (record.type === "Message") streamed += 1;
  assert.equal(streamed, indexed);
  assert.ok(stream.done());
  console.log(JSON.stringify({ library: reader.header.library, profile: reader.header.profile, messages: indexed, topics }));
}

main().catch((error) => {
  console.log(`FAILED: ${error.stack}`);
  process.exit(1);
});
