// A scene as MCAP, read by readers of Foxglove: each message is that of the bag, byte for byte in profile ros1, field
// for field in profile ros2; definitions of ROS 2 are those of ROS 2 Jazzy.
//     mcap_test.js TOOL SAMPLE PROJECT
const assert = require("node:assert/strict");
const { execFileSync, spawnSync } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const { after, test } = require("node:test");

const { Bag } = require("@foxglove/rosbag");
const { FileReader } = require("@foxglove/rosbag/node");
const { parse } = require("@foxglove/rosmsg");
const { ros2humble, ros2jazzy } = require("@foxglove/rosmsg-msgs-common");
const { MessageReader: Ros1Reader } = require("@foxglove/rosmsg-serialization");
const { MessageReader: Ros2Reader } = require("@foxglove/rosmsg2-serialization");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { decompress } = require("fzstd");

const [tool, sample, project] = process.argv.slice(2);
const work = fs.mkdtempSync(path.join(os.tmpdir(), "bin_scenes_mcap_"));
after(() => fs.rmSync(work, { recursive: true }));
const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };
const text = (bytes) => new TextDecoder().decode(bytes);
const is_ros2 = (file) => file.profile === "ros2";

/** {profile, topics: {name: {type, definition, metadata, bytes, time}}, attachments, metadata}, found by the index. */
async function read_mcap(name) {
  const bytes = fs.readFileSync(name);
  const readable = { size: async () => BigInt(bytes.length), read: async (at, n) => bytes.subarray(Number(at), Number(at + n)) };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const file = { profile: reader.header.profile, topics: {}, attachments: {}, metadata: {}, statistics: reader.statistics };
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    assert.equal(channel.messageEncoding, is_ros2(file) ? "cdr" : "ros1");
    assert.equal(schema.encoding, is_ros2(file) ? "ros2msg" : "ros1msg");
    assert.ok(!(channel.topic in file.topics), "one message a topic");
    file.topics[channel.topic] = { type: schema.name, definition: text(schema.data), metadata: channel.metadata,
                                   bytes: message.data, time: message.logTime };
  }
  for await (const one of reader.readAttachments()) file.attachments[one.name] = text(one.data);
  for await (const one of reader.readMetadata()) file.metadata[one.name] = Object.fromEntries(one.metadata);
  assert.equal(Number(file.statistics.messageCount), Object.keys(file.topics).length);
  assert.deepEqual(messages_from_front(bytes), Object.values(file.topics).map((topic) => topic.bytes.length).sort());
  return file;
}

/** Sizes of the messages that a reader finds that knows no index; it checks every checksum. */
function messages_from_front(bytes) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
  reader.append(bytes);
  const sizes = [];
  for (let record; (record = reader.nextRecord()); ) if (record.type === "Message") sizes.push(record.data.length);
  assert.ok(reader.done());
  return sizes.sort();
}

/** {topic: {type, definition, bytes, time}} */
async function read_bag(name) {
  const reader = new FileReader(name);
  const bag = new Bag(reader, { parse: false });
  await bag.open();
  const topics = {};
  for await (const result of bag.messageIterator()) {
    const connection = bag.connections.get(result.connectionId);
    topics[result.topic] = { type: connection.type, definition: connection.messageDefinition, latching: connection.latching,
                             bytes: result.data, time: BigInt(result.timestamp.sec) * 1000000000n + BigInt(result.timestamp.nsec) };
  }
  await reader.close();
  return topics;
}

/** Fields without defaults, which are for those who fill messages. */
function fields_of(definition) {
  const fields = definition.definitions.filter((field) => !field.isConstant);
  return JSON.parse(JSON.stringify(fields.map((field) => ({ ...field, defaultValue: undefined }))));
}

/** Which fields of ROS 2 a value of ROS 1 has no counterpart of; all are at their default. */
const of_ros2_alone = new Set(["texture_resource", "texture", "uv_coordinates", "mesh_file"]);
function is_default(value) {
  if (typeof value === "object") return Object.values(value).every(is_default);
  return value === "" || value === 0;
}

let compared = 0;  // values
function same(ros1, ros2, where) {
  if (typeof ros1 !== "object") {
    ++compared;
    return assert.ok(Object.is(ros1, ros2), `${where}: ${ros1} is not ${ros2}`);
  }
  if (Array.isArray(ros1) || ArrayBuffer.isView(ros1)) {
    assert.equal(ros1.length, ros2.length, where);
    for (let i = 0; i < ros1.length; ++i) same(ros1[i], ros2[i], `${where}[${i}]`);
    return;
  }
  const rest = new Set(Object.keys(ros2));
  for (const [key, value] of Object.entries(ros1)) {
    if (key === "seq" && "frame_id" in ros1) continue;  // of a Header; ROS 2 has none
    const name = key === "nsec" ? "nanosec" : key.toLowerCase();
    const found = name in ros2 ? name : key;  // the reader calls nanoseconds as it likes
    assert.ok(rest.delete(found), `${where}.${name} is missing`);
    same(value, ros2[found], `${where}.${name}`);
  }
  for (const key of rest) {
    assert.ok(of_ros2_alone.has(key), `${where}.${key} is in no message of ROS 1`);
    assert.ok(is_default(ros2[key]), `${where}.${key}`);
  }
}

