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
};
inline std::ostream& operator<<(std::ostream& out, const SolverCase& solver) {
  return out << solver.name;
}

class SolverTest : public ::testing::TestWithParam<SolverCase> {
 protected:
  Lab lab() { return Lab(GetParam().make()); }
};

}  // namespace bin_scenes::testing
