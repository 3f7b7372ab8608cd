// SPDX-License-Identifier: BSD-3-Clause
// Foxglove's own client against `isobar foxglove` with the stand-in behind isobar-dds: every topic is advertised and
// decodes by the definition that comes with it; a viewer that stops reading, one that asks nonsense and one that leaves
// disturb no other; late viewers get the map.
//   node foxglove_client.js ws://127.0.0.1:PORT
// Exit code 0: passed, 1: failed, 77: node_modules are missing.
"use strict";
const assert = require("node:assert/strict");

let FoxgloveClient, WebSocket, parse, MessageReader;
try {
  ({ FoxgloveClient } = require("@foxglove/ws-protocol"));
  WebSocket = require("ws");
  ({ parse } = require("@foxglove/rosmsg"));
  ({ MessageReader } = require("@foxglove/rosmsg2-serialization"));
} catch {
  console.log("skipped: run npm ci in tests/integration/dds/npm first");
  process.exit(77);
}
const url = process.argv[2];
const socket = () => new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
const within = (promise, what, ms = 8000) =>
  Promise.race([promise, new Promise((_, reject) => setTimeout(() => reject(new Error(`no ${what} in ${ms} ms`)), ms).unref())]);

/** A viewer that subscribes to these topics. `seen`: for each topic its count and last message. */
class Viewer {
  constructor(topics) {
    this.seen = {};
    this.advertised = [];
    this.statuses = [];
    this.client = new FoxgloveClient({ ws: socket() });
    const subscriptions = new Map();
    this.client.on("advertise", (channels) => {
      for (const channel of channels) {
        this.advertised.push(channel);
        if (topics && !topics.includes(channel.topic)) continue;
        const reader = new MessageReader(parse(channel.schema, { ros2: true }));
        subscriptions.set(this.client.subscribe(channel.id), { topic: channel.topic, reader });
      }
    });
    this.client.on("serverInfo", (info) => (this.info = info));
    this.client.on("status", (status) => this.statuses.push(status));
    this.client.on("message", ({ subscriptionId, timestamp, data }) => {
      const { topic, reader } = subscriptions.get(subscriptionId);
      const seen = (this.seen[topic] ??= { count: 0 });
      seen.count += 1;
      seen.last = reader.readMessage(data);
      seen.timestamp = timestamp;
      this.check?.();
    });
  }
  /** Resolves when each of the topics has had so many messages. */
  until(topics, count) {
    return new Promise((resolve) => {
      this.check = () => topics.every((topic) => (this.seen[topic]?.count ?? 0) >= count) && resolve();
      this.check();
    });
  }
  close() {
    this.client.close();
  }
}

async function main() {
  const steady = ["/pose", "/odom", "/tf", "/altitude", "/registered_scan"];
  const latched = ["/tf_static", "/map_cloud"];
  const first = new Viewer();
  await within(first.until([...steady, ...latched], 1), "message of every topic");
  assert.equal(first.info.name, "isobar");
  assert.deepEqual(first.info.capabilities, [], "read-only");
  for (const channel of first.advertised) {
    assert.equal(channel.encoding, "cdr");
    assert.equal(channel.schemaEncoding, "ros2msg");
  }
  const { pose } = first.seen["/pose"].last.pose;
  assert.ok([pose.position.x, pose.orientation.w].every(Number.isFinite));
  assert.equal(first.seen["/odom"].last.header.frame_id, "odom");
  const cloud = first.seen["/map_cloud"].last;
  assert.equal(cloud.data.length, cloud.width * cloud.point_step);
  assert.ok(cloud.width > 0);
  assert.ok(Math.abs(Number(first.seen["/pose"].timestamp) / 1e6 - Date.now()) < 10_000, "time of reception");

  // Nonsense is answered and harms nobody.
  const odd = socket();
  await within(new Promise((resolve) => odd.once("open", resolve)), "connection");
  const refusals = [];
  odd.on("message", (text, binary) => !binary && JSON.parse(text).op === "status" && refusals.push(JSON.parse(text).message));
  for (const text of ["{", "[]", '{"op":"advertise","channels":[]}', '{"op":"subscribe","subscriptions":[{"id":1}]}',
    '{"op":"subscribe","subscriptions":[{"id":1,"channelId":4000000000}]}', '{"op":"unsubscribe","subscriptionIds":[9]}']) odd.send(text);
  odd.send(Buffer.from([1, 2, 3]));
  while (refusals.length < 6) await within(new Promise((resolve) => odd.once("message", resolve)), "refusal");
  assert.ok(refusals.some((text) => text.includes('"advertise" is not offered')), refusals.join("\n"));
  // A request without end is cut off.
  const closed = new Promise((resolve) => odd.once("close", resolve));
  odd.send("x".repeat(200_000));
  await within(closed, "end of a viewer that sends without end");

  // A viewer that asks for everything and never reads.
  const sleeper = socket();
  await within(new Promise((resolve) => sleeper.once("open", resolve)), "connection");
  sleeper.send(JSON.stringify({ op: "subscribe", subscriptions: first.advertised.map((c) => ({ id: c.id, channelId: c.id })) }));
  sleeper._socket.pause();

  // A late one has the map at once, while the first goes on.
  const late = new Viewer(["/map_cloud", "/pose"]);
  await within(late.until(["/map_cloud", "/pose"], 1), "map for a late viewer");
  const before = first.seen["/odom"].count;
  await new Promise((resolve) => setTimeout(resolve, 1500));
  const rate = (first.seen["/odom"].count - before) / 1.5;
  assert.ok(rate > 30, `the first viewer still gets odom at ${rate} Hz`);
  sleeper.terminate();
  late.close();
  first.close();
  console.log(`ok: ${first.advertised.length} topics, odom at ${rate.toFixed(0)} Hz, ${refusals.length} refusals`);
  process.exit(0);
}

main().catch((error) => {
  console.log(`FAILED: ${error.stack}`);
  process.exit(1);
});
