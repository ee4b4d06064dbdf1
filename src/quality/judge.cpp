/// Finds pairs whose boxes meet, measures overlap, bin and gap in parallel, and holds the worst against the request's
/// limits. Every figure comes with the parts that it is of.
#include "core/in_parallel.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "core/formatted.hpp"
#include "gap.hpp"

#include <algorithm>
#include <numeric>

namespace bin_scenes {

namespace {

/// Overlap below this share of the smaller diagonal is the rounding of float32 files, not overlap.
constexpr double noise = 1e-6;

std::vector<Placed> placed_parts(const Scene& scene, const std::vector<PartModelPtr>& models) {
  std::vector<Placed> placed;
  for (const ScenePart& part : scene.parts) {
    if (!is_there(part.state) || !part.pose.finite()) continue;
    BIN_SCENES_ASSERT(part.line < models.size() && is_unit(part.pose.orientation));
    const PartModel& model = *models[part.line];
    Placed p{&part, &model.query(), model.diagonal(), {}};
    for (const Vec3& v : model.corners()) p.box.extend(part.pose * v);
    placed.push_back(p);
  }
  return placed;
}

/// Clear of floor and walls of a box, so that no vertex need be looked at.
bool inside_walls(const Aabb& box, const Bin& bin) {
  if (bin.kind != Bin::Kind::box || box.lower.z() < 0.0) return false;
  const Vec3 half = 0.5 * bin.inner_size;
  return (box.lower + half).head<2>().minCoeff() >= 0.0 && (half - box.upper).head<2>().minCoeff() >= 0.0;
}

/// Pairs with overlapping bounds, of which one can move: sweep along x.
std::vector<Overlapping> near_pairs(const std::vector<Placed>& placed) {
  std::vector<std::size_t> order(placed.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    const double x = placed[i].box.lower.x(), y = placed[j].box.lower.x();
    return x != y ? x < y : i < j;
  });
  const auto fixed = [&](std::size_t i) { return placed[i].part->state == PartState::fixed; };
  std::vector<Overlapping> pairs;
  for (std::size_t s = 0; s < order.size(); ++s) {
    stop_if_cancelled();
    const Placed& one = placed[order[s]];
    for (std::size_t t = s + 1; t < order.size() && placed[order[t]].box.lower.x() <= one.box.upper.x(); ++t) {
      if (!one.box.overlaps(placed[order[t]].box) || (fixed(order[s]) && fixed(order[t]))) continue;
      const auto [a, b] = std::minmax(order[s], order[t]);
      pairs.push_back({a, b, {}});
    }
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const Overlapping& p, const Overlapping& q) { return std::pair(p.a, p.b) < std::pair(q.a, q.b); });
  BIN_SCENES_ASSERT(each_is(pairs, [&](const Overlapping& p) { return p.a < p.b && p.b < placed.size(); }));
  return pairs;
}

/// Pairs that overlap, however little.
std::vector<Overlapping> overlapping_pairs(const std::vector<Placed>& placed) {
  std::vector<Overlapping> pairs = near_pairs(placed);
  in_parallel(pairs.size(), [&](std::size_t i) {
    const Placed &a = placed[pairs[i].a], &b = placed[pairs[i].b];
    pairs[i].found = penetration(*a.query, a.part->pose, *b.query, b.part->pose);
    BIN_SCENES_ASSERT(pairs[i].found.depth >= 0.0);
  });
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), [](const Overlapping& p) { return p.found.depth <= 0.0; }),
              pairs.end());
  return pairs;
}

std::vector<double> depths_in_bin(const std::vector<Placed>& placed, const Bin& bin, const MeshQuery* bin_mesh) {
  std::vector<double> depths(placed.size(), 0.0);
  in_parallel(placed.size(), [&](std::size_t i) {
    const ScenePart& part = *placed[i].part;
    if (part.state == PartState::fixed || part.state == PartState::escaped) return;
    if (inside_walls(placed[i].box, bin)) return;
    depths[i] = bin_penetration(*placed[i].query, part.pose, bin, bin_mesh).depth;
  });
  return depths;
}

