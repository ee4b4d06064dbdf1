/// The tables of J. Edhammer, "Rigid Body Physics for Synthetic Data Generation" (LiTH-ISY-EX--16/4958--SE, 2016),
/// again: time per step by stage beside the published figures (GTX 960, ms). Quick forms are an eighth of the size and
/// have nothing to stand beside. Its teapots: config/thesis_teapots.yaml.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include "bin_scenes/core/random.hpp"
#include "solver/thesis/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace bin_scenes::bench {
namespace {

using thesis::test::WorldBuilder;

constexpr double limit_s = 1800.0;
const std::vector<std::string> stages = {"move", "grid", "detect", "impulse", "velocity", "position"};

/// The thesis's stages from the solver's passes.
std::string stage_of(const std::string& pass) {
  if (pass == "force" || pass == "move_to_world") return "move";
  if (pass == "count_cells" || pass == "prefix_sum" || pass == "scatter" || pass == "reorder") return "grid";
  if (pass == "detect" || pass == "count_pairs" || pass == "split_mass") return "detect";
  if (pass == "pre_velocity" || pass == "velocity") return "velocity";
  return pass;
}

/// Device time per step by stage, of those that the solver has, and the wall time they were part of.
Row times(const Profile& profile, double steps, double wall_ms) {
  std::map<std::string, double> sums;
  double total = 0.0;
  for (const auto& [pass, ms] : profile.stages_ms) {
    sums[stage_of(pass)] += ms / steps;
    total += ms / steps;
  }
  Row row;
  for (const std::string& stage : stages)
    if (const auto found = sums.find(stage); found != sums.end()) row.measure(stage + "_ms", found->second);
  return row.measure("total_ms", total).measure("wall_ms", wall_ms / steps).exact("steps", steps);
}

/// Bodies that are no longer above the bin's floor.
std::size_t outside(const std::vector<BodyState>& states, const Vec3& inner_size) {
  return static_cast<std::size_t>(std::count_if(states.begin(), states.end(), [&](const BodyState& s) {
    const Vec3& p = s.pose.position;
    return !(std::abs(p.x()) <= 0.5 * inner_size.x() && std::abs(p.y()) <= 0.5 * inner_size.y() && p.z() >= 0.0);
  }));
}

/// Published figures: stages in their order, then the total, or the total alone.
Row published(const std::vector<double>& ms) {
  Row row;
  for (std::size_t i = 0; i + 1 < ms.size(); ++i) row.info("published_" + stages[i] + "_ms", ms[i]);
  if (!ms.empty()) row.info("published_total_ms", ms.back());
  return row;
}

/// n^3 spheres, those inside too: the thesis's counts are 27, 125, 343.
std::vector<Sphere> full_cube(int n, double radius) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < n * n * n; ++i)
    spheres.push_back(
        {(Vec3(i % n, i / n % n, i / n / n) - Vec3::Constant(0.5 * (n - 1))) * 2.0 * radius, radius, Vec3::Zero()});
  return spheres;
}

/// Open box of stored spheres `width` wide and `height` high inside, in sphere diameters.
std::vector<Sphere> stored_bin(int width, int height, double radius) {
  std::vector<Sphere> spheres;
  const auto add = [&](int x, int y, int z) {
    spheres.push_back(
        {Vec3(x - 0.5 * (width - 1), y - 0.5 * (width - 1), z + 0.5) * 2.0 * radius, radius, Vec3::Zero()});
  };
  for (int x = 0; x < width; ++x)
    for (int y = 0; y < width; ++y) add(x, y, -1);
  for (int z = 0; z < height; ++z)
    for (int i = 0; i < width; ++i) {
      add(i, -1, z);
      add(i, width, z);
      add(-1, i, z);
      add(width, i, z);
    }
  return spheres;
}

