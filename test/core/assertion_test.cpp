/// Corruptions that an assertion names, one for each kind of invariant; and that tests run with assertions on.
#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/gl/buffer.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/pour/contact_action.hpp"
#include "bin_scenes/pour/pour.hpp"
#include "bin_scenes/pour/rest_watch.hpp"
#include "bin_scenes/quality/quality.hpp"
#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/sensor/calibration.hpp"
#include "bin_scenes/sensor/filter.hpp"
#include "bin_scenes/sensor/range_image.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "part/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

namespace bin_scenes {
namespace {

struct AssertionDeath : testing::Test {
  AssertionDeath() { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

TEST(Assertion, IsOnInTests) {
  EXPECT_TRUE(assertions_on);
  BIN_SCENES_ASSERT(true);
}

TEST_F(AssertionDeath, IndexOutOfRange) {
  Mesh mesh = test::box_mesh({1, 1, 1});
  mesh.triangles[5][1] = static_cast<std::uint32_t>(mesh.vertices.size());
  EXPECT_DEATH(MeshQuery{mesh}, "assertion failed: indices_in_range\\(mesh\\) \\(mesh_query.cpp");
}

TEST_F(AssertionDeath, QuaternionOfAnotherLength) {
  const std::vector<PartModelPtr> parts{PartModel::from_mesh(test::box_mesh({0.1, 0.1, 0.1}), "box")};
  Request request;
  request.parts.resize(1);
  Scene scene;
  scene.parts.resize(1);
  scene.parts[0].state = PartState::resting;
  scene.parts[0].pose.orientation.coeffs() *= 1.01;
  const LoadedRequest loaded{request, parts};
  EXPECT_DEATH(judge(scene, loaded), "is_unit\\(part.pose.orientation\\) \\(judge.cpp");
}

TEST_F(AssertionDeath, ListThatIsNotSorted) {
  Motion motion;
  motion.times = {2.0, 1.0};
  motion.poses.resize(2);
  EXPECT_DEATH(motion.at(0.5), "ascends\\(times\\) \\(motion.cpp");
}

TEST_F(AssertionDeath, NumberThatIsNone) {
  EXPECT_DEATH(quantiles({1.0, std::nan("")}), "isnan\\(value\\).*report.cpp");
}

TEST_F(AssertionDeath, BodyThatIsNotThere) {
  RestWatch watch(3);
  EXPECT_DEATH(watch.observe(3, 0.0, Vec3::Zero(), Quat::Identity(), {}),
               "index < bodies_.size\\(\\) \\(rest_watch.cpp");
}

TEST_F(AssertionDeath, ImageThatLacksARow) {
  RangeImage image;
  image.width = 4;
  image.height = 3;
  image.depth.resize(8);
  EXPECT_DEATH(points_of(image), "image.depth.size\\(\\) == width \\* height \\(range_image.cpp");
}

TEST_F(AssertionDeath, NamesSceneStepAndPairAsFarAsTheyAreKnown) {
  const auto fail = [] { BIN_SCENES_ASSERT(1 > 2); };
  EXPECT_DEATH(fail(), "assertion failed: 1 > 2 \\(assertion_test.cpp:[0-9]+\\)\n");
  const AssertionScope scene({7});
  EXPECT_DEATH(fail(), "in scene 7\n");
  const AssertionScope step({-1, 120});
  {
    const AssertionScope pair({-1, -1, 3, 17});
    EXPECT_DEATH(fail(), "in scene 7, step 120, pair 3 and 17\n");
    EXPECT_DEATH(std::thread(fail).join(), "cpp:[0-9]+\\)\n") << "another thread works on something else";
  }
  const AssertionScope bin({-1, -1, 3});
  EXPECT_DEATH(fail(), "in scene 7, step 120, pair 3 and the bin\n");
}

/// A filter that is on, and the image of two pixels that it gets.
struct Filtered : AssertionDeath {
  Filtered() {
    settings.snr = 1.0;
    image.width = 2, image.height = 1;
    image.depth = {1.0f, std::nanf("")};
    image.label = {0, 0};
    image.snr = {5.0f, 0.0f};
    image.validity = {0, 1};
  }
  FilterSettings settings;
  RangeImage image;
};

TEST_F(Filtered, ImagesOfOtherSizes) {
  filter(settings, image);
  image.snr.pop_back();
  EXPECT_DEATH(filter(settings, image), "image.snr.size\\(\\) == image.depth.size\\(\\) \\(filter.cpp");
}

TEST_F(Filtered, DepthOfAPixelThatIsNotValid) {
  image.validity[0] = 4;
  EXPECT_DEATH(filter(settings, image), "validity_agrees\\(image\\) \\(filter.cpp");
}

TEST_F(AssertionDeath, SensorWithoutItsPose) {
  EXPECT_DEATH(true_device({Sensor()}, 0, 1), "sensors\\[number\\].pose.*calibration.cpp");
}

/// Two boxes, and a contact between them.
struct Contacts : AssertionDeath {
  Contacts() {
    loaded.request.parts.resize(1);
    loaded.request.parts[0].count = 2;
    loaded.parts = {PartModel::from_mesh(test::box_mesh({0.1, 0.1, 0.1}), "box")};
    force.b = 1;
    force.normal = Vec3::UnitZ();
    force.point = force.force = Vec3::Zero();
  }
  LoadedRequest loaded;
  std::vector<BodyState> states = std::vector<BodyState>(2);
  ContactForce force;
};

TEST_F(Contacts, StatesOfAnotherScene) {
  contacts_of({force}, states, states, loaded);
  states.emplace_back();
  EXPECT_DEATH(contacts_of({force}, {}, states, loaded), "now_.size\\(\\) == models_.size.*contact_action.cpp");
}

TEST_F(Contacts, BodyBeyondTheLast) {
  force.b = 2;
  EXPECT_DEATH(contacts_of({force}, states, states, loaded), "force.b < .*contact_action.cpp");
}

TEST_F(Contacts, NormalThatIsNotUnit) {
  force.normal *= 1.01;
  EXPECT_DEATH(contacts_of({force}, states, states, loaded), "f.normal.norm\\(\\) - 1.0.*contact_action.cpp");
}

TEST_F(AssertionDeath, PartWithoutMass) {
  LoadedRequest loaded;
  loaded.request.parts.resize(1);
  loaded.request.parts[0].mass = 0.0;
  loaded.parts = {PartModel::from_mesh(test::box_mesh({0.1, 0.1, 0.1}), "box")};
  EXPECT_DEATH(world_of(loaded), "body.mass > 0.0.*pour.cpp");
}

TEST_F(AssertionDeath, ModelThatCannotMeasure) {
  static const SensorModel half{"half", "", nullptr, nullptr, nullptr, nullptr, nullptr};
  EXPECT_DEATH(register_sensor_model(half), "model.measure.*sensor_model.cpp");
}

TEST_F(AssertionDeath, BufferWithoutRoomAndThreadWithoutContext) {
  const auto device = gl::Device::shared();
  gl::Buffer<std::uint32_t> buffer("words");
  buffer.resize(4);
  const std::vector<std::uint32_t> words(3, 1u);
  buffer.upload(1, words.data(), 3);
  EXPECT_DEATH(buffer.upload(2, words.data(), 3), "first \\+ count <= count_ \\(buffer.hpp");
  EXPECT_DEATH(std::thread([&] { buffer.upload(0, words.data(), 3); }).join(), "is_current.*buffer.cpp");
}

}  // namespace
}  // namespace bin_scenes