/// The largest of some figures, and of what it is; the first of equal ones.
template <class What>
struct Worst {
  double value = 0.0;
  What what{};

  void add(double figure, const What& of) {
    if (figure > value) value = figure, what = of;
  }
};

std::string percent(double fraction) {
  return formatted("%.2g %%", 100.0 * fraction);
}

/// The first ten by name.
std::string listed(const std::vector<int>& ids) {
  constexpr std::size_t most = 10;
  std::string text = ids.size() == 1 ? "part " : "parts ";
  for (std::size_t i = 0; i < std::min(most, ids.size()); ++i) {
    if (i) text += i + 1 == ids.size() ? " and " : ", ";
    text += std::to_string(ids[i]);
  }
  if (ids.size() > most) text += " and " + std::to_string(ids.size() - most) + " more";
  return text;
}

using WorstPair = Worst<std::array<int, 2>>;

/// Fills in the overlap of pairs. Returns the worst pair by its share of the smaller diagonal.
WorstPair measure_pairs(PenetrationReport& report, const std::vector<Placed>& placed,
                        const std::vector<Overlapping>& overlaps) {
  std::vector<double> depths, relative;
  WorstPair deepest{0.0, {-1, -1}}, worst;
  for (const Overlapping& pair : overlaps) {
    const Placed &a = placed[pair.a], &b = placed[pair.b];
    const double depth = pair.found.depth, unit = std::min(a.diagonal, b.diagonal);
    if (depth <= noise * unit) continue;
    deepest.add(depth, {a.part->id, b.part->id});
    worst.add(depth / unit, {a.part->id, b.part->id});
    depths.push_back(depth);
    relative.push_back(depth / unit);
  }
  static_cast<Quantiles&>(report) = quantiles(depths);
  const Quantiles shares = quantiles(relative);
  report.pair = deepest.what;
  report.p95_relative = shares.p95;
  report.max_relative = shares.max;
  report.pairs = depths.size();
  return worst;
}

/// Fills in the overlap with the bin. Returns the worst part by its share of the diagonal.
Worst<int> measure_bin(PenetrationReport& report, const std::vector<Placed>& placed, const Bin& bin,
                       const MeshQuery* bin_mesh) {
  const std::vector<double> into_bin = depths_in_bin(placed, bin, bin_mesh);
  std::vector<double> depths;
  Worst<int> deepest{0.0, -1}, worst;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    deepest.add(into_bin[i], placed[i].part->id);
    worst.add(into_bin[i] / placed[i].diagonal, placed[i].part->id);
    if (into_bin[i] > noise * placed[i].diagonal) depths.push_back(into_bin[i]);
  }
  const Quantiles in_bin = quantiles(depths);
  report.bin_median = in_bin.median;
  report.bin_p95 = in_bin.p95;
  report.bin_max = deepest.value;
  report.bin_part = deepest.what;
  return worst;
}

/// Fills in how far every resting part could fall. Returns the worst part by its share of the diagonal.
Worst<int> measure_gaps(Report& report, const std::vector<Placed>& placed, const std::vector<Overlapping>& overlaps,
                        const Request& request, const MeshQuery* bin_mesh) {
  Worst<int> worst;
  const std::vector<double> falls = free_falls(placed, overlaps, request, bin_mesh, Vec3(request.gravity.normalized()));
  std::vector<double> finite;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (!std::isfinite(falls[i])) continue;
    finite.push_back(falls[i]);
    worst.add(falls[i] / placed[i].diagonal, placed[i].part->id);
  }
  report.gap = quantiles(finite);
  return worst;
}