struct Cubes {
  std::size_t bodies = 1024;
  int edge = 3;                 ///< spheres
  int width = 48, height = 20;  ///< of the bin, sphere diameters
  bool stored = true;           ///< static spheres in the grid, as in the thesis; else sheets worked out on demand
  double gap = 1.067;           ///< pitch of the cubes at the start / their edge
  double radius = 0.005;        ///< of all spheres, m
};

/// Cubes in layers just above the floor, each turned a little.
WorldBuilder cubes_in_bin(const Cubes& cubes, const std::vector<Sphere>& spheres) {
  WorldBuilder world;
  const double edge = 2.0 * cubes.radius * cubes.edge * cubes.gap;
  const int columns = std::max(1, static_cast<int>(cubes.width * 2.0 * cubes.radius / edge + 1e-9));
  world.def.bin.inner_size = Vec3(cubes.width, cubes.width, cubes.height) * 2.0 * cubes.radius;
  world.def.wall_height = 4000.0 * cubes.radius;
  if (cubes.stored) world.def.bin.kind = Bin::Kind::none;
  const std::size_t shape = world.shape(spheres);
  Random random(1, 0, Stream::probe);
  for (std::size_t b = 0; b < cubes.bodies; ++b) {
    const int i = static_cast<int>(b) % (columns * columns), layer = static_cast<int>(b) / (columns * columns);
    world.body(shape, edge * Vec3(i % columns - 0.5 * (columns - 1), i / columns - 0.5 * (columns - 1), layer + 0.51),
               Vec3::Zero(), 0.1);
    world.starts.back().pose.orientation =
        Quat(Eigen::AngleAxisd(random.uniform(-0.04, 0.04), random.orientation() * Vec3::UnitX()));
  }
  return world;
}

/// `steps` steps of the cubes, from their fall on.
Row timed(const Cubes& cubes, int steps) {
  const ThesisSettings settings;
  const WorldBuilder builder = cubes_in_bin(cubes, full_cube(cubes.edge, cubes.radius));
  thesis::World world = thesis::make_world(builder.def, builder.shapes, settings);
  if (cubes.stored) world.bin_spheres = stored_bin(cubes.width, cubes.height, cubes.radius);
  const std::size_t fixed = world.bin_spheres.size();
  ThesisSolver solver(settings);
  const WorldId id = solver.add_world(std::move(world));
  for (std::size_t b = 0; b < builder.starts.size(); ++b) solver.insert(id, b, builder.starts[b]);
  const Clock clock;
  solver.advance({id}, steps * settings.time_step);
  return Row()
      .exact("spheres", cubes.bodies * static_cast<std::size_t>(cubes.edge * cubes.edge * cubes.edge) + fixed)
      .exact("static_spheres", fixed)
      .exact("escaped", outside(solver.states(id), builder.def.bin.inner_size))
      .append(times(solver.profile(), steps, 1e3 * clock.wall_s()));
}

void step_tables(Run& out) {
  const bool quick = out.quick();
  const auto row = [&](const std::string& table, const std::string& setting, Cubes cubes,
                       const std::vector<double>& ms) {
    Row row = Row::keys("table", table, "setting", setting);
    if (!out.wanted(row)) return;
    if (quick) cubes.bodies /= 8, cubes.width /= 2, cubes.height /= 2;
    row.exact("bodies", cubes.bodies).append(isolated([&] { return timed(cubes, quick ? 24 : 200); }, limit_s).row);
    out.row(quick ? row : row.append(published(ms)));
  };
  row("spheres_per_body", "1024 x 27", {1024, 3}, {0.174, 1.307, 1.869, 4.187, 7.413, 0.023, 14.973});
  row("spheres_per_body", "222 x 125", {222, 5}, {0.162, 1.307, 1.815, 3.749, 7.947, 0.020, 15.000});
  row("spheres_per_body", "82 x 343", {82, 7}, {0.171, 1.310, 1.928, 3.731, 9.226, 0.012, 16.377});
  const std::pair<int, double> bins[] = {{20, 6.08}, {48, 7.06}, {98, 9.87}, {115, 10.87}, {120, 11.14}, {137, 12.58}};
  for (const auto& [width, ms] : bins)
    row("static_spheres", "bin " + std::to_string(width) + " wide", {128, 3, width, width == 20 ? 15 : 20}, {ms});
  row("static_spheres", "bin 137 wide, on demand", {128, 3, 137, 20, false}, {});
}

