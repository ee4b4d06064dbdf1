/// The referee and stock Bullet against what mechanics says of one box.
#include "referee.hpp"

#include "peers/stock_bullet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace bin_scenes::bench {
namespace {

const Vec3 size(0.04, 0.03, 0.02);
const double diagonal = size.norm();

std::vector<Vec3> corners(const Vec3& from, const Vec3& to) {
  std::vector<Vec3> out;
  for (int i = 0; i < 8; ++i)
    out.emplace_back(i & 1 ? to.x() : from.x(), i & 2 ? to.y() : from.y(), i & 4 ? to.z() : from.z());
  return out;
}

struct Box {
  PartModelPtr part;
  Pieces pieces;  ///< two halves: one part, two pieces that touch
  Request request;

  Box() {
    Mesh mesh;
    mesh.vertices = corners(Vec3::Zero(), size);  // the file's origin is a corner, far from the centre of mass
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    part = PartModel::from_mesh(mesh, "box");
    const double half = 0.5 * size.x();
    pieces = {corners(Vec3::Zero(), Vec3(half, size.y(), size.z())), corners(Vec3(half, 0, 0), size)};
    request.parts.emplace_back();
  }
  /// Drift of the box with its lower face at height `z`, turned by `angle` about the vertical.
  Drift drift(double z, double angle = 0.3) const {
    Scene scene;
    ScenePart placed;
    placed.pose.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    placed.pose.position = Vec3(0.01, -0.02, z);
    placed.state = PartState::resting;
    scene.parts = {placed};
    return referee_drift(scene, {request, {part}}, {pieces});
  }
};

/// A scene of boxes at these places, unturned.
Scene boxes_at(const std::vector<Vec3>& places) {
  Scene scene;
  for (const Vec3& place : places) {
    ScenePart placed;
    placed.pose.position = place;
    placed.state = PartState::resting;
    scene.parts.push_back(placed);
  }
  return scene;
}

// Before the referee, which sets globals of Bullet: figures are made in a process each.

/// Settled on the floor, upright, where it was dropped.
TEST(StockBullet, ADroppedBoxLiesOnTheFloor) {
  const Box box;
  StockBullet settings;
  settings.time_step = 1.0 / 240.0;
  settings.pieces = {box.pieces};
  const std::unique_ptr<Solver> solver = make_stock_bullet(settings);
  WorldDef def;
  def.parts = {box.part};
  def.bodies.emplace_back();
  def.bodies[0].mass = 0.1;
  def.wall_height = 0.2;
  const WorldId world = solver->add_world(def);
  BodyState start;
  start.pose.position = Vec3(0.05, 0.02, 0.01);
  start.velocity.linear = Vec3(0, 0, -0.1);
  solver->insert(world, 0, start);
  EXPECT_DOUBLE_EQ(solver->advance({world}, 1.0), 1.0);
  const BodyState end = solver->states(world)[0];
  EXPECT_NEAR(end.pose.position.z(), settings.margin, 0.005 * diagonal);
  EXPECT_NEAR(end.pose.position.x(), 0.05, 0.02 * diagonal);
  EXPECT_LT(end.pose.orientation.angularDistance(Quat::Identity()), 0.02);
  EXPECT_LT(end.velocity.linear.norm(), 0.01);
}

TEST(StockBullet, BodiesFallAsGalileiSays) {
  const Box box;
  StockBullet settings;
  settings.time_step = 0.001;
  settings.pieces = {box.pieces};
  const std::unique_ptr<Solver> solver = make_stock_bullet(settings);
  WorldDef def;
  def.parts = {box.part};
  def.bodies.emplace_back();
  def.bin.kind = Bin::Kind::none;
  const WorldId world = solver->add_world(def);
  BodyState start;
  start.velocity = {Vec3(0.3, 0, 0), Vec3(0, 0, 2.0)};  // about a principal axis: the centre of mass flies straight
  solver->insert(world, 0, start);
  const Vec3 before = start.pose * box.part->mass().center;
  solver->advance({world}, 0.5);
  const BodyState end = solver->states(world)[0];
  const Vec3 displacement = end.pose * box.part->mass().center - before;
  EXPECT_NEAR(displacement.x(), 0.15, 1e-4);
  EXPECT_NEAR(displacement.y(), 0.0, 1e-4);
  EXPECT_NEAR(displacement.z(), -0.5 * 9.81 * 0.25, 0.5 * 9.81 * 0.5 * 0.001 * 1.1);  // first order in the step
  EXPECT_NEAR(2.0 * std::atan2(end.pose.orientation.z(), end.pose.orientation.w()), 1.0, 1e-3);
}

TEST(Referee, SeesHowDeepBoxesOverlap) {
  const Box box;
  const double depth = 0.01 * diagonal;
  // The second stands in the first by its depth, also where the first's two pieces meet; the third stands apart.
  const Scene scene = boxes_at({Vec3::Zero(), Vec3(0.01, 0, size.z() - depth), Vec3(0.1, 0, 0)});
  const Overlap overlap = referee_overlap(scene, {box.request, {box.part}}, {box.pieces});
  ASSERT_EQ(overlap.pairs.size(), 1u);
  EXPECT_NEAR(overlap.pairs[0], 0.01, 1e-5);
  EXPECT_EQ(overlap.bin, (std::vector<double>{0.0, 0.0, 0.0}));
}

TEST(Referee, SeesHowDeepBoxesAreInFloorAndWalls) {
  const Box box;
  const double wall = 0.5 * box.request.bin.inner_size.x();
  const Scene scene = boxes_at({Vec3(0, 0, -0.02 * diagonal), Vec3(wall - size.x() + 0.03 * diagonal, 0, 0)});
  const Overlap overlap = referee_overlap(scene, {box.request, {box.part}}, {box.pieces});
  ASSERT_EQ(overlap.bin.size(), 2u);
  EXPECT_NEAR(overlap.bin[0], 0.02, 1e-9);
  EXPECT_NEAR(overlap.bin[1], 0.03, 1e-9);
  EXPECT_TRUE(overlap.pairs.empty());
}

TEST(Referee, WhatRestsStays) {
  const Drift drift = Box().drift(0.0);
  ASSERT_EQ(drift.moved.size(), 1u);
  EXPECT_LT(drift.moved[0], 1e-4);
  EXPECT_LT(drift.turned[0], 0.01);
}

TEST(Referee, WhatOverlapsRisesByItsOverlap) {
  const double depth = 0.01 * diagonal;
  EXPECT_NEAR(Box().drift(-depth).moved[0], 0.01, 1e-3);
}

TEST(Referee, WhatFloatsFalls) {
  EXPECT_NEAR(Box().drift(0.05 * diagonal).moved[0], 0.05, 2e-3);
}

std::string pieces_of(const std::string& part) {
  return std::getenv("BIN_SCENES_MODELS") + ("/pieces/" + part + ".obj");
}

TEST(Referee, ReadsThePiecesOfASample) {
  EXPECT_EQ(read_pieces(pieces_of("channel_u"), 1e-3).size(), 3u);
  EXPECT_EQ(read_pieces(pieces_of("ring_24"), 1e-3).size(), 24u);
  EXPECT_ANY_THROW(read_pieces(pieces_of("no_such_part"), 1e-3));
}

}  // namespace
}  // namespace bin_scenes::bench
