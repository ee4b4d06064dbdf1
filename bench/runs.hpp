/// Scenes that are poured to be measured: "150 rings in the usual bin, three seeds, each in a process of its own".
#pragma once

#include "bin_scenes/generate/generator.hpp"
#include "framework/isolated.hpp"

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace bin_scenes::bench {

/// `count` copies of a part of models/ (steel) in a box, friction 0.5 everywhere. The floor grows with the count from
/// 0.40 x 0.30 m for 150 parts, so that heaps are equally deep.
Request bin_of(const std::string& part, std::size_t count);

/// The solvers as figures name them: "sphere", "bullet", "sphere/thesis".
void choose_solver(Request& request, const std::string& name);

/// Seconds since it was made, of all threads and of the wall.
class Clock {
 public:
  double cpu_s() const { return cpu_seconds() - cpu_; }
  double wall_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count(); }

 private:
  double cpu_ = cpu_seconds();
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
};

/// "coloring 1.2; step 812": the stages that take more than a hundredth of the time, in ms times `scale`.
std::string stages_of(const Profile& profile, double scale = 1.0);

/// The request with the models of its part lines, and the solver that it names.
LoadedRequest loaded(const Request& request);
std::unique_ptr<Solver> solver_of(const LoadedRequest& loaded);
/// Pours one scene, in a process of its own, and writes it to a scene.json.
void pour_into(const std::string& path, const Request& request);
/// A solver that no request can name; none: the request's.
using MakeSolver = std::function<std::unique_ptr<Solver>()>;

/// One judged scene, timed from request to final poses: judging comes after.
struct Poured {
  Scene scene;
  LoadedRequest loaded;
  double scene_s = 0.0;  ///< wall seconds; models are cached on disk after the first time
  double cpu_s = 0.0;    ///< of all threads, in that time: what a busy machine falsifies less
};
Poured pour_timed(const Request& request, const MakeSolver& make = {});

/// Makes what the request needs of its parts, so that it is in the cache when a scene is timed.
void warm_up(const Request& request);
/// The same after choosing the solver.
void warm_up(Request& request, const std::string& solver);

/// Scene time, errors on the true mesh as a share of the part's diagonal, rest, stage times.
Row figures_of(const Poured& poured);

/// One row of several with the same columns: measures keep all samples, exact numbers are added up, the rest is the
/// first row's. The last one alone if it failed, so that it has no figures.
Row joined(const std::vector<Row>& samples);

}  // namespace bin_scenes::bench