/// Why contacts are not to be trusted: energy from nowhere, parts thrown out.
void add_energy_reasons(Report& report, const Acceptance& accept) {
  if (report.energy.gain > accept.energy)
    report.reasons.push_back(
        formatted("part %d gained %.3g m g d of energy from nowhere by %.3f s, which is above accept.energy %.3g",
                  report.energy.part, report.energy.gain, report.energy.time, accept.energy));
  if (const auto& thrown = report.energy.thrown; thrown.ratio > accept.speed)
    report.reasons.push_back(formatted(
        "part %d was thrown at %.3g times the speed of what was near it by %.3f s, which is above accept.speed %.3g",
        thrown.part, thrown.ratio, thrown.time, accept.speed));
}

/// A part that contacts hold by far more than anything weighs does not lie there.
void add_jam_reason(Report& report, const Acceptance& accept) {
  if (report.jam.ratio <= accept.jam) return;
  report.reasons.push_back(
      formatted("part %d is squeezed by %.3g times the weight of itself and of what lies on it, which is above "
                "accept.jam %.3g",
                report.jam.part, report.jam.ratio, accept.jam));
}

/// Why the scene is not to be trusted, although nothing of it shows at the end.
void add_worst_reasons(Report& report, const Acceptance& accept) {
  if (const auto& worst = report.worst.penetration; worst.relative > accept.worst_penetration) {
    const std::string other = worst.pair[1] < 0 ? "the bin" : std::to_string(worst.pair[1]);
    report.reasons.push_back(formatted(
        "part %d and %s overlapped by %s of d at %.3f s, which is above accept.worst_penetration %s", worst.pair[0],
        other.c_str(), percent(worst.relative).c_str(), worst.time, percent(accept.worst_penetration).c_str()));
  }
  if (const auto& gain = report.worst.energy_gain; gain.relative > accept.worst_energy_gain)
    report.reasons.push_back(
        formatted("the energy of all parts rose by %.3g m g d of those that moved by %.3f s, which is above "
                  "accept.worst_energy_gain %.3g",
                  gain.relative, gain.time, accept.worst_energy_gain));
}

/// Why the scene is not what was asked for: parts that are missing or still move.
void add_state_reasons(Scene& scene, const Request& request) {
  Report& report = scene.report;
  const auto is_in = [](const ScenePart& p) { return is_there(p.state) && p.state != PartState::fixed; };
  if (!report.not_poured.empty() && std::none_of(scene.parts.begin(), scene.parts.end(), is_in)) {
    report.reasons.push_back("nothing was poured: no part found room below the rim");
  }
  if (!report.escaped.empty() && !request.accept.escaped) report.reasons.push_back(listed(report.escaped) + " escaped");
  if (!report.unstable.empty() && !request.accept.unstable)
    report.reasons.push_back(listed(report.unstable) + " moved in each check of how they stand: unstable");
  if (report.at_rest || request.seconds) return;
  std::vector<int> moving;
  for (const ScenePart& part : scene.parts)
    if (part.state == PartState::moving) moving.push_back(part.id);
  report.reasons.push_back(formatted("not at rest after %.3g s: ", report.simulated_s) + std::to_string(moving.size()) +
                           (moving.size() == 1 ? " part moving (" : " parts moving (") + listed(moving) + ")");
}

}  // namespace

