#include "scene_message.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"

#include "scenes.hpp"

#include <gtest/gtest.h>

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

TEST(SceneMessage, PartsAndSensorsComeBackBitForBit) {
  const Scene scene = full_scene();
  const Scene back = scene_from(wire(scene_message(scene, request_of(scene), Frames(), stamp)));
  EXPECT_EQ(back.seed, scene.seed);
  EXPECT_EQ(back.index, scene.index);
  ASSERT_EQ(back.parts.size(), scene.parts.size());
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ScenePart &a = scene.parts[i], &b = back.parts[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.line, b.line);
    EXPECT_EQ(a.model, b.model);
    EXPECT_TRUE(same(a.pose, b.pose)) << "part " << i;
    EXPECT_EQ(a.velocity.linear, b.velocity.linear);
    EXPECT_EQ(a.velocity.angular, b.velocity.angular);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.visible_fraction, b.visible_fraction);
  }
  ASSERT_EQ(back.sensors.size(), scene.sensors.size());
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const Sensor &a = scene.sensors[i], &b = back.sensors[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.fov, b.fov);
    EXPECT_EQ(a.k, b.k);
    EXPECT_TRUE(same(*a.pose, *b.pose));
    EXPECT_EQ(a.near, b.near);
    EXPECT_EQ(a.far, b.far);
  }
}

TEST(SceneMessage, EverySensorModelComesBackAndAnotherIsRefused) {
  for (const SensorModel* model : sensor_models()) {
    Sensor sensor;
    sensor.model = model->name;
    EXPECT_EQ(sensor_from(sensor_message(sensor)).model, model->name);
  }
  bin_scenes_msgs::Sensor message = sensor_message(Sensor());
  message.model = "sonar";
  try {
    sensor_from(message);
    ADD_FAILURE() << "taken for another model";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'sonar'"), std::string::npos) << error.what();
  }
}

TEST(SceneMessage, ReportComesBackWhole) {
  const Report a = testing::full_report(), b = report_from(wire(report_message(a)));
  EXPECT_EQ(a.at_rest, b.at_rest);
  EXPECT_EQ(a.accepted, b.accepted);
  EXPECT_EQ(a.reasons, b.reasons);
  EXPECT_EQ(a.solver, b.solver);
  EXPECT_EQ(a.solver_reason, b.solver_reason);
  EXPECT_EQ(a.device, b.device);
  EXPECT_EQ(a.simulated_s, b.simulated_s);
  EXPECT_EQ(a.wall_s, b.wall_s);
  EXPECT_EQ(a.finish, b.finish);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.profile.stages_ms, b.profile.stages_ms);
  EXPECT_EQ(a.profile.counters, b.profile.counters);
  const auto values = [](const Quantiles& q) { return std::vector<double>{q.median, q.p95, q.max}; };
  EXPECT_EQ(values(a.penetration), values(b.penetration));
  EXPECT_EQ(a.penetration.pair, b.penetration.pair);
  EXPECT_EQ(a.penetration.p95_relative, b.penetration.p95_relative);
  EXPECT_EQ(a.penetration.max_relative, b.penetration.max_relative);
  EXPECT_EQ(a.penetration.bin_median, b.penetration.bin_median);
  EXPECT_EQ(a.penetration.bin_p95, b.penetration.bin_p95);
  EXPECT_EQ(a.penetration.bin_max, b.penetration.bin_max);
  EXPECT_EQ(a.penetration.bin_part, b.penetration.bin_part);
  EXPECT_EQ(a.penetration.pairs, b.penetration.pairs);
  EXPECT_EQ(values(a.gap), values(b.gap));
  EXPECT_EQ(values(a.drift), values(b.drift));
  EXPECT_EQ(a.drift.measured, b.drift.measured);
  EXPECT_EQ(a.drift.turn_p95, b.drift.turn_p95);
  EXPECT_EQ(a.worst.penetration.known, b.worst.penetration.known);
  EXPECT_EQ(a.worst.penetration.value, b.worst.penetration.value);
  EXPECT_EQ(a.worst.penetration.relative, b.worst.penetration.relative);
  EXPECT_EQ(a.worst.penetration.pair, b.worst.penetration.pair);
  EXPECT_EQ(a.worst.penetration.time, b.worst.penetration.time);
  EXPECT_EQ(a.worst.energy_gain.relative, b.worst.energy_gain.relative);
  EXPECT_EQ(a.worst.energy_gain.time, b.worst.energy_gain.time);
  EXPECT_EQ(a.worst.unresolved_impacts, b.worst.unresolved_impacts);
  EXPECT_EQ(a.escaped, b.escaped);
  EXPECT_EQ(a.unstable, b.unstable);
  EXPECT_EQ(a.not_poured, b.not_poured);
  EXPECT_EQ(a.state_hash, b.state_hash);
  ASSERT_EQ(b.flags.size(), 1u);
  EXPECT_EQ(a.flags[0].code, b.flags[0].code);
  EXPECT_EQ(a.flags[0].text, b.flags[0].text);
  EXPECT_EQ(a.flags[0].remedy, b.flags[0].remedy);
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
