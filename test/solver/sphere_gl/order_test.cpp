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

std::uint64_t shuffled(int variant) {
  const Shuffled other_order;
  return fallen(variant);
}

TEST(SphereGlOrder, OfInvocationsAndGroupsDoesNotMatter) {
  EXPECT_EQ(shuffled(2), fallen(2));
}

}  // namespace
}  // namespace bin_scenes::sphere_gl
