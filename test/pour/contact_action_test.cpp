/// What contacts of a trace do, by states whose action is known: blocks of 0.1 m that rest, slide, overlap and fall.
#include "bin_scenes/pour/contact_action.hpp"
#include "part/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

struct ContactActions : testing::Test {
  ContactActions() {
    loaded.request.parts.resize(1);
    loaded.request.parts[0].count = 2;
    loaded.parts = {PartModel::from_mesh(test::box_mesh({0.1, 0.1, 0.1}), "box")};
    now.resize(2);
    now[1].pose.position.z() = 0.1;
  }
  /// Of the contact of both blocks, in the middle of the face that they share.
  ContactAction action(double gap = 0.0, int b = 1) const {
    ContactForce force;
    force.a = 0, force.b = b;
    force.point = Vec3(0.0, 0.0, b < 0 ? -0.05 : 0.05);
    force.normal = b < 0 ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitZ());
    force.force = 9.81 * force.normal;
    force.gap = gap;
    return contacts_of({force}, before, now, loaded).at(0).action;
  }
  double diagonal() const { return loaded.parts[0]->diagonal(); }

  LoadedRequest loaded;
  std::vector<BodyState> before, now;
};

TEST_F(ContactActions, NothingMoves) {
  EXPECT_EQ(action(), ContactAction::resting);
  EXPECT_EQ(action(0.0, -1), ContactAction::resting);
}

TEST_F(ContactActions, OverlapOfAThousandthOfTheDiagonal) {
  EXPECT_EQ(action(-0.9e-3 * diagonal()), ContactAction::resting);
  EXPECT_EQ(action(-1.1e-3 * diagonal()), ContactAction::pushed_apart);
}

TEST_F(ContactActions, SurfacesThatMoveAlongEachOther) {
  now[1].velocity.linear = Vec3(0.049 * diagonal(), 0.0, 0.0);
  EXPECT_EQ(action(), ContactAction::resting);
  now[1].velocity.linear = Vec3(0.051 * diagonal(), 0.0, 0.0);
  EXPECT_EQ(action(), ContactAction::sliding);
  now[0].velocity = now[1].velocity;
  EXPECT_EQ(action(), ContactAction::resting) << "both move alike";
  EXPECT_EQ(action(0.0, -1), ContactAction::sliding) << "over the bin";
}

TEST_F(ContactActions, RollingIsNotSliding) {
  now[0].velocity.angular = Vec3(0.0, 2.0, 0.0);
  now[0].velocity.linear = Vec3(0.1, 0.0, 0.0);  // w x r at the point below: (-0.1, 0, 0)
  EXPECT_EQ(action(0.0, -1), ContactAction::resting);
  now[0].velocity.linear = Vec3(-0.1, 0.0, 0.0);
  EXPECT_EQ(action(0.0, -1), ContactAction::sliding);
}

TEST_F(ContactActions, FallOfAHundredthOfTheDiagonal) {
  const double limit = std::sqrt(2.0 * 9.81 * 0.01 * diagonal());
  before = now;
  before[1].velocity.linear = Vec3(0.0, 0.0, -0.99 * limit);
  EXPECT_EQ(action(), ContactAction::resting);
  before[1].velocity.linear = Vec3(0.0, 0.0, -1.01 * limit);
  EXPECT_EQ(action(), ContactAction::impact) << "it approached in the previous sample";
  EXPECT_EQ(action(-diagonal()), ContactAction::impact) << "an impact may overlap";
  before[1].velocity.linear = Vec3(0.0, 0.0, 1.01 * limit);
  EXPECT_EQ(action(), ContactAction::resting) << "it went away then";
  now[1].velocity.linear = Vec3(0.0, 0.0, 1.01 * limit);
  EXPECT_EQ(action(), ContactAction::impact) << "it rebounds now";
}

TEST_F(ContactActions, PartsThatWereNotThere) {
  before = now;
  before[1].pose = Pose::none();
  before[1].velocity.linear = Vec3(0.0, 0.0, -9.0);
  EXPECT_EQ(action(), ContactAction::resting);
}

}  // namespace
}  // namespace bin_scenes
