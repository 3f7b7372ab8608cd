// SPDX-License-Identifier: BSD-3-Clause
// Writes an MCAP with Foxglove's writer, message serialisers and definitions, has `isobar import` read it, and compares
// the recording with what was written. Independent of Isobar's readers.
//   node write_and_import.js ISOBAR
// Exit code 0: passed, 1: failed, 77: node_modules are missing.
"use strict";
const assert = require("node:assert/strict");
const { execFileSync } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");

let parse, Writer2, Writer1, definitions, McapWriter;
try {
  ({ parse } = require("@foxglove/rosmsg"));
  ({ MessageWriter: Writer2 } = require("@foxglove/rosmsg2-serialization"));
  ({ MessageWriter: Writer1 } = require("@foxglove/rosmsg-serialization"));
  definitions = require("@foxglove/rosmsg-msgs-common");
  ({ McapWriter } = require("@mcap/core"));
} catch {
  console.log("skipped: run npm ci in tests/integration/import/npm first");
  process.exit(77);
}

/** The definition of a type, followed by those of the types it contains. */
function withDependencies(name, known) {
  const done = new Map();
  const visit = (type) => {
    if (done.has(type)) return;
    done.set(type, known[type]);
    known[type].definitions.filter((f) => f.isComplex).forEach((f) => visit(f.type.replace("/msg/", "/")));
  };
  visit(name);
  return [...done.values()];
}

const start = 1700000000;
const points = (i) => {
  const data = new DataView(new ArrayBuffer(16 * 100));
  for (let k = 0; k < 100; ++k) {
    [5 * Math.cos(k / 16), 5 * Math.sin(k / 16), 1 + i, k * 0.001].forEach((v, n) => data.setFloat32(16 * k + 4 * n, v, true));
  }
  return new Uint8Array(data.buffer);
};

async function write(file) {
  let bytes = 0n;
  const handle = await fs.promises.open(file, "w");
  const writer = new McapWriter({
    writable: { position: () => bytes, write: async (part) => { bytes += BigInt(part.byteLength); await handle.write(part); } },
    chunkSize: 4000,
  });
  await writer.start({ profile: "", library: "test" });
  const channel = async (topic, type, isRos1) => {
    const known = isRos1 ? definitions.ros1 : definitions.ros2humble;
    const schemaId = await writer.registerSchema({
      name: isRos1 ? type : type.replace("/", "/msg/"), encoding: isRos1 ? "ros1msg" : "ros2msg", data: new Uint8Array(),
    });
    const id = await writer.registerChannel({ schemaId, topic, messageEncoding: isRos1 ? "ros1" : "cdr", metadata: new Map() });
    const serialiser = new (isRos1 ? Writer1 : Writer2)(withDependencies(type, known));
    return async (ns, message) => {
      const time = BigInt(start) * 1000000000n + BigInt(ns);
      await writer.addMessage({ channelId: id, sequence: 0, logTime: time, publishTime: time, data: serialiser.writeMessage(message) });
    };
  };
  const imu = await channel("/imu", "sensor_msgs/Imu", false);
  const pressure = await channel("/pressure", "sensor_msgs/FluidPressure", true);
  const cloud = await channel("/points", "sensor_msgs/PointCloud2", false);
  const v = (x, y, z) => ({ x, y, z });
  const nine = new Float64Array(9);
  for (let i = 0; i < 50; ++i) {
    const stamp = { sec: start, nanosec: i * 10000000, nsec: i * 10000000 };
    const header = { seq: i, stamp, frame_id: "lidar" };
    await imu(i * 10000000, { header, orientation: { x: 0, y: 0, z: 0, w: 1 }, orientation_covariance: nine,
      angular_velocity: v(0.01 * i, 0, 0), angular_velocity_covariance: nine, linear_acceleration: v(0, 0, 9.81), linear_acceleration_covariance: nine });
    if (i % 10 !== 0) continue;
    await pressure(i * 10000000, { header, fluid_pressure: 100000 + i, variance: 0 });
    await cloud(i * 10000000, { header, height: 1, width: 100, is_bigendian: false, point_step: 16, row_step: 1600, is_dense: true,
      fields: ["x", "y", "z", "time"].map((name, n) => ({ name, offset: 4 * n, datatype: 7, count: 1 })), data: points(i) });
  }
  await writer.end();
  await handle.close();
}

async function main() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "isobar-npm-"));
  try {
    const file = path.join(folder, "foreign.mcap");
    await write(file);
    const out = path.join(folder, "recording");
    const text = execFileSync(process.argv[2], ["import", file, "--out", out], { encoding: "utf8" });
    assert.match(text, /times from time in s/);
    const rows = (name) => fs.readFileSync(path.join(out, name), "utf8").trim().split("\n").slice(1).map((line) => line.split(",").map(Number));
    assert.equal(rows("imu.csv").length, 50);
    assert.equal(rows("imu.csv")[20][1], 0.2);
    assert.equal(rows("imu.csv")[20][6], 9.81);
    assert.deepEqual(rows("barometer.csv").map((row) => row[1]), [100000, 100010, 100020, 100030, 100040]);
    const clouds = fs.readFileSync(path.join(out, "lidar.clouds"));
    for (const i of [0, 10, 40]) assert.ok(clouds.includes(Buffer.from(points(i))), `cloud ${i} is missing`);
    // Half of the file: everything before the cut.
    fs.truncateSync(file, Math.floor(fs.statSync(file).size / 2));
    const cut = execFileSync(process.argv[2], ["import", file, "--out", out + "2"], { encoding: "utf8" });
    assert.match(cut, /damaged: .*foreign.mcap: byte \d+/);
    console.log("passed");
  } finally {
    fs.rmSync(folder, { recursive: true, force: true });
  }
}
main().catch((error) => { console.error(error); process.exit(1); });
