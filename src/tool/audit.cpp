/// The command `audit`: reads options and data set, audits heap by heap, and prints what is wrong.
#include "audit/auditor.hpp"
#include "audit/judge.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/formatted.hpp"
#include "dataset/whole_folders.hpp"
#include "page/audit_page.hpp"
#include "page/view_models.hpp"
#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

/// "x,y,z".
Vec3 vector_of(const std::string& text, const char* option, const char* remedy) {
  Vec3 v;
  char behind = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &v.x(), &v.y(), &v.z(), &behind) != 3 || !v.allFinite())
    throw input_error("expected x,y,z, found '" + text + "'", option, remedy);
  return v;
}

AuditBin bin_given(const AuditOptions& options) {
  AuditBin bin;
  bin.fitted = options.bin == "fitted";
  if (!options.bin.empty() && !bin.fitted) {
    bin.inner_size = vector_of(options.bin, "--bin", "inner size in m, for instance 0.4,0.3,0.2");
    if (!(bin.inner_size->minCoeff() > 0.0 && bin.inner_size->maxCoeff() < 100.0))
      throw input_error("must be above 0 and below 100 m", "--bin", "inner size in m, for instance 0.4,0.3,0.2");
  }
  if (!options.bin.empty() && options.floor)
    throw input_error("a bin has a floor of its own", "--floor", "give --bin or --floor");
  bin.floor = options.floor;
  return bin;
}

/// The bin that a data set of this project states for a scene, and the parts that are not in the ground truth.
AuditBin own_bin(const fs::path& root, const BopView& view) {
  AuditBin bin;
  const fs::path folder = root / "scenes" / ("scene_" + view.scene.filename().string());
  const auto scene = scene_in(folder);
  if (!scene) return bin;
  if (scene->bin.kind == Bin::Kind::box) bin.inner_size = scene->bin.inner_size;
  for (const ScenePart& part : scene->parts) {
    if (!part.distractor || !part.pose.finite()) continue;
    PartLine line = scene->models.at(part.line);
    line.path = find_model_file(scene->models[part.line], folder.string(), "");
    bin.others.push_back({line, part.pose});
  }
  return bin;
}

std::string bin_text(const AuditBin& bin, bool own) {
  if (own) return "the bins that the data set states";
  if (bin.fitted) return "a bin fitted around the parts of each heap";
  if (!bin.inner_size && !bin.floor) return "a table fitted to the lowest parts of each heap";
  if (bin.floor) return formatted("a table at z = %g m", *bin.floor);
  const Vec3& size = *bin.inner_size;
  return formatted("a bin of %g x %g x %g m around the origin", size.x(), size.y(), size.z());
}

/// The worst parts or images that have faults.
void print_worst(const Json& list, std::size_t all, const char* what) {
  if (all == 0) return;
  std::printf("\n%zu %s above a limit or with faults; the worst:\n", all, what);
  for (const Json& item : list) {
    if (item["faults"].empty()) continue;
    std::printf("  %s, image %d", item["scene"].get<std::string>().c_str(), item["image"].get<int>());
    if (item.contains("entry")) {
      std::printf(", entry %zu", item["entry"].get<std::size_t>());
      if (item.contains("id") && item["id"] != item["entry"]) std::printf(" (id %d)", item["id"].get<int>());
      std::printf(", object %d", item["object"].get<int>());
    }
    std::string faults;
    for (const Json& fault : item["faults"]) faults += (faults.empty() ? "" : "; ") + fault.get<std::string>();
    std::printf(": %s\n", faults.c_str());
  }
}

void print(const Json& json) {
  std::printf("%zu scenes, %zu heaps, %zu parts, %zu escaped; they lie in %s\n", json["scenes"].get<std::size_t>(),
              json["heaps"].get<std::size_t>(), json["parts"].get<std::size_t>(), json["escaped"].get<std::size_t>(),
              json["lies_in"].get<std::string>().c_str());
  if (!json["world_stated"])
    std::printf("no image states cam_R_w2c: up is opposite to the camera's axis, or what --up states\n");
  std::printf("%-12s %-46s %-14s %10s %10s %10s   %s\n", "key", "measure", "unit", "p50", "p95", "max",
              "above the limit");
  for (const Json& m : json["measures"])
    std::printf("%-12s %-46s %-14s %10.3g %10.3g %10.3g   %.1f %% above %g\n", m["key"].get<std::string>().c_str(),
                m["name"].get<std::string>().c_str(), m["unit"].get<std::string>().c_str(), m["p50"].get<double>(),
                m["p95"].get<double>(), m["max"].get<double>(), 100.0 * m["above"].get<double>(),
                m["limit"].get<double>());
  for (const Json& fault : json["faults"]) std::printf("%s\n", fault.get<std::string>().c_str());
  print_worst(json["worst_parts"], json["parts_with_faults"], "parts");
  print_worst(json["worst_images"], json["images_with_faults"], "images");
  std::string exceeded;
  for (const Json& key : json["exceeded"]) exceeded += (exceeded.empty() ? "" : ", ") + key.get<std::string>();
  std::printf("%s\n", exceeded.empty() ? "within all limits" : ("limits are exceeded: " + exceeded).c_str());
}

}  // namespace

int audit(const AuditOptions& options) {
  AuditBin bin = bin_given(options);
  BopReadOptions read;
  read.sensor = options.sensor;
  read.models = options.models;
  if (!options.up.empty()) {
    read.up = vector_of(options.up, "--up", "a direction, for instance 0,0,1");
    if (!(read.up->norm() > 0.0)) throw input_error("has no length", "--up", "a direction, for instance 0,0,1");
  }
  const fs::path root(options.directory);
  const bool own = fs::exists(root / "dataset.json") && options.bin.empty() && !options.floor;
  ProgressBar bar;
  bar.stage(0.0, 0.0, "reading the data set");
  const BopSet set = read_bop_set(own ? (root / "bop").string() : options.directory, read);
  AuditFigures figures;
  set_limits(figures, options.limits);
  std::set<fs::path> scenes;
  Auditor auditor(set);
  const std::vector<AuditHeap> heaps = heaps_of(set, figures);
  const std::size_t most = options.most > 0 ? std::min(options.most, heaps.size()) : heaps.size();
  for (const AuditHeap& heap : heaps) {
    if (figures.heaps == most) break;
    bar.show(0.8 * static_cast<double>(figures.heaps) / static_cast<double>(most),
             "heap " + std::to_string(figures.heaps + 1) + " of " + std::to_string(most));
    scenes.insert(heap.views.front()->scene);
    auditor.audit(heap, own ? own_bin(root, *heap.views.front()) : bin, figures);
  }
  auditor.audit_labels(figures, [&](double share) { bar.show(0.8 + 0.2 * share, "labels"); });
  check_ids(set, heaps, figures);
  bar.clear();
  figures.scenes = scenes.size();
  Json json = audit_json(set, figures, options.share);
  json["lies_in"] = bin_text(bin, own);
  if (!options.out.empty()) write_text(options.out, audit_page(options.directory, json, figures));
  if (options.json)
    std::printf("%s\n", json.dump(1).c_str());
  else
    print(json);
  return json["exceeded"].empty() ? exit_done : exit_set_apart;
}

}  // namespace bin_scenes
