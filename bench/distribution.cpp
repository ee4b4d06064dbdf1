/// Is the pile the right pile? Piles are chaotic, so single scenes are never compared: over many seeds, heights,
/// up-axes, packing and contacts are held against a reference with much finer settings, beside the distance that two
/// halves of the reference have from each other.
#include "bin_scenes/core/random.hpp"
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "framework/statistics.hpp"
#include "quality/clearance.hpp"
#include "runs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>

namespace bin_scenes::bench {
namespace {

constexpr int gpu_seeds = 20;  ///< a scene takes long where llvmpipe is the device

/// Parts whose piles are compared, and seeds; a reference has twice as many.
constexpr std::pair<const char*, int> piles[] = {{"channel_u", 200}, {"bolt_hex", 60}, {"nut_hex", 60}};

constexpr const char* height = "height of centre / diagonal";
constexpr const char* axis = "|z| of the axis of largest inertia";
constexpr const char* packing = "packing fraction";
constexpr const char* contacts = "contacts of a part";
/// What one scene says, by measure: values over its parts (packing: one value).
using Sample = std::map<std::string, std::vector<double>>;

std::string text_of(const std::vector<double>& values) {
  std::ostringstream out;
  for (const double v : values) out << v << ' ';
  return out.str();
}
std::vector<double> values_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<double>(in), {}};
}

/// Counts, for each part, the parts whose surface is closer than two thousandths of a diagonal.
std::vector<double> contacts_of(const PartModel& part, const std::vector<Pose>& poses) {
  const double limit = 2e-3 * part.diagonal();
  std::vector<double> counts(poses.size(), 0.0);
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3 apart = poses[i] * part.mass().center - poses[k] * part.mass().center;
      if (apart.norm() <= 2.0 * part.radius() + limit &&
          test::clearance(part.query(), poses[i], part.query(), poses[k], 2.0 * limit) <= limit)
        ++counts[i], ++counts[k];
    }
  return counts;
}

Sample sample_of(const Poured& poured) {
  const PartModel& part = *poured.loaded.parts.front();
  Sample sample;
  std::vector<Pose> poses;
  double mean_height = 0.0;
  for (const ScenePart& p : poured.scene.parts) {
    const Vec3 center = p.pose * part.mass().center;
    poses.push_back(p.pose);
    sample[height].push_back(center.z() / part.diagonal());
    sample[axis].push_back(std::abs((p.pose.orientation * part.mass().principal_axes * Vec3::UnitZ()).z()));
    mean_height += center.z() / static_cast<double>(poured.scene.parts.size());
  }
  const Vec3& size = poured.loaded.request.bin.inner_size;
  const double solid = part.mass().volume * static_cast<double>(poses.size());
  sample[packing] = {solid / (size.x() * size.y() * 2.0 * mean_height)};  // an even heap is twice as high as its mean
  sample[contacts] = contacts_of(part, poses);
  return sample;
}

std::vector<Sample> poured_over(Request request, int seeds, double limit_cpu_s, Row& status) {
  std::vector<Sample> all;
  warm_up(request);
  for (int k = 0; k < seeds; ++k, ++request.seed) {
    const auto poured = [&] {
      Row row;
      for (const auto& [measure, values] : sample_of(pour_timed(request))) row.info(measure, text_of(values));
      return row;
    };
    const Isolated one = isolated(poured, limit_cpu_s);
    if (!one.good) {
      status = one.row;
      return {};
    }
    all.emplace_back();
    for (const auto& [column, text] : one.row.cells()) all.back()[column.name] = values_of(text);
  }
  return all;
}

/// Of at most `count` scenes from the one at `first` on.
std::vector<double> pooled(const std::vector<Sample>& scenes, std::size_t first, std::size_t count,
                           const std::string& measure) {
  std::vector<double> values;
  for (std::size_t i = first; i < std::min(first + count, scenes.size()); ++i) {
    const std::vector<double>& more = scenes[i].at(measure);
    values.insert(values.end(), more.begin(), more.end());
  }
  return values;
}

std::vector<Sample> shuffled(std::vector<Sample> scenes, Random& random) {
  for (std::size_t i = scenes.size(); i > 1; --i) std::swap(scenes[i - 1], scenes[random.below(i)]);
  return scenes;
}

