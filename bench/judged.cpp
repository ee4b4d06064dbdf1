#include "judged.hpp"

#include "bin_scenes/output/scene_writer.hpp"
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "framework/statistics.hpp"
#include "referee.hpp"

namespace bin_scenes::bench {

namespace {

constexpr double millimetre = 1e-3;  ///< unit of pieces

Row drift_row(const std::string& path, const Request& request, const std::string& pieces) {
  const std::vector<PartModelPtr> parts = load_parts(request);
  const Scene scene = read_scene_json(path);
  const Drift drift = referee_drift(scene, request, parts, {read_pieces(pieces, millimetre)});
  return Row()
      .measure("drift_median_rel", median(drift.moved))
      .measure("drift_p95_rel", quantile(drift.moved, 0.95))
      .measure("drift_max_rel", quantile(drift.moved, 1.0))
      .measure("turn_p95_deg", quantile(drift.turned, 0.95));
}

}  // namespace

Row judged_scene(const std::string& scratch, const Request& request, const std::string& pieces,
                 const std::optional<PeerSettings>& peer, const Judged& how) {
  const std::string path = scratch + "/scene.json";
  const auto pour = [&] {
    if (!peer) return pour_timed(request);
    PeerSettings settings = *peer;
    settings.pieces = {read_pieces(pieces, millimetre)};
    return pour_timed(request, [&](const std::vector<PartModelPtr>&) { return make_peer(settings); });
  };
  Isolated poured = isolated(
      [&] {
        const Poured result = pour();
        write_text(path, scene_json(result.scene, request));
        return figures_of(result);
      },
      how.limit_cpu_s);
  if (!poured.good || !how.referee) return poured.row;
  return poured.row.append(isolated([&] { return drift_row(path, request, pieces); }, 600.0).row);
}

}  // namespace bin_scenes::bench
