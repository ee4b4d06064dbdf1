#include "bin_scenes/bop/bop_writer.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/symmetry.hpp"
#include "page/symmetry_picture.hpp"
#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"
#include "tool/unit_option.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <string>

namespace bin_scenes {

namespace {

using Json = nlohmann::ordered_json;

constexpr double millimetres = 1e3;

LoadOptions options_of(const std::string& unit, const std::string& solid) {
  LoadOptions load;
  load.solid = solid;
  load.require_closed = false;
  load.unit = unit_given(unit);
  return load;
}

double largest(const std::vector<double>& errors) {
  return errors.empty() ? 0.0 : millimetres * *std::max_element(errors.begin(), errors.end());
}

std::vector<double> in_mm(std::vector<double> errors) {
  for (double& error : errors) error *= millimetres;
  return errors;
}

Json json_of(const PartModel& part, const SymmetryReport& report) {
  Json nearly = Json::array();
  for (const SymmetryReport::Nearly& axis : report.nearly)
    nearly.push_back({{"axis", {axis.direction.x(), axis.direction.y(), axis.direction.z()}},
                      {"order", axis.order},
                      {"residual_mm", millimetres * axis.error}});
  return {{"tolerance_mm", millimetres * report.limit},
          {"models_info", Json::parse(bop_model_info(part, report.symmetries))},
          {"residuals_continuous_mm", in_mm(report.continuous_error)},
          {"residuals_discrete_mm", in_mm(report.discrete_error)},
          {"nearly", nearly}};
}

void print(const PartModel& part, const SymmetryReport& report) {
  const Symmetries& found = report.symmetries;
  for (std::size_t i = 0; i < found.continuous.size(); ++i) {
    const Vec3& d = found.continuous[i].direction;
    std::printf("any angle about (%.4f, %.4f, %.4f): residual %.4f mm\n", d.x(), d.y(), d.z(),
                millimetres * report.continuous_error[i]);
  }
  std::printf("%zu %s, the identity among them: residual at most %.4f mm, tolerance %.4f mm\n",
              found.discrete.size() + 1, found.continuous.empty() ? "poses look alike" : "beside these",
              largest(report.discrete_error), millimetres * report.limit);
  for (const SymmetryReport::Nearly& axis : report.nearly) {
    const std::string order = axis.order == 0 ? "any angle" : "order " + std::to_string(axis.order);
    std::printf("nearly: %s about (%.4f, %.4f, %.4f), off by %.4f mm\n", order.c_str(), axis.direction.x(),
                axis.direction.y(), axis.direction.z(), millimetres * axis.error);
  }
  std::printf("models_info.json: %s\n", bop_model_info(part, found).c_str());
}

}  // namespace

int symmetries(const SymmetriesOptions& options) {
  ProgressBar bar;
  bar.stage(0.0, 0.3, "reading " + options.model);
  const PartModelPtr part = PartModel::load(options.model, options_of(options.unit, options.solid));
  if (options.tolerance_mm && !(*options.tolerance_mm > 0.0 && *options.tolerance_mm < millimetres * part->diagonal()))
    throw input_error(
        "must be above 0 and below the part's size, " + std::to_string(millimetres * part->diagonal()) + " mm",
        "--tolerance", "mm; left out: a hundredth of the size");
  bar.stage(0.3, 1.0, "symmetries");
  const SymmetryReport report = options.tolerance_mm
                                    ? examine_symmetries(*part, *options.tolerance_mm / millimetres / part->diagonal())
                                    : examine_symmetries(*part);
  if (!options.picture.empty()) write_symmetry_picture(options.picture, part, report.symmetries);
  bar.clear();
  if (options.json)
    std::printf("%s\n", json_of(*part, report).dump(1).c_str());
  else
    print(*part, report);
  return exit_done;
}

}  // namespace bin_scenes
