/// Sweeps leave out contacts that cannot press (shaders/sphere/near.h). That must not change a bit.
#include "gl/shader_source.hpp"
#include "solver/sphere_gl/handful.hpp"

#include <gtest/gtest.h>

#include <unistd.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace bin_scenes::sphere_gl {
namespace {

namespace fs = std::filesystem;

/// Angle irons that tumble onto the floor, each alone, and pairs of them that meet above it. No two manifolds share a
/// moving body: their order, which depends on the contacts that are left out, does not matter.
struct Apart {
  WorldDef def = Handful(0).def;
  std::vector<BodyState> starts;

  Apart() {
    def.bin.inner_size = Vec3(1.2, 0.6, 0.1);
    def.bodies.resize(16, def.bodies.front());
    for (BodyDef& body : def.bodies) body.restitution = 0;
    Random random(11, 0, Stream::probe);
    for (std::size_t i = 0; i < 16; ++i) {
      const bool falls = i < 8;
      const double place = 0.14 * static_cast<double>(falls ? i : (i - 8) / 2) - 0.5;
      const double side = i % 2 == 0 ? -1 : 1;
      BodyState state;
      state.pose.position = falls ? Vec3(place, -0.2, 0.035) : Vec3(place + 0.035 * side, 0.15, 0.4);
      state.pose.orientation = random.orientation();
      state.velocity.linear = falls ? Vec3(0, 0, -0.1) : Vec3(-0.15 * side, 0, 0);
      state.velocity.angular = Vec3(0.5, side, 0.3 * place);
      starts.push_back(state);
    }
  }
};

std::uint64_t moved() {
  const Apart apart;
  const auto solver = make_gl_sphere_solver(coarse(), {});
  const WorldId id = solver->add_world(apart.def);
  for (std::size_t i = 0; i < apart.starts.size(); ++i) solver->insert(id, i, apart.starts[i]);
  solver->advance({id}, 0.15);
  return hash_of(solver->states(id));
}

/// The same with another text in place of one in near.h.
std::uint64_t moved_with(const std::string& text, const std::string& other) {
  const char* set = std::getenv("BIN_SCENES_SHADERS");
  const std::string before = set ? set : "";
  const fs::path copy = fs::temp_directory_path() / ("bin_scenes_near_" + std::to_string(::getpid()));
  fs::copy(gl::shader_directory(), copy, fs::copy_options::recursive);
  std::stringstream source;
  source << std::ifstream(copy / "sphere/near.h").rdbuf();
  std::string near = source.str();
  const std::size_t at = near.find(text);
  if (at == std::string::npos) throw std::runtime_error("near.h has no '" + text + "'");
  std::ofstream(copy / "sphere/near.h") << near.replace(at, text.size(), other);
  setenv("BIN_SCENES_SHADERS", copy.c_str(), 1);
  const std::uint64_t hash = moved();
  fs::remove_all(copy);
  set ? setenv("BIN_SCENES_SHADERS", before.c_str(), 1) : unsetenv("BIN_SCENES_SHADERS");
  return hash;
}

TEST(SphereGlNear, WhatIsLeftOutWouldNotPress) {
  const std::uint64_t hash = moved();
  EXPECT_EQ(hash, moved_with("NEAR_REACH = 1.5", "NEAR_REACH = 1e30"));
  // Without the bound of speeds contacts would be left out that press.
  EXPECT_NE(hash, moved_with("return REACH_MARGIN * (", "return 0.0 * ("));
}

}  // namespace
}  // namespace bin_scenes::sphere_gl
