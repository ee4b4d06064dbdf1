/// The heap that passes of both forms work on.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "solver/fixture.hpp"
#include "solver/sphere/make_world.hpp"

#include <algorithm>
#include <memory>
#include <vector>

namespace bin_scenes::sphere_gl {

/// Angle irons, eggs, balls and a fixed block, thrown together above a box.
struct Heap {
  std::vector<PartModelPtr> parts;
  std::vector<std::unique_ptr<sphere::Shape>> shapes;

  Heap() {
    using testing::box_mesh;
    parts = {PartModel::from_mesh(
                 testing::merged(box_mesh({0.06, 0.02, 0.02}), box_mesh({0.02, 0.04, 0.02}, {0.02, 0.03, 0})), "angle"),
             PartModel::from_mesh(testing::sphere_mesh(0.02, 3), "ball"),
             PartModel::from_mesh(box_mesh({0.05, 0.05, 0.05}), "block"), PartModel::from_mesh(egg_mesh(), "egg")};
    for (const PartModelPtr& part : parts)
      shapes.push_back(std::make_unique<sphere::Shape>(sphere::make_shape(*part, 100, 300, 0.02)));
  }

  static Mesh egg_mesh() {
    Mesh mesh = testing::sphere_mesh(0.02, 3);
    for (Vec3& v : mesh.vertices) v = v.cwiseProduct(Vec3(1.4, 1.0, 0.8));
    return mesh;
  }

  sphere::World world(std::size_t bodies, std::uint64_t seed, double spread = 0.1) const {
    WorldDef def;
    def.parts = parts;
    def.bin.kind = Bin::Kind::box;
    def.bin.inner_size = Vec3(2 * spread, 2 * spread, 0.2);
    def.wall_height = 0.2;
    for (std::size_t i = 0; i < bodies; ++i) {
      BodyDef body;
      body.part = i % 7 == 3 ? 1 : i % 7 == 6 ? 3 : 0;
      body.mass = 0.1;
      if (i == 5) {
        body.part = 2;
        body.fixed = true;
      }
      def.bodies.push_back(body);
    }
    sphere::World w = sphere::make_world(def, {}, [&](const PartModelPtr& part) -> const sphere::Shape& {
      return *shapes[std::find(parts.begin(), parts.end(), part) - parts.begin()];
    });
    Random random(seed, 0, Stream::probe);
    const auto along = [&](double half) { return random.uniform(-half, half); };
    for (std::size_t i = 0; i < bodies; ++i) {
      BodyState state;
      state.pose.orientation = random.orientation();
      state.pose.position = Vec3(along(spread), along(spread), 0.03 + 0.5 * spread + along(0.5 * spread));
      state.velocity.linear = Vec3(along(0.2), along(0.2), along(0.2));
      state.velocity.angular = Vec3(along(3), along(3), along(3));
      if (def.bodies[i].fixed) state.velocity = {};  // one that moves on a path is the CPU's alone
      sphere::place(w, i, state);
    }
    return w;
  }
};

/// The order in which the twin solves manifolds that the device has colored.
inline void take_order(sphere::World& world) {
  world.order.clear();
  for (int c = 0; c < SPHERE_COLORS; ++c)
    for (std::uint32_t m = 0; m < world.manifolds.size(); ++m)
      if (world.manifolds[m].color == c) world.order.push_back(m);
  for (sphere::Body& b : world.bodies) {
    b.rotation = b.q.toRotationMatrix();
    b.world_inverse_inertia = b.rotation * b.inverse_inertia * b.rotation.transpose();
  }
}

}  // namespace bin_scenes::sphere_gl
