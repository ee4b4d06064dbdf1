/// A heap emptied part by part, as a robot does: always the highest one. What each pick costs as a share of the pour,
/// how many other parts it moves, and whether each state is accepted.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include "bin_scenes/pour/heap.hpp"
#include "bin_scenes/quality/quality.hpp"

#include <algorithm>

namespace bin_scenes::bench {
namespace {

struct Depletion {
  const char* part;
  std::size_t count, picks;
};
constexpr Depletion depletions[] = {{"channel_u", 60, 60}, {"bolt_hex", 60, 60}, {"channel_u", 256, 20}};

int highest(const Scene& scene) {
  const ScenePart* top = nullptr;
  for (const ScenePart& part : scene.parts)
    if (part.pose.finite() && (!top || part.pose.position.z() > top->pose.position.z())) top = &part;
  return top->id;
}

std::size_t moved(const Scene& before, const Scene& after) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < before.parts.size(); ++i) {
    const Pose &a = before.parts[i].pose, &b = after.parts[i].pose;
    count += b.finite() && (a.position != b.position || a.orientation.coeffs() != b.orientation.coeffs());
  }
  return count;
}

Row emptied(const Request& request, std::size_t picks) {
  const std::vector<PartModelPtr> parts = load_parts(request);
  std::string reason;
  Heap heap({request, parts}, make_solver(request, parts, reason));
  const auto settled = [&] {
    const Clock clock;
    heap.settle();
    return clock.cpu_s();
  };
  const double pour_cpu = settled();
  Scene scene = heap.scene();
  std::vector<double> shares, seconds, others, depths;
  std::size_t accepted = 0, at_rest = 0;
  for (std::size_t pick = 0; pick < picks; ++pick) {
    heap.remove({highest(scene)});
    shares.push_back(settled() / pour_cpu);
    Scene after = heap.scene();
    judge(after, heap.loaded());
    seconds.push_back(after.report.simulated_s);
    others.push_back(static_cast<double>(moved(scene, after)));
    depths.push_back(after.report.penetration.max_relative);
    accepted += after.report.accepted;
    at_rest += after.report.at_rest;
    scene = std::move(after);
  }
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  const auto largest = [](const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
  };
  const auto left =
      std::count_if(scene.parts.begin(), scene.parts.end(), [](const ScenePart& part) { return is_there(part.state); });
  return Row()
      .exact("picks", picks)
      .exact("left", left)
      .exact("at_rest", at_rest)
      .exact("accepted", accepted)
      .measure("pour_cpu_s", pour_cpu)
      .measure("pick_share_mean", mean(shares))
      .measure("pick_share_max", largest(shares))
      .measure("pick_simulated_s_mean", mean(seconds))
      .measure("others_moved_mean", mean(others))
      .measure("others_moved_max", largest(others))
      .measure("penetration_max_rel", largest(depths));
}

void run(Run& out) {
  for (const Depletion& depletion : depletions)
    for (const std::string solver : {"sphere", "bullet"}) {
      const std::size_t count = out.quick() ? 4 : depletion.count, picks = out.quick() ? 4 : depletion.picks;
      const Row key = Row().key("part", depletion.part).key("bodies", count).key("solver", solver);
      if (!out.wanted(key)) continue;
      Request request = bin_of(depletion.part, count);
      choose_solver(request, solver);
      warm_up(request);
      out.row(Row(key).append(isolated([&] { return emptied(request, picks); }).row));
      if (out.quick()) return;
    }
}

const Registration registration{
    "depletion", "a heap emptied part by part: the cost of a pick", {"part", "bodies", "solver"}, run};

}  // namespace
}  // namespace bin_scenes::bench
