#include "page/grasp_view.hpp"

#include "core/read_file.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <vector>

namespace bin_scenes {

namespace {

namespace fs = std::filesystem;
using PageJson = nlohmann::ordered_json;

constexpr std::size_t most_grasps = 10;

/// Free, or what obstructs it, in the order of the tests.
constexpr const char* fates[] = {"free", "blocked", "slips", "approach", "closing", "lift"};

/// One of `fates`, from the text that reason_of() gives a grasp.
std::string fate_of(const std::string& reason) {
  if (reason.empty()) return "free";
  if (reason.rfind("slips", 0) == 0) return "slips";
  const std::size_t colon = reason.rfind(": ");
  return colon == std::string::npos ? "blocked" : reason.substr(colon + 2);
}

PageJson counts_of(const PageJson& all) {
  PageJson counts = PageJson::array();
  for (const PageJson& gripper : all.at("grippers")) {
    PageJson row = {{"gripper", gripper.at("name")}};
    for (const char* fate : fates) row[fate] = 0;
    for (const PageJson& grasp : all.at("grasps"))
      if (grasp.at("gripper") == gripper.at("name")) {
        PageJson& count = row.at(fate_of(grasp.at("reason").get<std::string>()));
        count = count.get<std::size_t>() + 1;
      }
    counts.push_back(row);
  }
  return counts;
}

/// With the displacement of its part's lift.
PageJson best_of(const PageJson& grasps, const PageJson& parts) {
  std::vector<const PageJson*> free;
  for (const PageJson& grasp : grasps)
    if (grasp.at("free").get<bool>()) free.push_back(&grasp);
  std::stable_sort(free.begin(), free.end(),
                   [](const PageJson* a, const PageJson* b) { return a->at("score") > b->at("score"); });
  std::set<int> shown;
  std::stable_partition(free.begin(), free.end(),
                        [&](const PageJson* grasp) { return shown.insert(grasp->at("part").get<int>()).second; });
  PageJson best = PageJson::array();
  for (std::size_t i = 0; i < std::min(most_grasps, free.size()); ++i) {
    best.push_back(*free[i]);
    best.back()["lift"] = {0.0, 0.0, 0.1};  // of files that earlier versions wrote
    for (const PageJson& part : parts)
      if (part.at("id") == free[i]->at("part") && part.contains("lift")) best.back()["lift"] = part.at("lift");
  }
  return best;
}

}  // namespace

PageJson grasp_view(const std::string& folder) {
  PageJson view = {{"grippers", PageJson::array()}, {"grasps", PageJson::array()}, {"counts", PageJson::array()}};
  const fs::path path = fs::path(folder) / "grasps.json";
  std::error_code missing;
  if (!fs::is_regular_file(path, missing)) return view;
  const PageJson all = PageJson::parse(read_file(path.string()));
  view["grippers"] = all.at("grippers");
  view["grasps"] = best_of(all.at("grasps"), all.value("parts", PageJson::array()));
  view["counts"] = counts_of(all);
  return view;
}

}  // namespace bin_scenes
