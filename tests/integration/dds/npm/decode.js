// SPDX-License-Identifier: BSD-3-Clause
// Decodes the messages captured by the Fast DDS listener with Foxglove's code and Foxglove's copies of the
// ROS 2 definitions, and compares them with the data of the stand-in (stand_in.hpp). Independent of Isobar's
// IDL.
//   node decode.js FOLDER
// Exit code 0: passed, 1: failed, 77: node_modules or the captured files are missing.
"use strict";
const assert = require("node:assert/strict");
const fs = require("node:fs");
const path = require("node:path");

const folder = process.argv[2];
let parse, MessageReader, definitions;
try {
  ({ parse } = require("@foxglove/rosmsg"));
  ({ MessageReader } = require("@foxglove/rosmsg2-serialization"));
  ({ ros2humble: definitions } = require("@foxglove/rosmsg-msgs-common"));
} catch {
  console.log("skipped: run npm ci in tests/integration/dds/npm first");
  process.exit(77);
}
if (!fs.existsSync(path.join(folder, "rt.odom.cdr"))) {
  console.log("skipped: no captured messages; run test_dds_foreign first");
  process.exit(77);
}

/** The definition of a type, followed by those of the types it contains. */
function withDependencies(name, known) {
  const done = new Map();
  const visit = (type) => {
    if (done.has(type)) return;
    const definition = known[type];
    assert.ok(definition, `no definition of ${type}`);
    done.set(type, definition);
    definition.definitions.filter((field) => field.isComplex).forEach((field) => visit(field.type.replace("/msg/", "/")));
  };
  visit(name);
  return [...done.values()];
}

function parsed(name, text) {
  return { [name]: { ...parse(text, { ros2: true, skipTypeFixup: true })[0], name } };
}

const altitudeFile = path.join(__dirname, "../../../../ipc/dds/ros2/isobar_msgs/msg/Altitude.msg");
const known = {
  ...definitions,
  ...parsed("isobar_msgs/Altitude", fs.readFileSync(altitudeFile, "utf8")),
  ...parsed("rmw_dds_common/Gid", "uint8[16] data"),
  ...parsed("rmw_dds_common/NodeEntitiesInfo",
    "string node_namespace\nstring node_name\nrmw_dds_common/Gid[] reader_gid_seq\nrmw_dds_common/Gid[] writer_gid_seq"),
  ...parsed("rmw_dds_common/ParticipantEntitiesInfo",
    "rmw_dds_common/Gid gid\nrmw_dds_common/NodeEntitiesInfo[] node_entities_info_seq"),
};

function read(topic, type) {
  const bytes = fs.readFileSync(path.join(folder, `${topic}.cdr`));
  assert.deepEqual([...bytes.subarray(0, 2)], [0, 1], `${topic}: XCDR1, little endian`);
  return new MessageReader(withDependencies(type, known)).readMessage(bytes);
}

function near(actual, wanted, tolerance, what) {
  assert.ok(Math.abs(actual - wanted) <= tolerance, `${what}: ${actual} instead of ${wanted}`);
}

/** The stand-in's drive: x = 0.5 t, y = 2, z = 0.1 t, yaw = 0.3. */
function checkPosition(position, tolerance, what) {
  assert.ok(position.x > 0.1, `${what}: the robot has moved`);
  near(position.y, 2.0, tolerance, `${what} y`);
  near(position.z, 0.2 * position.x, tolerance, `${what} z`);
}

function checkRotation(q, yaw, what) {
  near(q.x, 0, 1e-9, `${what} qx`);
  near(q.y, 0, 1e-9, `${what} qy`);
  near(q.z, Math.sin(yaw / 2), 1e-9, `${what} qz`);
  near(q.w, Math.cos(yaw / 2), 1e-9, `${what} qw`);
}

/** Stamps are wall-clock times, not much older than the files. */
const writtenAt = fs.statSync(path.join(folder, "rt.odom.cdr")).mtimeMs / 1000;
function checkStamp(header, what) {
  const age = writtenAt - (header.stamp.sec + header.stamp.nanosec * 1e-9);
  assert.ok(age > -1 && age < 60, `${what}: stamp is ${age} s older than its file`);
}

