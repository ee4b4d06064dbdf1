#include "scene_message.hpp"
#include "message_fields.hpp"
#include "scene/report_keys.hpp"
#include "scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace bin_scenes {
namespace {

using testing::full_scene;
using testing::request_of;

const ros::Time stamp(12, 34);

/// Sends a message through ROS's serialisation, as a topic would.
template <class Message>
Message wire(const Message& message) {
  ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  Message back;
  ros::serialization::deserializeMessage(bytes, back);
  return back;
}

bool same(const Pose& a, const Pose& b) {
  const auto equal = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  for (int i = 0; i < 3; ++i) {
    if (!equal(a.position[i], b.position[i])) return false;
  }
  return a.orientation.coeffs() == b.orientation.coeffs();
}

TEST(SceneMessage, KeepsTheNamesOtherPackagesSee) {
  EXPECT_STREQ(ros::message_traits::datatype<bin_scenes_msgs::Scene>(), "bin_scenes/Scene");
  EXPECT_STREQ(ros::service_traits::datatype<bin_scenes_msgs::GenerateScene>(), "bin_scenes/GenerateScene");
}

bool same(const Vec3& a, const geometry_msgs::Vector3& b) {
  return a == Vec3(b.x, b.y, b.z);
}

TEST(SceneMessage, PartsAndSensorsArriveBitForBit) {
  const Scene scene = full_scene();
  const auto message = wire(scene_message(scene, request_of(scene), Frames(), stamp));
  EXPECT_EQ(message.seed, scene.seed);
  EXPECT_EQ(message.index, scene.index);
  ASSERT_EQ(message.parts.size(), scene.parts.size());
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ScenePart& a = scene.parts[i];
    const auto& b = message.parts[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.line, b.line);
    EXPECT_EQ(a.model, b.model);
    EXPECT_TRUE(same(a.pose, pose_from(b.pose))) << "part " << i;
    EXPECT_TRUE(same(a.velocity.linear, b.velocity.linear)) << "part " << i;
    EXPECT_TRUE(same(a.velocity.angular, b.velocity.angular)) << "part " << i;
    EXPECT_EQ(static_cast<std::uint8_t>(a.state), b.state);
    ASSERT_EQ(b.visible_fraction.size(), scene.sensors.size());
    for (std::size_t s = 0; s < scene.sensors.size(); ++s) {
      const auto seen = a.visible_fraction.find(scene.sensors[s].name);
      if (seen != a.visible_fraction.end())
        EXPECT_EQ(b.visible_fraction[s], seen->second);
      else
        EXPECT_TRUE(std::isnan(b.visible_fraction[s])) << "part " << i;
    }
  }
  ASSERT_EQ(message.sensors.size(), scene.sensors.size());
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const Sensor& a = scene.sensors[i];
    const auto& b = message.sensors[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.model, b.model);
    EXPECT_EQ(a.width, static_cast<int>(b.width));
    EXPECT_EQ(a.height, static_cast<int>(b.height));
    EXPECT_EQ(a.fov, b.fov);
    EXPECT_TRUE(std::equal(a.k.begin(), a.k.end(), b.K.begin()));
    EXPECT_TRUE(same(*a.pose, pose_from(b.pose)));
    EXPECT_EQ(a.near, b.near);
    EXPECT_EQ(a.far, b.far);
  }
}

/// Gives every value of a report another number, and keeps the numbers and texts by the paths of their keys.
class Numbering {
 public:
  template <class Value>
  void field(const Key& key, Value& value) {
    set(value);
    paths.emplace_back(section_ + key.name);
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    const std::string outer = section_;
    section_ += key.name + std::string(".");
    visit(*this, value);
    section_ = outer;
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>& values) {
    values.resize(2);
    for (Struct& value : values) section(key, value);
  }
  std::vector<std::string> paths;
  std::vector<double> numbers;
  std::vector<std::string> texts;

