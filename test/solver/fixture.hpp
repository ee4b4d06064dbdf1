/// Every solver runs the same tests: a test file lists its factories and instantiates the suites of closed_forms.hpp
/// with them.
#pragma once

#include "solver/lab.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace bin_scenes::testing {

struct SolverCase {
  std::string name;
  std::function<std::unique_ptr<Solver>()> make;
  double rounding = 1e-5;  ///< of energies: of double precision settings, or 1e-4 for bodies in single precision
  Ground ground = Ground::floor;
};
/// The same on each of the grounds given as meshes.
inline std::vector<SolverCase> on_meshes(const SolverCase& solver) {
  std::vector<SolverCase> cases;
  for (const Ground ground : {Ground::plate, Ground::turned_plate, Ground::heavy_plate})
    cases.push_back({solver.name + "_" + name_of(ground), solver.make, solver.rounding, ground});
  return cases;
}
inline std::ostream& operator<<(std::ostream& out, const SolverCase& solver) {
  return out << solver.name;
}

class SolverTest : public ::testing::TestWithParam<SolverCase> {
 protected:
  Lab lab() { return on(GetParam().ground); }
  Lab on(Ground ground) { return Lab(GetParam().make(), nullptr, ground); }
};

}  // namespace bin_scenes::testing