function ros1_value(topic) {
  return new Ros1Reader(parse(topic.definition)).readMessage(topic.bytes);
}
function ros2_value(topic) {
  return new Ros2Reader(parse(topic.definition, { ros2: true })).readMessage(topic.bytes);
}

/** Fields of all standard types of a file as ROS 2 has them. */
function expect_definitions_of_ros2(file) {
  const seen = new Set();
  for (const topic of Object.values(file.topics)) {
    for (const definition of parse(topic.definition, { ros2: true })) {
      const name = definition.name ?? topic.type.replace("/msg/", "/");
      if (name.startsWith("bin_scenes/")) continue;
      for (const distribution of [ros2humble, ros2jazzy]) {
        const known = distribution[name];
        if (name.startsWith("builtin_interfaces/") && !known) continue;  // the parser's own
        assert.ok(known, `${name} is no type of ROS 2`);
        assert.deepEqual(fields_of(definition), fields_of(known), name);
      }
      seen.add(name);
    }
  }
  for (const name of ["tf2_msgs/TFMessage", "sensor_msgs/PointCloud2", "sensor_msgs/Image", "sensor_msgs/CameraInfo",
                      "visualization_msgs/Marker", "std_msgs/Header"])
    assert.ok(seen.has(name), name);
}

/** Names of our own types are those of ROS 2, and fields those of msg/. */
function expect_own_definitions(file) {
  const seen = new Set();
  for (const definition of parse(file.topics[Object.keys(file.topics).find((name) => name.endsWith("/scene"))].definition,
                                 { ros2: true })) {
    const name = definition.name ?? "bin_scenes/Scene";
    if (!name.startsWith("bin_scenes/")) continue;
    const own = parse(fs.readFileSync(path.join(project, "msg", `${name.split("/")[1]}.msg`), "utf8"),
                      { skipTypeFixup: true });
    const short = (type) => type.split("/").at(-1);
    assert.deepEqual(fields_of(definition).map((field) => [short(field.type), field.name, field.arrayLength]),
                     fields_of(own[0]).map((field) => [short(field.type), field.name.toLowerCase(), field.arrayLength]));
    assert.deepEqual(definition.definitions.filter((one) => one.isConstant).map((one) => [one.name, one.value]),
                     own[0].definitions.filter((one) => one.isConstant).map((one) => [one.name, one.value]));
    for (const field of fields_of(definition)) assert.match(field.name, /^[a-z][a-z0-9_]*$/);
    seen.add(name);
  }
  assert.ok(seen.size >= 10, [...seen].join(" "));
}

function expect_topics(bag, file) {
  assert.deepEqual(Object.keys(file.topics).sort(), Object.keys(bag).sort());
  assert.equal(Object.keys(file.topics)[0], "/tf_static", "a player knows the frames at once");
}

function expect_bag_in_ros1(bag, file) {
  assert.equal(file.profile, "ros1");
  expect_topics(bag, file);
  for (const [name, topic] of Object.entries(bag)) {
    const found = file.topics[name];
    assert.equal(found.type, topic.type);
    assert.equal(found.definition, topic.definition);
    assert.equal(found.time, topic.time);
    assert.equal(found.metadata.get("latching"), String(topic.latching));
    assert.ok(Buffer.from(found.bytes).equals(Buffer.from(topic.bytes)), name);
  }
}

function expect_bag_in_ros2(bag, file) {
  assert.equal(file.profile, "ros2");
  expect_topics(bag, file);
  compared = 0;
  for (const [name, topic] of Object.entries(bag)) {
    const found = file.topics[name];
    assert.equal(found.type, topic.type.replace("/", "/msg/"));
    assert.equal(found.time, topic.time);
    const durability = /durability: (\d)/.exec(found.metadata.get("offered_qos_profiles"))[1];
    assert.equal(durability, topic.latching ? "1" : "2", `${name}: latched is transient_local`);
    same(ros1_value(topic), ros2_value(found), name);
  }
  expect_definitions_of_ros2(file);
  expect_own_definitions(file);
}

test("every field of a scene that has all of them", async () => {
  execFileSync(sample, [work]);
  const bag = await read_bag(path.join(work, "scene.bag"));
  assert.equal(Object.keys(bag).length, 15, "scene, markers, tf, tf_static, the end, five of each sensor");
  expect_bag_in_ros1(bag, await read_mcap(path.join(work, "ros1.mcap")));
  expect_bag_in_ros2(bag, await read_mcap(path.join(work, "ros2.mcap")));
  assert.ok(compared > 2000, `${compared} values`);
});