 private:
  template <class Number>
  std::enable_if_t<std::is_arithmetic_v<Number>> set(Number& value) {
    if constexpr (std::is_same_v<Number, bool>) return void(numbers.push_back(value = true));
    value = static_cast<Number>(numbers.size() + 2);  // 1 is true
    numbers.push_back(static_cast<double>(value));
  }
  void set(std::string& value) { texts.push_back(value = "text " + std::to_string(texts.size())); }
  void set(Hexadecimal& number) { set(number.value); }
  template <class Items>
  auto set(Items& items) -> decltype(items.begin(), void()) {
    if constexpr (std::is_same_v<Items, std::vector<int>> || std::is_same_v<Items, std::vector<std::string>>)
      items.resize(2);
    if constexpr (std::is_same_v<Items, std::map<std::string, double>> ||
                  std::is_same_v<Items, std::map<std::string, std::uint64_t>>) {
      const std::string name = "text " + std::to_string(texts.size());
      texts.push_back(name);
      set(items[name]);
    } else {
      for (auto& item : items) set(item);
    }
  }
  std::string section_;
};

/// All numbers and texts of a message.
class Leaves {
 public:
  template <class Value>
  void operator()(const std::string&, const Value& value) {
    add(value);
  }
  std::vector<double> numbers;
  std::vector<std::string> texts;

 private:
  template <class Value>
  void add(const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      numbers.push_back(static_cast<double>(value));
    } else if constexpr (std::is_same_v<Value, std::string>) {
      texts.push_back(value);
    } else if constexpr (ros::message_traits::IsMessage<Value>::value) {
      for_each_field(value, *this);
    } else {
      for (const auto& item : value) add(item);
    }
  }
};

template <class Value>
std::vector<Value> sorted(std::vector<Value> values) {
  std::sort(values.begin(), values.end());
  return values;
}

TEST(SceneMessage, EveryKeyOfTheReportArrives) {
  Report report;
  Numbering numbering;
  visit(numbering, report);
  ASSERT_GT(numbering.paths.size(), 40u);
  report.drift.measured = true;
  numbering.numbers.insert(numbering.numbers.end(), {1.0, 1.0});  // drift.measured and worst.penetration_known
  const auto message = wire(report_message(report));
  Leaves leaves;
  for_each_field(message, leaves);
  EXPECT_EQ(sorted(leaves.numbers), sorted(numbering.numbers));
  EXPECT_EQ(sorted(leaves.texts), sorted(numbering.texts));
}

TEST(SceneMessage, KeysOfSectionsAreWhereReadersExpectThem) {
  Report a = testing::full_report();
  a.energy = {0.1, 0.2, 3, {4.0, 0.5, 6, 7}};
  a.jam = {8.0, 9};
  const auto b = wire(report_message(a));
  EXPECT_EQ(a.penetration.p95, b.penetration.depth.p95);
  EXPECT_EQ(a.penetration.pair[1], b.penetration.pair[1]);
  EXPECT_EQ(a.penetration.bin_p95, b.penetration.bin_p95);
  EXPECT_EQ(a.gap.median, b.gap.median);
  EXPECT_EQ(a.drift.max, b.drift.distance.max);
  EXPECT_EQ(a.drift.turn_p95, b.drift.turn_p95);
  EXPECT_EQ(a.energy.time, b.energy.time);
  EXPECT_EQ(a.energy.thrown.time, b.energy.thrown_time);
  EXPECT_EQ(a.worst.penetration.value, b.worst.penetration);
  EXPECT_EQ(a.worst.penetration.relative, b.worst.penetration_relative);
  EXPECT_EQ(a.worst.penetration.pair[1], b.worst.pair[1]);
  EXPECT_EQ(a.worst.energy_gain.relative, b.worst.energy_gain);
  EXPECT_EQ(a.worst.energy_gain.time, b.worst.energy_gain_time);
  EXPECT_EQ(a.jam.ratio, b.jam_ratio);
  EXPECT_EQ(a.jam.part, b.jam_part);
  EXPECT_EQ(a.state_hash, b.state_hash);
  EXPECT_EQ(b.stages[1].stage, "settle");
  EXPECT_EQ(b.stages[1].ms, 40.0);
  EXPECT_EQ(b.counters[0].value, 1234567890123ull);
}