/// Distances from a random half of the reference: of at most as many candidate scenes, or (without candidates) of
/// `count` scenes of the other half. With equal counts sampling noise is the same in both.
std::vector<double> distances(const std::vector<Sample>& reference, const std::vector<Sample>& candidates,
                              const std::string& measure, std::size_t count) {
  constexpr int splits = 40;
  const std::size_t half = reference.size() / 2;
  std::vector<double> out;
  Random random(1, 0, Stream::probe);
  for (int k = 0; k < splits; ++k) {
    const std::vector<Sample> mixed = shuffled(reference, random);
    out.push_back(wasserstein(pooled(mixed, 0, half, measure),
                              candidates.empty()
                                  ? pooled(mixed, half, count, measure)
                                  : pooled(shuffled(candidates, random), 0, std::min(half, count), measure)));
  }
  return out;
}

Request request_for(const std::string& name, const std::string& part, std::size_t count, bool quick) {
  Request request = bin_of(part, count);
  choose_solver(request, name == "bullet" || name == "sphere/gpu" ? name : "sphere");
  SphereSettings& s = request.solver.sphere;
  if (name == "sphere fine" && !quick) {
    s.time_step *= 0.5;
    s.sub_steps *= 2;
    s.fine_samples *= 3;
    s.coarse_samples = s.fine_samples;
    s.field_cell *= 0.5;
  }
  if (name == "sphere coarse") s.time_step *= 4.0;
  if (name == "sphere coarser") s.time_step *= 8.0;
  return request;
}

/// How far the candidates' values lie from the reference's, beside how far its own halves lie from each other. Without
/// candidates the reference stands for them.
Row measure_row(const std::vector<Sample>& reference, const std::vector<Sample>& candidates, const char* measure) {
  const std::vector<Sample>& scenes = candidates.empty() ? reference : candidates;
  const std::vector<double> own = distances(reference, {}, measure, scenes.size());
  const std::vector<double> values = pooled(scenes, 0, scenes.size(), measure);
  const std::vector<double> distance = distances(reference, candidates, measure, scenes.size());
  return Row()
      .exact("seeds", scenes.size())
      .info("mean", std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()))
      .info("p05", quantile(values, 0.05))
      .info("p95", quantile(values, 0.95))
      .measure("wasserstein", distance)
      .info("reference_to_itself_median", median(own))
      .info("reference_to_itself_p95", quantile(own, 0.95))
      .info("within_reference_noise", median(distance) <= quantile(own, 0.95));
}

void tell(Run& out, const std::string& part, int seeds) {
  const std::size_t count = out.quick() ? 8 : 32;
  const double limit_cpu_s = out.quick() ? 30.0 : 120.0;
  const std::string names[] = {"sphere fine", "sphere", "sphere/gpu", "sphere coarse", "sphere coarser", "bullet"};
  const auto wanted = [&](const std::string& name) { return out.wanted(Row::keys("part", part, "solver", name)); };
  if (std::none_of(std::begin(names), std::end(names), wanted)) return;  // the reference takes longest
  Row failed;
  Request reference_request = request_for("sphere fine", part, count, out.quick());
  reference_request.seed = 1001;  // other seeds than the candidates'
  const std::vector<Sample> reference = poured_over(reference_request, 2 * seeds, limit_cpu_s, failed);
  for (const std::string& name : names) {
    if (!wanted(name)) continue;
    const bool itself = name == "sphere fine";
    std::vector<Sample> candidates;
    if (!itself && !reference.empty())
      candidates = poured_over(request_for(name, part, count, out.quick()),
                               name == "sphere/gpu" ? std::min(seeds, gpu_seeds) : seeds, limit_cpu_s, failed);
    for (const char* measure : {height, axis, packing, contacts}) {
      const Row key = Row::keys("part", part, "bodies", count, "solver", name, "measure", measure);
      const bool poured = !reference.empty() && (itself || !candidates.empty());
      out.row(Row(key).append(poured ? measure_row(reference, candidates, measure) : failed));
    }
  }
}

/// Over 20 seeds chance moves mean heights by 2 to 4 %, over 80 by 2 %.
void run(Run& out) {
  if (out.quick()) return tell(out, piles[0].first, 2);
  for (const auto& [part, seeds] : piles) tell(out, part, seeds);
}

const Registration registration{
    "distribution", "are the piles right: heights, axes, packing, contacts", {"part", "solver"}, run};

}  // namespace
}  // namespace bin_scenes::bench
