/// Results must not depend on which invocation or group comes first: a device promises no order but that of barriers.
#include "solver/sphere_gl/handful.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace bin_scenes::sphere_gl {
namespace {

/// Programs that are made meanwhile number their invocations and groups in another order.
class Shuffled {
 public:
  Shuffled() { setenv("BIN_SCENES_SHUFFLE", "1", 1); }
  ~Shuffled() { unsetenv("BIN_SCENES_SHUFFLE"); }
};

std::uint64_t shuffled(int variant, const Capacity& capacity = {}) {
  const Shuffled other_order;
  return fallen(variant, capacity);
}

TEST(SphereGlOrder, OfInvocationsDoesNotMatterInOneGroup) {
  EXPECT_EQ(shuffled(2), fallen(2));
}

TEST(SphereGlOrder, OfGroupsDoesNotMatterWhereManyShareAWorld) {
  Capacity spread;
  spread.group_bodies = 0;
  EXPECT_EQ(shuffled(2, spread), fallen(2, spread));
}

}  // namespace
}  // namespace bin_scenes::sphere_gl