TEST(SceneMessage, UnknownDepthsAreZeroAndSayThatTheyAreUnknown) {
  Report report;
  report.worst.penetration = {false, 1.0, 1.0, {-1, -1}, 0.0};
  const auto message = report_message(report);
  EXPECT_FALSE(message.worst.penetration_known);
  EXPECT_EQ(message.worst.penetration, 0.0);
  EXPECT_EQ(message.worst.penetration_relative, 0.0);
  EXPECT_FALSE(message.drift.measured);
}

TEST(SceneMessage, SaysWhatItWasMadeFrom) {
  const Scene scene = full_scene();
  const auto message = scene_message(scene, request_of(scene), Frames(), stamp);
  EXPECT_EQ(message.header.stamp, stamp);
  EXPECT_EQ(message.header.frame_id, "bin");
  EXPECT_EQ(message.request_sha256, "c0ffee");
  EXPECT_EQ(message.bin.kind, "box");
  EXPECT_EQ(message.bin.inner_size.x, 0.3);
  EXPECT_EQ(message.bin.friction, std::vector<double>{0.0});
  EXPECT_EQ(message.parts[2].frame_id, "part_0002");
}

TEST(SceneMessage, AnImageThatWasNotMadeHasNoVisibleFraction) {
  const Scene scene = full_scene();
  const auto message = scene_message(scene, request_of(scene), Frames(), stamp);
  ASSERT_EQ(message.parts[2].visible_fraction.size(), 2u);
  EXPECT_TRUE(std::isnan(message.parts[2].visible_fraction[0]));
}

TEST(Frames, NamesAreStable) {
  EXPECT_EQ(part_frame(7), "part_0007");
  EXPECT_EQ(part_frame(12345), "part_12345");
  EXPECT_EQ(sensor_frame("camera"), "camera_optical_frame");
}

TEST(Frames, EveryPartWithAPoseHasATransform) {
  const Scene scene = full_scene();
  const auto tf = part_transforms(scene, Frames(), stamp);
  ASSERT_EQ(tf.transforms.size(), 3u);  // the fourth was never poured: NaN would poison every listener
  EXPECT_EQ(tf.transforms[1].child_frame_id, "part_0001");
  EXPECT_EQ(tf.transforms[1].header.frame_id, "bin");
  EXPECT_EQ(tf.transforms[1].header.stamp, stamp);
  EXPECT_EQ(tf.transforms[1].transform.translation.x, scene.parts[1].pose.position.x());
  EXPECT_EQ(tf.transforms[1].transform.rotation.w, scene.parts[1].pose.orientation.w());
}

TEST(Frames, BinAndSensorsAreStatic) {
  Frames frames;
  frames.bin_pose.position.x() = 2.0;
  const auto tf = static_transforms(full_scene(), frames, stamp);
  ASSERT_EQ(tf.transforms.size(), 3u);
  EXPECT_EQ(tf.transforms[0].header.frame_id, "world");
  EXPECT_EQ(tf.transforms[0].child_frame_id, "bin");
  EXPECT_EQ(tf.transforms[0].transform.translation.x, 2.0);
  EXPECT_EQ(tf.transforms[2].child_frame_id, "side_optical_frame");
  EXPECT_EQ(tf.transforms[2].transform.translation.z, 0.7);
  frames.parent.clear();
  EXPECT_EQ(static_transforms(full_scene(), frames, stamp).transforms.size(), 2u);
}

TEST(Frames, ZeroQuaternionOfAMessageIsTheIdentity) {
  EXPECT_EQ(pose_from(geometry_msgs::Pose()).orientation.w(), 1.0);
}

}  // namespace
}  // namespace bin_scenes
