/// Scenes that are poured to be measured: "150 rings in the usual bin, three seeds, each in a process of its own".
#pragma once

#include "bin_scenes/generate/generator.hpp"
#include "framework/table.hpp"

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

/// Of all threads of this process so far (s).
double cpu_seconds();

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

/// One scene, timed from request to final poses: judging and rendering come after.
struct Poured {
  Scene scene;
  std::vector<PartModelPtr> parts;
  double scene_s = 0.0;  ///< wall seconds; models are cached on disk after the first time
  double cpu_s = 0.0;    ///< of all threads, in that time: what a busy machine falsifies less
};
Poured pour_timed(const Request& request);
/// The same with a solver that no request can name.
using MakeSolver = std::function<std::unique_ptr<Solver>(const std::vector<PartModelPtr>& parts)>;
Poured pour_timed(const Request& request, const MakeSolver& make);
/// Models of the request's part lines.
std::vector<PartModelPtr> load_parts(const Request& request);

/// Pairs of equal parts at these poses whose surfaces are closer than two thousandths of a diagonal.
std::vector<std::pair<std::uint32_t, std::uint32_t>> touching_pairs(const PartModel& part,
                                                                    const std::vector<Pose>& poses);

/// Makes what the request needs of its parts, so that it is in the cache when a scene is timed.
void warm_up(const Request& request);

/// Scene time, errors on the true mesh as a share of the part's diagonal, rest, stage times.
Row figures_of(const Poured& poured);

/// One row of several with the same columns: measures keep all samples, exact numbers are added up, the rest is the
/// first row's.
Row joined(const std::vector<Row>& samples);

/// The row of `seeds` scenes (request.seed, request.seed + 1, ...), each in a process of its own, with its peak memory
/// as one more measure. The first failure becomes the status.
Row over_seeds(Request request, int seeds, double limit_cpu_s);

}  // namespace bin_scenes::bench