/** [[topic, time, bytes], ...] of all messages. */
async function all_of_bag(name) {
  const reader = new FileReader(name);
  const bag = new Bag(reader, { parse: false });
  await bag.open();
  const all = [];
  for await (const result of bag.messageIterator()) {
    all.push([result.topic, BigInt(result.timestamp.sec) * 1000000000n + BigInt(result.timestamp.nsec),
              Buffer.from(result.data).toString("hex")]);
  }
  await reader.close();
  return all.sort();
}
async function all_of_mcap(name) {
  const bytes = fs.readFileSync(name);
  const readable = { size: async () => BigInt(bytes.length), read: async (at, n) => bytes.subarray(Number(at), Number(at + n)) };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const all = [];
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    all.push([channel.topic, message.logTime, Buffer.from(message.data).toString("hex")]);
  }
  return { profile: reader.header.profile, topics: [...reader.channelsById.values()].map((channel) => channel.topic).sort(), all: all.sort() };
}

test("a trace has the messages of the bag", async () => {
  fs.writeFileSync(path.join(work, "fall.yaml"), `
bin: {inner_size: [0.24, 0.2, 0.15]}
parts: [{model: ${path.join(project, "models", "nut_hex.stl")}, unit: mm, count: 4}]
`);
  // The scene is set apart, because parts still move; its trace is whole all the same.
  const trace = (name, ...more) => spawnSync(tool, ["generate", "fall.yaml", "--out", `out_${name}`, "--seconds", "0.4",
                                                       "--trace", name, ...more], { cwd: work, stdio: "pipe" });
  trace("fall.bag");
  trace("fall.mcap");
  trace("fall2.mcap", "--mcap", "ros2");
  const bag = await all_of_bag(path.join(work, "fall.bag"));
  const ros1 = await all_of_mcap(path.join(work, "fall.mcap"));
  const ros2 = await all_of_mcap(path.join(work, "fall2.mcap"));
  assert.deepEqual(ros1.topics, ["/contacts", "/markers", "/tf", "/tf_static"], "a channel a topic, not one a message");
  assert.ok(bag.length > 80, `${bag.length} messages`);
  assert.deepEqual(ros1.all, bag);
  assert.equal(ros2.profile, "ros2");
  assert.deepEqual(ros2.all.map(([topic, time]) => [topic, time]), bag.map(([topic, time]) => [topic, time]));
});

test("a data set of each profile", async () => {
  const plan = (name, outputs, more) => fs.writeFileSync(path.join(work, name), `
seed: 3
scenes: 2
outputs: [${outputs}]
${more}
request:
  bin: {inner_size: [0.24, 0.2, 0.15]}
  solver: {type: bullet}
  parts: [{model: ${path.join(project, "models", "nut_hex.stl")}, unit: mm, count: 4}]
  sensors:
    - {name: camera, width: 64, height: 48, distortion: [0.05, -0.02, 0.001, 0.002, 0.01]}
    - {name: line, preset: laser_line_0.5m_350mm, width: 64, height: 48}
`);
  plan("one.yaml", "json, bag, mcap", "");
  plan("two.yaml", "json, mcap", "mcap: ros2");
  for (const name of ["one", "two"])
    execFileSync(tool, ["dataset", `${name}.yaml`, "--out", name, "--workers", "1"], { cwd: work, stdio: "pipe" });
  for (const scene of ["scene_000000", "scene_000001"]) {
    const folder = path.join(work, "one", "scenes", scene);
    const bag = await read_bag(path.join(folder, "scene.bag"));
    const ros1 = await read_mcap(path.join(folder, "scene.mcap"));
    const ros2 = await read_mcap(path.join(work, "two", "scenes", scene, "scene.mcap"));
    expect_bag_in_ros1(bag, ros1);
    expect_bag_in_ros2(bag, ros2);
    const json = fs.readFileSync(path.join(folder, "scene.json"), "utf8");
    for (const file of [ros1, ros2]) {
      assert.equal(file.attachments["scene.json"], json);
      assert.equal(file.metadata.bin_scenes.request_sha256, JSON.parse(json).request_sha256);
      assert.equal(file.metadata.bin_scenes.index, String(JSON.parse(json).index));
    }
    // The attached request makes this scene, and no other.
    fs.writeFileSync(path.join(work, "attached.yaml"), ros2.attachments["request.yaml"]);
    execFileSync(tool, ["generate", "attached.yaml", "--out", "again"], { cwd: work, stdio: "pipe" });
    const again = JSON.parse(fs.readFileSync(path.join(work, "again", scene, "scene.json"), "utf8"));
    const poses = (scene) => scene.parts.map((part) => part.pose);
    assert.deepEqual(poses(again), poses(JSON.parse(json)));
  }
});

test("a plan names a profile only for files it writes", () => {
  fs.writeFileSync(path.join(work, "bad.yaml"), "scenes: 1\noutputs: [json]\nmcap: ros3\nrequest: {parts: [{model: a.stl}]}\n");
  assert.throws(() => execFileSync(tool, ["dataset", "bad.yaml", "--out", "bad"], { cwd: work, stdio: "pipe" }), (error) => {
    assert.equal(error.status, 2);
    assert.match(String(error.stderr), /bad.yaml:3.*does not contain mcap/);
    assert.match(String(error.stderr), /bad.yaml:3.*ros3.*ros1 or ros2/);
    return true;
  });
});