/// A heap of 5 x 5 x 5 cubes with an edge of about `size` m, two seconds after they were let go: cubes below the floor,
/// or with their centre far inside another one.
std::size_t tunnelled(const ThesisSettings& settings, std::size_t bodies, double size) {
  ThesisSolver solver(settings);
  const int n = 5;
  const double radius = 0.1 * size, pitch = 2.0 * radius * settings.tightness, edge = (n - 1) * pitch + 2.0 * radius;
  const Cubes cubes{bodies, n, 16, 40, false, 1.5 * edge / (2.0 * radius * n), radius};
  WorldBuilder builder = cubes_in_bin(cubes, thesis::test::block(n, n, n, radius, pitch));
  Random random(2, 0, Stream::probe);
  for (BodyState& start : builder.starts)
    start.pose.orientation = Quat(Eigen::AngleAxisd(random.uniform(0.0, 0.4), random.orientation() * Vec3::UnitX()));
  const WorldId id = builder.add(solver, settings);
  solver.advance({id}, 2.0);
  const std::vector<BodyState> states = solver.states(id);
  return static_cast<std::size_t>(std::count_if(states.begin(), states.end(), [&](const BodyState& one) {
    const Vec3& at = one.pose.position;
    return !at.allFinite() || at.z() < 0.25 * edge ||
           std::any_of(states.begin(), states.end(), [&](const BodyState& other) {
             return &other != &one && (other.pose.position - at).norm() < 0.75 * edge;
           });
  }));
}

/// Cubes of the stability table, and what the thesis says of them.
struct Variant {
  const char* name;
  bool normals;
  double tightness;
  const char* published;
};
constexpr Variant variants[] = {{"plain", false, 1.0, "above 6"},
                                {"modified normals", true, 1.0, "4"},
                                {"tighter voxels", false, 0.75, "3"},
                                {"both", true, 0.75, ""}};

/// The fewest iterations at which, and at all more that are tried, no cube sinks into another one.
std::string least_iterations(const Variant& variant, std::size_t bodies, double size, const std::vector<int>& tried) {
  int least = 0;
  for (const int iterations : tried) {
    ThesisSettings settings;
    settings.iterations = iterations;
    settings.modified_normals = variant.normals;
    settings.tightness = variant.tightness;
    const Isolated one = isolated([&] { return Row().exact("tunnelled", tunnelled(settings, bodies, size)); }, limit_s);
    const bool stable = one.good && one.row.number("tunnelled") == 0.0;
    least = !stable ? 0 : least ? least : iterations;
  }
  return least ? Row::text(least) : "none tried";
}

/// The thesis counted iterations until its cubes no longer sank into each other. It gives no size. Gravity takes small
/// cubes further in a step, against their size, so size decides as much.
void stability_table(Run& out) {
  const std::vector<int> all = {1, 2, 3, 4, 5, 6, 8, 10, 20, 40}, few = {1, 3, 6, 10};
  const std::size_t bodies = out.quick() ? 12 : 64;
  for (const double size : {1.0, 0.05}) {  // m
    for (const Variant& variant : variants) {
      const Row key = Row::keys("table", "stability", "setting", variant.name, "cube_m", size);
      if (!out.wanted(key)) continue;
      out.row(Row(key)
                  .exact("bodies", bodies)
                  .exact("least_iterations", least_iterations(variant, bodies, size, out.quick() ? few : all))
                  .info("published_least", variant.published));
    }
    if (out.quick()) return;
  }
}

void run(Run& out) {
  step_tables(out);
  stability_table(out);
}

const Registration registration{
    "thesis_tables", "the thesis's tables beside its figures", {"table", "setting", "cube_m"}, run};

}  // namespace
}  // namespace bin_scenes::bench
