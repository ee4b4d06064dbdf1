#include "bin_scenes/config/presets.hpp"
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "config_fixture.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

class Grippers : public ConfigTest {
 protected:
  std::string with(const std::string& grippers) { return bolts + "grippers: " + grippers + "\n"; }
  std::vector<Gripper> grippers_of(const std::string& grippers) { return read(with(grippers)).grippers; }
};

TEST_F(Grippers, PresetsAreTwoOfEachTypeAndGoodRequests) {
  std::size_t cups = 0, fingers = 0;
  for (const std::string& name : gripper_presets()) {
    const std::vector<Gripper> read_one = grippers_of("[" + name + "]");
    ASSERT_EQ(read_one.size(), 1u);
    EXPECT_EQ(read_one[0].name, name);
    ++(read_one[0].type == Gripper::Type::suction ? cups : fingers);
  }
  EXPECT_GE(cups, 2u);
  EXPECT_GE(fingers, 2u);
}

TEST_F(Grippers, KeysGoBeforeThePresetAndReadBack) {
  const std::string keys = "[{preset: cup_20mm, name: mine, radius: 0.02}, robotiq_2f_85, {name: two, stroke: 0.07}]";
  const std::vector<Gripper> grippers = grippers_of(keys);
  ASSERT_EQ(grippers.size(), 3u);
  EXPECT_EQ(grippers[0].name, "mine");
  EXPECT_EQ(grippers[0].radius, 0.02);
  EXPECT_EQ(grippers[0].force, gripper_preset("cup_20mm").force);
  EXPECT_EQ(grippers[1].travel(), 0.085);
  EXPECT_EQ(grippers[2].travel(), 0.07);
  const Request request = read(with(keys));
  const Request again = read(write_request(request));
  ASSERT_EQ(again.grippers.size(), 3u);
  EXPECT_EQ(again.grippers[0].radius, 0.02);
  EXPECT_EQ(again.text_sha256, request.text_sha256);
}

TEST_F(Grippers, WeightsOfTheScoreAreKeys) {
  const std::vector<Gripper> grippers = grippers_of("[{preset: cup_20mm, name: a, score: {upright: 2}}, cup_20mm]");
  EXPECT_EQ(grippers[0].score.upright, 2.0);
  EXPECT_EQ(grippers[0].score.moment, ScoreWeights().moment);
  EXPECT_EQ(grippers[1].score.upright, ScoreWeights().upright);
}

TEST_F(Grippers, CalibratedWeightsDependOnTheType) {
  const std::vector<Gripper> grippers =
      grippers_of("[cup_20mm, franka_hand, {preset: cup_20mm, name: c, score: {holding: 2}}]");
  const ScoreWeights cup = grippers[0].weights(), fingers = grippers[1].weights(), set = grippers[2].weights();
  EXPECT_GT(cup.holding.value(), fingers.holding.value());
  EXPECT_LT(cup.bias.value(), fingers.bias.value());
  EXPECT_EQ(set.holding.value(), 2.0);
  EXPECT_EQ(set.bias.value(), cup.bias.value());
  EXPECT_EQ(set.closing, cup.closing);
}

TEST_F(Grippers, ProofsNeedThem) {
  EXPECT_EQ(read(with("[cup_20mm]\nprove: 5")).prove, 5u);
  EXPECT_EQ(write_request(read(with("[cup_20mm]"))).find("prove"), std::string::npos);
  expect_refused(bolts + "prove: 5\n", {"prove", "the request has no grippers", "grippers: [robotiq_2f_85]"});
}

TEST_F(Grippers, WithoutThemNothingIsWritten) {
  const Request request = read(bolts);
  EXPECT_EQ(write_request(request).find("gripper"), std::string::npos);
}

TEST_F(Grippers, MistakesAreTold) {
  const std::pair<const char*, const char*> cases[] = {
      {"[{name: a, stroke: 0}]", "'grippers[0].stroke': must be above 0, is 0"},
      {"[{name: a, stroke: 85}]", "for mm write 0.085 m"},
      {"[{name: a, type: suction, radius: 10}]", "for mm write 0.01 m"},
      {"[{name: a, finger_width: 0.00002}]", "shorter than any gripper's"},
      {"[{name: a, finger_thickness: 0.25}]", "'a' is wider than the bin"},
      {"[{name: a, finger_width: 0.45}]", "'a' is wider than the bin"},
      {"[{name: a, clearance: 1}]", "for mm write 0.001 m"},
      {"[{name: a, pad_length: 0.06}]", "is longer than finger_depth, 0.05 m"},
      {"[{name: a, finger_clearance: 0.025}]", "leaves nothing of the stroke, 0.05 m"},
      {"[{name: a, type: suction, radius: 0.01, lip: 0.02}]", "is not smaller than the radius of the ring"},
      {"[{stroke: 0.05}]", "'grippers[0].name': is missing"},
      {"[{name: a}, {name: a}]", "'a' is also the name of another gripper"},
      {"[robotiq_2f_58]", "did you mean 'robotiq_2f_85'?"},
      {"[{name: a, strok: 0.1}]", "did you mean 'stroke'?"},
      {"[{name: a, type: magnet}]", "expected parallel | suction"},
      {"cup_20mm", "expected a list"},
  };
  for (const auto& [keys, expected] : cases) {
    expect_refused(with(keys), {expected, "request.yaml:"});
  }
}

}  // namespace
}  // namespace bin_scenes
