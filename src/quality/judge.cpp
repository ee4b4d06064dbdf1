#include "bin_scenes/quality/quality.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace bin_scenes {

namespace {

/// Overlap below this share of the smaller diagonal is the rounding of float32 files, not overlap.
constexpr double noise = 1e-6;

struct Placed {
  const ScenePart* part;
  const MeshQuery* query;
  double diagonal;
  Aabb box;  ///< bin frame
};

std::vector<Placed> placed_parts(const Scene& scene, const std::vector<PartModelPtr>& models) {
  std::vector<Placed> placed;
  for (const ScenePart& part : scene.parts) {
    if (part.state == PartState::not_poured || !part.pose.finite()) continue;
    const PartModel& model = *models[part.line];
    Placed p{&part, &model.query(), model.diagonal(), {}};
    for (const Vec3& v : model.mesh().vertices) p.box.extend(part.pose * v);
    placed.push_back(p);
  }
  return placed;
}

/// Pairs with overlapping bounds: sweep along x.
template <class Visit>
void for_each_near_pair(const std::vector<Placed>& placed, Visit&& visit) {
  std::vector<std::size_t> order(placed.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    const double x = placed[i].box.lower.x(), y = placed[j].box.lower.x();
    return x != y ? x < y : i < j;
  });
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t s = 0; s < order.size(); ++s) {
    const Placed& one = placed[order[s]];
    for (std::size_t t = s + 1; t < order.size() && placed[order[t]].box.lower.x() <= one.box.upper.x(); ++t) {
      if (one.box.overlaps(placed[order[t]].box)) pairs.push_back(std::minmax(order[s], order[t]));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [i, j] : pairs) visit(i, j);
}

/// How far a part can move along `down` before it meets floor or walls of an analytic bin.
double free_way_to_bin(const Mesh& part, const Pose& pose, const Bin& bin, const Vec3& down, double limit) {
  double best = limit;
  const auto plane = [&](const Vec3& x, const Vec3& inwards, double height) {
    const double slope = -inwards.dot(down);
    if (slope > 1e-9 && height >= 0.0 && height / slope < best &&
        (bin.kind != Bin::Kind::box || inwards.z() > 0.0 || (x + height / slope * down).z() < bin.inner_size.z())) {
      best = height / slope;
    }
  };
  for (const Vec3& vertex : part.vertices) {
    const Vec3 x = pose * vertex;
    plane(x, Vec3::UnitZ(), std::max(0.0, x.z()));
    if (bin.kind != Bin::Kind::box) continue;
    for (int axis = 0; axis < 2; ++axis) {
      plane(x, Vec3::Unit(axis), x[axis] + 0.5 * bin.inner_size[axis]);
      plane(x, -Vec3::Unit(axis), 0.5 * bin.inner_size[axis] - x[axis]);
    }
  }
  return best;
}

std::string percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100.0 * fraction);
  return text;
}

std::string listed(const std::vector<int>& ids) {
  std::string text = ids.size() == 1 ? "part " : "parts ";
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (i) text += i + 1 == ids.size() ? " and " : ", ";
    text += std::to_string(ids[i]);
  }
  return text;
}

}  // namespace

