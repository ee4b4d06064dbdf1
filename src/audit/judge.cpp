/// Limits, ids, and the order of what is wrong: parts and images by their worst figure in units of its limit.
#include "audit/judge.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/scene/report.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <tuple>

namespace bin_scenes {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t most_listed = 20;

std::string number_text(double value) {
  return formatted("%.3g", value);
}

/// What is wrong with a part or an image, with the worst figure in units of its limit.
struct Verdict {
  AuditPlace place;
  double score = 0.0;
  std::vector<std::string> faults;
};

constexpr double score_of_fault = 1000.0;  ///< of what has no figure: a missing file is worse than a doubtful mask
constexpr double score_of_strict = 100.0;  ///< what no part may exceed comes before overlap and drift

/// The figures of one place in words, with signs where these are known.
std::string figure_text(const AuditMeasure& measure, double value, const AuditFigures& figures,
                        const AuditPlace& place) {
  const auto image = figures.images.find(place.view);
  const bool labelled = image != figures.images.end();
  if (labelled && place.entry != AuditPlace::image) {
    const LabelFigures& part = image->second.parts.at(place.entry);
    if (measure.key == figures.shift.key)
      return formatted("mask shifted by (%+.2f, %+.2f) px", part.shift->x(), part.shift->y());
    if (measure.key == figures.depth.key)
      return formatted("depth %.2f mm %s the model", std::abs(*part.depth), *part.depth > 0.0 ? "behind" : "before");
  } else if (labelled && measure.key == figures.camera.key) {
    const CameraError& error = image->second.camera;
    return formatted("all masks shifted by (%+.2f, %+.2f) px, up to %.2f px", error.shift.x(), error.shift.y(), value);
  } else if (labelled && measure.key == figures.depth_common.key) {
    return formatted("depth off by %+.2f mm", image->second.depth_offset);
  }
  if (measure.key == figures.mask.key || measure.key == figures.mask_visible.key)
    return std::string("IoU of ") + measure.key + " " + number_text(1.0 - value);
  const std::string unit = *measure.unit ? std::string(" ") + measure.unit : "";
  return std::string(measure.name) + " " + number_text(value) + unit;
}

/// All places with a figure, the worst first; of equals the earlier one.
std::vector<Verdict> verdicts(AuditFigures& figures, bool of_images) {
  std::map<std::pair<std::size_t, std::size_t>, Verdict> by_place;
  const auto at = [&](const AuditPlace& place) -> Verdict& {
    Verdict& verdict = by_place[{place.view, place.entry}];
    verdict.place = place;
    return verdict;
  };
  std::vector<AuditMeasure*> measures = figures.all();
  std::stable_partition(measures.begin(), measures.end(), [](const AuditMeasure* m) { return m->strict; });
  for (const AuditMeasure* measure : measures) {
    for (std::size_t i = 0; i < measure->values.size(); ++i) {
      const AuditPlace& place = measure->places[i];
      if ((place.entry == AuditPlace::image) != of_images) continue;
      Verdict& verdict = at(place);
      const double score = measure->values[i] / std::max(measure->limit, 1e-12);
      // Which of two views that disagree is wrong is said by its labels.
      const bool first = measure->strict && measure != &figures.apart_mm && measure != &figures.apart_degree;
      verdict.score = std::max(verdict.score, score > 1.0 && first ? score + score_of_strict : score);
      if (measure->values[i] > measure->limit)
        verdict.faults.push_back(figure_text(*measure, measure->values[i], figures, place));
    }
  }
  const auto add = [&](const AuditPlace& place, const std::vector<std::string>& faults) {
    if (faults.empty()) return;
    Verdict& verdict = at(place);
    verdict.faults.insert(verdict.faults.begin(), faults.begin(), faults.end());
    verdict.score += score_of_fault;
  };
  for (const auto& [view, image] : figures.images) {
    if (of_images) add({view, AuditPlace::image}, image.faults);
    for (std::size_t i = 0; !of_images && i < image.parts.size(); ++i) add({view, i}, image.parts[i].faults);
  }
  std::vector<Verdict> all;
  for (auto& [place, verdict] : by_place) all.push_back(std::move(verdict));
  std::stable_sort(all.begin(), all.end(), [](const Verdict& a, const Verdict& b) { return a.score > b.score; });
  return all;
}

Json vector_json(const Eigen::Vector2d& v) {
  return {v.x(), v.y()};
}

Json json_of(const BopSet& set, const AuditFigures& figures, const Verdict& verdict) {
  const BopView& view = set.views[verdict.place.view];
  Json json = {{"scene", view.scene.string()}, {"image", view.image}};
  if (!view.suffix.empty()) json["sensor"] = view.suffix.substr(1);
  const auto image = figures.images.find(verdict.place.view);
  if (verdict.place.entry != AuditPlace::image) {
    const BopPart& stated = view.parts[verdict.place.entry];
    json["entry"] = verdict.place.entry;
    json["object"] = stated.object;
    if (stated.id) json["id"] = *stated.id;
    if (image != figures.images.end()) {
      const LabelFigures& part = image->second.parts.at(verdict.place.entry);
      if (part.iou) json["iou"] = *part.iou;
      if (part.iou_visible) json["iou_visib"] = *part.iou_visible;
      if (part.shift) json["shift_px"] = vector_json(*part.shift);
      if (part.depth) json["depth_mm"] = *part.depth;
    }
  } else if (image != figures.images.end()) {
    json["shift_px"] = vector_json(image->second.camera.shift);
    json["depth_mm"] = image->second.depth_offset;
    std::size_t parts = 0;
    for (const LabelFigures& part : image->second.parts) parts += !part.faults.empty();
    json["parts_with_faults"] = parts;
  }
  json["score"] = verdict.score;
  json["faults"] = verdict.faults;
  return json;
}

/// The worst ones, and how many have faults.
void list_worst(const BopSet& set, AuditFigures& figures, bool of_images, Json& json) {
  const std::vector<Verdict> all = verdicts(figures, of_images);
  const std::string name = of_images ? "images" : "parts";
  json["worst_" + name] = Json::array();
  for (std::size_t i = 0; i < std::min(most_listed, all.size()); ++i)
    json["worst_" + name].push_back(json_of(set, figures, all[i]));
  json[name + "_with_faults"] =
      std::count_if(all.begin(), all.end(), [](const Verdict& verdict) { return !verdict.faults.empty(); });
}

/// What has no figure. Faults of the whole set are those of `camera` and `depth_common`.
bool has_faults(const AuditFigures& figures) {
  const auto of_part = [](const LabelFigures& part) { return !part.faults.empty(); };
  return std::any_of(figures.images.begin(), figures.images.end(), [&](const auto& item) {
    const LabelledImage& image = item.second;
    return !image.faults.empty() || std::any_of(image.parts.begin(), image.parts.end(), of_part);
  });
}

}  // namespace