void judge(Scene& scene, const LoadedRequest& loaded) {
  const Request& request = loaded.request;
  Report& report = scene.report;
  report.penetration = {};
  report.gap = {};
  report.reasons.clear();
  std::vector<Placed> placed = placed_parts(scene, loaded.parts);
  // What escaped was taken out of the simulation where it was then: others pass through it.
  const auto gone = [](const Placed& p) { return p.part->state == PartState::escaped; };
  placed.erase(std::remove_if(placed.begin(), placed.end(), gone), placed.end());
  const std::vector<Overlapping> overlaps = overlapping_pairs(placed);
  const MeshQuery* bin_mesh = loaded.bin_model ? &loaded.bin_model->query() : nullptr;
  const WorstPair pair = measure_pairs(report.penetration, placed, overlaps);
  const Worst<int> in_bin = measure_bin(report.penetration, placed, request.bin, bin_mesh);
  const Worst<int> gap = measure_gaps(report, placed, overlaps, request, bin_mesh);

  BIN_SCENES_ASSERT(pair.value >= 0.0 && in_bin.value >= 0.0 && gap.value >= 0.0);
  const Acceptance& accept = request.accept;
  const auto too_deep = [&](double share, const std::string& of) {
    if (share <= accept.penetration) return;
    report.reasons.push_back("penetration " + percent(share) + " of part " + of + " is above accept.penetration " +
                             percent(accept.penetration));
  };
  too_deep(pair.value, std::to_string(pair.what[0]) + " and " + std::to_string(pair.what[1]));
  too_deep(in_bin.value, std::to_string(in_bin.what) + " and the bin");
  if (gap.value > accept.gap) {
    report.reasons.push_back("part " + std::to_string(gap.what) + " could fall by " + percent(gap.value) +
                             " of its size, which is above accept.gap " + percent(accept.gap));
  }
  add_energy_reasons(report, accept);
  add_worst_reasons(report, accept);
  add_jam_reason(report, accept);
  add_state_reasons(scene, request);
  report.accepted = report.reasons.empty();
}

std::vector<PartQuality> part_quality(const Scene& scene, const LoadedRequest& loaded) {
  const Request& request = loaded.request;
  const std::vector<Placed> placed = placed_parts(scene, loaded.parts);
  const std::vector<Overlapping> overlaps = overlapping_pairs(placed);
  const MeshQuery* bin_mesh = loaded.bin_model ? &loaded.bin_model->query() : nullptr;
  const std::vector<double> into_bin = depths_in_bin(placed, request.bin, bin_mesh);
  const std::vector<double> falls = free_falls(placed, overlaps, request, bin_mesh, Vec3(request.gravity.normalized()));
  BIN_SCENES_ASSERT(into_bin.size() == placed.size() && falls.size() == placed.size());
  std::vector<PartQuality> all;
  for (std::size_t i = 0; i < placed.size(); ++i) all.push_back({placed[i].part->id, 0.0, 0.0, into_bin[i], falls[i]});
  for (const Overlapping& pair : overlaps) {
    const double depth = pair.found.depth, unit = std::min(placed[pair.a].diagonal, placed[pair.b].diagonal);
    if (depth <= noise * unit) continue;
    for (PartQuality* part : {&all[pair.a], &all[pair.b]}) {
      part->overlap = std::max(part->overlap, depth);
      part->overlap_relative = std::max(part->overlap_relative, depth / unit);
    }
  }
  return all;
}

DriftReport drift(const Scene& before, const Scene& after, const std::vector<PartModelPtr>& parts) {
  DriftReport report;
  std::vector<double> moves, turns;
  for (const ScenePart& start : before.parts) {
    if (start.state == PartState::fixed || !is_there(start.state) || !start.pose.finite()) continue;
    const auto end =
        std::find_if(after.parts.begin(), after.parts.end(), [&](const ScenePart& p) { return p.id == start.id; });
    if (end == after.parts.end() || !end->pose.finite()) continue;
    BIN_SCENES_ASSERT(start.line < parts.size());
    const Vec3& center = parts[start.line]->mass().center;
    moves.push_back((end->pose * center - start.pose * center).norm());
    turns.push_back(start.pose.orientation.angularDistance(end->pose.orientation));
  }
  BIN_SCENES_ASSERT(moves.size() == turns.size());
  static_cast<Quantiles&>(report) = quantiles(moves);
  report.turn_p95 = quantiles(turns).p95;
  report.measured = !moves.empty();
  return report;
}

}  // namespace bin_scenes