void judge(Scene& scene, const Request& request, const std::vector<PartModelPtr>& parts,
           const PartModelPtr& bin_model) {
  Report& report = scene.report;
  report.penetration = {};
  report.gap = {};
  report.reasons.clear();
  const std::vector<Placed> placed = placed_parts(scene, parts);
  std::vector<bool> held(placed.size(), false);  // overlaps something, so nothing to fall through

  // Overlap of pairs.
  std::vector<double> depths, relative;
  std::array<int, 2> worst_pair = {-1, -1};
  for_each_near_pair(placed, [&](std::size_t i, std::size_t j) {
    const Placed &a = placed[i], &b = placed[j];
    if (a.part->state == PartState::fixed && b.part->state == PartState::fixed) return;
    const Penetration found = penetration(*a.query, a.part->pose, *b.query, b.part->pose);
    const double unit = std::min(a.diagonal, b.diagonal);
    if (found.depth <= noise * unit) return;
    held[i] = held[j] = true;
    if (depths.empty() || found.depth > *std::max_element(depths.begin(), depths.end())) {
      report.penetration.pair = {a.part->id, b.part->id};
    }
    if (relative.empty() || found.depth / unit > *std::max_element(relative.begin(), relative.end())) {
      worst_pair = {a.part->id, b.part->id};
    }
    depths.push_back(found.depth);
    relative.push_back(found.depth / unit);
  });
  static_cast<Quantiles&>(report.penetration) = quantiles(depths);
  const Quantiles shares = quantiles(relative);
  report.penetration.p95_relative = shares.p95;
  report.penetration.max_relative = shares.max;
  report.penetration.pairs = depths.size();

  // Overlap with the bin.
  const MeshQuery* bin_mesh = bin_model ? &bin_model->query() : nullptr;
  double worst_bin = 0.0;
  int worst_bin_part = -1;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const ScenePart& part = *placed[i].part;
    if (part.state == PartState::fixed || part.state == PartState::escaped) continue;
    const double depth = bin_penetration(*placed[i].query, part.pose, request.bin, bin_mesh).depth;
    if (depth > noise * placed[i].diagonal) held[i] = true;
    if (depth > report.penetration.bin_max) {
      report.penetration.bin_max = depth;
      report.penetration.bin_part = part.id;
    }
    if (depth / placed[i].diagonal > worst_bin) {
      worst_bin = depth / placed[i].diagonal;
      worst_bin_part = part.id;
    }
  }

  // Free way down of every resting part.
  if (request.gravity.norm() > 0.0) {
    const Vec3 down = request.gravity.normalized();
    std::vector<double> ways;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      const Placed& a = placed[i];
      if (a.part->state != PartState::resting) continue;
      double way = 0.0;
      if (!held[i]) {
        double limit = std::numeric_limits<double>::infinity();
        if (request.bin.kind == Bin::Kind::mesh && bin_mesh) {
          limit = free_way(*a.query, a.part->pose, *bin_mesh, request.bin.pose, down, limit);
        } else if (request.bin.kind != Bin::Kind::none) {
          limit = free_way_to_bin(a.query->mesh(), a.part->pose, request.bin, down, limit);
        }
        way = limit;
        for (std::size_t j = 0; j < placed.size(); ++j) {
          if (j != i) way = free_way(*a.query, a.part->pose, *placed[j].query, placed[j].part->pose, down, way);
        }
      }
      if (std::isfinite(way)) ways.push_back(way);
    }
    report.gap = quantiles(ways);
  }

  // Verdict.
  if (shares.max > request.accept.penetration) {
    report.reasons.push_back("penetration " + percent(shares.max) + " of part " + std::to_string(worst_pair[0]) +
                             " and " + std::to_string(worst_pair[1]) + " is above accept.penetration " +
                             percent(request.accept.penetration));
  }
  if (worst_bin > request.accept.penetration) {
    report.reasons.push_back("penetration " + percent(worst_bin) + " of part " + std::to_string(worst_bin_part) +
                             " and the bin is above accept.penetration " + percent(request.accept.penetration));
  }
  const auto is_in = [](const ScenePart& p) { return p.state != PartState::not_poured && p.state != PartState::fixed; };
  if (!report.not_poured.empty() && std::none_of(scene.parts.begin(), scene.parts.end(), is_in)) {
    report.reasons.push_back("nothing was poured: no part found room below the rim");
  }
  if (!report.escaped.empty() && !request.accept.escaped) report.reasons.push_back(listed(report.escaped) + " escaped");
  if (!report.at_rest && !request.seconds) {
    const auto moving = std::count_if(scene.parts.begin(), scene.parts.end(),
                                      [](const ScenePart& p) { return p.state == PartState::moving; });
    char time[32];
    std::snprintf(time, sizeof time, "%.3g", report.simulated_s);
    report.reasons.push_back("not at rest after " + std::string(time) + " s: " + std::to_string(moving) +
                             (moving == 1 ? " part moving" : " parts moving"));
  }
  report.accepted = report.reasons.empty();
}

DriftReport drift(const Scene& before, const Scene& after, const std::vector<PartModelPtr>& parts) {
  DriftReport report;
  std::vector<double> moves, turns;
  for (const ScenePart& start : before.parts) {
    if (start.state == PartState::fixed || start.state == PartState::not_poured || !start.pose.finite()) continue;
    const auto end =
        std::find_if(after.parts.begin(), after.parts.end(), [&](const ScenePart& p) { return p.id == start.id; });
    if (end == after.parts.end() || !end->pose.finite()) continue;
    const Vec3& center = parts[start.line]->mass().center;
    moves.push_back((end->pose * center - start.pose * center).norm());
    turns.push_back(start.pose.orientation.angularDistance(end->pose.orientation));
  }
  static_cast<Quantiles&>(report) = quantiles(moves);
  report.turn_p95 = quantiles(turns).p95;
  report.measured = !moves.empty();
  return report;
}

}  // namespace bin_scenes