double share_above(const AuditMeasure& measure) {
  const auto above =
      std::count_if(measure.values.begin(), measure.values.end(), [&](double value) { return value > measure.limit; });
  return measure.values.empty() ? 0.0 : static_cast<double>(above) / static_cast<double>(measure.values.size());
}

bool exceeds(const AuditMeasure& measure, double share) {
  return share_above(measure) > (measure.strict ? 0.0 : share);
}

void set_limits(AuditFigures& figures, const std::vector<std::string>& limits) {
  std::string known;
  for (const AuditMeasure* measure : figures.all()) known += (known.empty() ? "" : ", ") + std::string(measure->key);
  for (const std::string& text : limits) {
    const std::size_t equals = text.find('=');
    const std::string key = text.substr(0, equals);
    const auto all = figures.all();
    const auto measure = std::find_if(all.begin(), all.end(), [&](const AuditMeasure* m) { return m->key == key; });
    double value = 0.0;
    char behind = 0;
    const bool good = equals != std::string::npos &&
                      std::sscanf(text.c_str() + equals + 1, "%lf%c", &value, &behind) == 1 && value >= 0.0;
    if (measure == all.end() || !good)
      throw input_error("expected KEY=VALUE, found '" + text + "'", "--limit", "keys are " + known);
    (*measure)->limit = value;
  }
}

void check_ids(const BopSet& set, const std::vector<AuditHeap>& heaps, AuditFigures& figures) {
  std::size_t stated = 0, in_place = 0;  // this project puts part i at entry i
  for (const auto& [number, image] : figures.images) {
    const std::vector<BopPart>& parts = set.views[number].parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      stated += parts[i].id.has_value();
      in_place += parts[i].id == static_cast<int>(i);
    }
  }
  if (stated == 0) return;
  const bool places = static_cast<double>(in_place) >= 0.8 * static_cast<double>(stated);
  for (const AuditHeap& heap : heaps) {
    for (const BopView* view : heap.views) {
      const auto image = figures.images.find(static_cast<std::size_t>(view - set.views.data()));
      if (image == figures.images.end()) continue;
      std::set<int> seen;
      for (std::size_t i = 0; i < view->parts.size(); ++i) {
        const std::optional<int> id = view->parts[i].id, first = heap.views.front()->parts[i].id;
        if (!id) continue;
        std::vector<std::string>& faults = image->second.parts.at(i).faults;
        const std::string text = "its id " + std::to_string(*id);
        if (!seen.insert(*id).second) faults.push_back(text + " occurs twice in the image");
        const bool elsewhere = *id >= 0 && *id < static_cast<int>(view->parts.size()) && *id != static_cast<int>(i);
        if (places && elsewhere) faults.push_back(text + " belongs to entry " + std::to_string(*id));
        if (!places && first && id != first)
          faults.push_back(text + " is " + std::to_string(*first) + " in another view");
      }
    }
  }
}

Json audit_json(const BopSet& set, AuditFigures& figures, double share) {
  Json json = {{"scenes", figures.scenes},   {"heaps", figures.heaps},           {"parts", figures.parts},
               {"escaped", figures.escaped}, {"world_stated", set.world_stated}, {"exceeded", Json::array()},
               {"faults", figures.faults},   {"measures", Json::array()}};
  for (const AuditMeasure* measure : figures.all()) {
    if (measure->values.empty()) continue;
    const Quantiles q = quantiles(measure->values);
    json["measures"].push_back({{"key", measure->key},
                                {"name", measure->name},
                                {"unit", measure->unit},
                                {"p50", q.median},
                                {"p95", q.p95},
                                {"max", q.max},
                                {"limit", measure->limit},
                                {"above", share_above(*measure)},
                                {"allowed", measure->strict ? 0.0 : share},
                                {"count", measure->values.size()}});
    if (exceeds(*measure, share)) json["exceeded"].push_back(measure->key);
  }
  if (static_cast<double>(figures.escaped) > share * static_cast<double>(figures.parts))
    json["exceeded"].push_back("escaped");
  if (has_faults(figures)) json["exceeded"].push_back("faults");
  list_worst(set, figures, false, json);
  list_worst(set, figures, true, json);
  return json;
}

}  // namespace bin_scenes