const checks = {
  odom() {
    const message = read("rt.odom", "nav_msgs/Odometry");
    checkStamp(message.header, "odom");
    assert.equal(message.header.frame_id, "odom");
    assert.equal(message.child_frame_id, "base_link");
    checkPosition(message.pose.pose.position, 1e-9, "odom");
    checkRotation(message.pose.pose.orientation, 0.3, "odom");
    near(message.twist.twist.linear.x, 0.5 * Math.cos(0.3), 1e-12, "vx");
    near(message.twist.twist.linear.y, -0.5 * Math.sin(0.3), 1e-12, "vy");
    near(message.twist.twist.linear.z, 0.1, 1e-12, "vz");
    near(message.twist.covariance[0], 1e-4, 1e-12, "variance of vx");
    assert.ok(message.pose.covariance[0] >= 0.01 && message.pose.covariance[0] < 0.0101);
    near(message.pose.covariance[5], 0.001, 1e-12, "covariance of x and yaw");
  },
  pose() {
    const message = read("rt.pose", "geometry_msgs/PoseWithCovarianceStamped");
    checkStamp(message.header, "pose");
    assert.equal(message.header.frame_id, "map");
    checkPosition(message.pose.pose.position, 1e-9, "pose");
    checkRotation(message.pose.pose.orientation, 0.3, "pose");
    for (let i = 0; i < 36; ++i) {
      const wanted = i % 7 === 0 ? 0.01 * (i / 7 + 1) : i === 5 || i === 30 ? 0.001 : 0;
      near(message.pose.covariance[i], wanted, 1e-12, `covariance ${i}`);
    }
  },
  tf() {
    const { transforms } = read("rt.tf", "tf2_msgs/TFMessage");
    assert.deepEqual(transforms.map((t) => [t.header.frame_id, t.child_frame_id]),
      [["map", "odom"], ["odom", "base_link"]]);
    near(transforms[0].transform.translation.x, 0, 1e-9, "map to odom");
    checkRotation(transforms[0].transform.rotation, 0, "map to odom");
    checkPosition(transforms[1].transform.translation, 1e-9, "odom to base_link");
    checkRotation(transforms[1].transform.rotation, 0.3, "odom to base_link");
  },
  tf_static() {
    const { transforms } = read("rt.tf_static", "tf2_msgs/TFMessage");
    assert.deepEqual(transforms.map((t) => [t.header.frame_id, t.child_frame_id]),
      [["base_link", "lidar"], ["base_link", "imu"], ["base_link", "barometer"]]);
  },
  altitude() {
    const message = read("rt.altitude", "isobar_msgs/Altitude");
    checkStamp(message.header, "altitude");
    assert.ok(message.height > 0.02);
    assert.equal(message.variance, 4e-4);
    assert.equal(message.source, "differential");
    assert.equal(message.drifting, "none");
    assert.equal(message.faulty, false);
  },
  registered_scan() { checkCloud("rt.registered_scan", "base_link", 2000, ["x", "y", "z", "intensity", "ring"]); },
  map_cloud() { checkCloud("rt.map_cloud", "map", 150000, ["x", "y", "z", "intensity"]); },
  map() {
    const grid = read("rt.map", "nav_msgs/OccupancyGrid");
    checkStamp(grid.header, "map");
    assert.equal(grid.header.frame_id, "map");
    assert.deepEqual(grid.info.map_load_time, grid.header.stamp);
    assert.equal(grid.info.resolution, Math.fround(0.05));
    assert.deepEqual([grid.info.width, grid.info.height], [1500, 1000]);
    assert.deepEqual(grid.info.origin, { position: { x: -30, y: 12.5, z: -3.5 }, orientation: { x: 0, y: 0, z: 0, w: 1 } });
    assert.ok(grid.data instanceof Int8Array);
    assert.equal(grid.data.length, 1500 * 1000);
    assert.equal(grid.data.findIndex((cell, i) => cell !== (i % 102) - 1), -1);
  },
  floor() {
    assert.equal(read("rt.floor", "std_msgs/Int32").data, -1);
    assert.equal(read("rt.floor_name", "std_msgs/String").data, "parking");
  },
  diagnostics() {
    const { status } = read("rt.diagnostics", "diagnostic_msgs/DiagnosticArray");
    const byName = new Map(status.map((entry) => [entry.name, entry]));
    const lost = byName.get("isobar: lidar/packets_lost");
    assert.equal(lost.level, 1);
    assert.equal(lost.message, "gaps in time");
    assert.deepEqual(lost.values, [{ key: "value", value: "3" }]);
    assert.equal(byName.get("isobar: lidar/packets").level, 0);
    assert.equal(byName.get("isobar: floor").message, "-1 (parking), certain to 99 %");
    assert.equal(byName.get("isobar: bridge/messages_unsent").level, 0);
  },
  ros_discovery_info() {
    const message = read("ros_discovery_info", "rmw_dds_common/ParticipantEntitiesInfo");
    assert.equal(message.node_entities_info_seq.length, 1);
    const node = message.node_entities_info_seq[0];
    assert.equal(node.node_namespace, "/");
    assert.equal(node.node_name, "isobar");
    assert.ok(node.writer_gid_seq.length >= 8);
    for (const { data } of node.writer_gid_seq) {
      assert.deepEqual([...data.subarray(0, 12)], [...message.gid.data.subarray(0, 12)], "of this participant");
      assert.equal(data[15], 0x03, "a writer without a key");
    }
  },
};

function checkCloud(topic, frame, count, names) {
  const cloud = read(topic, "sensor_msgs/PointCloud2");
  checkStamp(cloud.header, topic);
  assert.equal(cloud.header.frame_id, frame);
  const step = names.includes("ring") ? 20 : 16;
  assert.deepEqual([cloud.height, cloud.width, cloud.point_step, cloud.row_step], [1, count, step, step * count]);
  assert.deepEqual([cloud.is_bigendian, cloud.is_dense], [false, true]);
  assert.deepEqual(cloud.fields.map((field) => field.name), names);
  assert.equal(cloud.data.length, step * count);
  const field = Object.fromEntries(cloud.fields.map((f) => [f.name, f]));
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
  for (const i of [0, 1, 17, 999, count - 1]) {
    const at = (name) => i * cloud.point_step + field[name].offset;
    assert.equal(field.x.datatype, 7);
    assert.equal(view.getFloat32(at("x"), true), Math.fround(0.25 * i));
    assert.equal(view.getFloat32(at("y"), true), -1.5);
    near(view.getFloat32(at("z"), true), 0.001 * (i % 1000), 1e-6, "z");
    assert.equal(field.intensity.datatype, 7);
    assert.equal(view.getFloat32(at("intensity"), true), i % 256);
    if (field.ring) assert.equal(field.ring.datatype, 4);
    if (field.ring) assert.equal(view.getUint16(at("ring"), true), i % 16);
  }
}

let failed = 0;
for (const [name, check] of Object.entries(checks)) {
  try {
    check();
    console.log(`ok      ${name}`);
  } catch (error) {
    failed += 1;
    console.log(`FAILED  ${name}: ${error.message}`);
  }
}
process.exit(failed === 0 ? 0 : 1);
