/// Fills the HTML template with figures of the index and with small pictures. Scenes are thinned to what fits into one
/// page.
#include "page/report.hpp"

#include "bin_scenes/output/scene_writer.hpp"
#include "core/read_file.hpp"
#include "dataset/data_folder.hpp"
#include "dataset/published.hpp"
#include "dataset/scene_index.hpp"
#include "dataset/whole_folders.hpp"
#include "output/ply.hpp"
#include "output/png.hpp"
#include "output/png_reader.hpp"
#include "output/tiff.hpp"
#include "page/grasp_view.hpp"
#include "page/html.hpp"
#include "scene/palette.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace bin_scenes {

extern const char* const report_page;

namespace {

namespace fs = std::filesystem;
using SortedJson = nlohmann::json;

constexpr std::size_t most_rows = 20'000;  ///< of scenes that the gallery can filter
constexpr std::size_t most_pictures = 360;
constexpr std::size_t bytes_of_pictures = 2'600'000;  ///< as text
constexpr std::size_t most_rejected = 300;            ///< that are listed
constexpr std::size_t most_triangles = 60'000;        ///< of the models of the scene in 3-D
constexpr int picture_width = 112;

double rounded(double value) {
  return std::isfinite(value) && value != 0.0 ? std::strtod(std::to_string(value).c_str(), nullptr) : 0.0;
}

/// Pictures of the model `image` may be dim, as only highlights come near to white: all but the brightest hundredth
/// fills the range.
void brighten(std::vector<std::uint8_t>& levels) {
  if (levels.empty()) return;
  std::vector<std::uint8_t> sorted = levels;
  const auto bright = sorted.begin() + static_cast<std::ptrdiff_t>(99 * (sorted.size() - 1) / 100);
  std::nth_element(sorted.begin(), bright, sorted.end());
  const unsigned most = std::max<unsigned>(*bright, 1);
  for (std::uint8_t& level : levels) level = static_cast<std::uint8_t>(std::min(255u, level * 255u / most));
}

/// A picture of the first sensor, made small; empty if the data set has none.
std::string small_picture(const DataFolder& folder, const DataSetFacts& facts, std::size_t scene) {
  std::vector<fs::path> candidates;
  if (const auto file = scene_in(folder.scene(scene)))
    for (const SceneSensor& sensor : file->sensors) candidates.push_back(folder.scene(scene) / (sensor.name + ".png"));
  candidates.push_back(folder.bop(facts, scene) / bop_picture(facts.bop));
  const auto path =
      std::find_if(candidates.begin(), candidates.end(), [](const fs::path& p) { return fs::is_regular_file(p); });
  if (path == candidates.end()) return "";
  const LoadedImage image = path->extension() != ".png" ? load_tiff(path->string()) : load_png(path->string());
  const int step = std::max(1, image.width / picture_width), width = image.width / step, height = image.height / step;
  std::vector<std::uint8_t> small;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        unsigned sum = 0;
        for (int dy = 0; dy < step; ++dy)
          for (int dx = 0; dx < step; ++dx)
            sum += image.samples[static_cast<std::size_t>(
                       ((y * step + dy) * image.width + x * step + dx) * image.channels + c)] >>
                   (image.bits - 8);
        small.push_back(static_cast<std::uint8_t>(sum / static_cast<unsigned>(step * step)));
      }
    }
  }
  brighten(small);
  for (std::uint8_t& level : small) level &= 0xf0u;  // fewer levels pack better; nobody sees it at this size
  return base64(png8(width, height, image.channels, small));
}

/// Vertices (m) and triangles of a model of the data set (mm).
SortedJson model_of(const fs::path& path) {
  const Mesh mesh = read_ply(path.string());
  SortedJson model = {{"vertices", SortedJson::array()}, {"triangles", SortedJson::array()}};
  for (const Vec3& v : mesh.vertices)
    for (int i = 0; i < 3; ++i) model["vertices"].push_back(rounded(v[i] / 1e3));
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t k : t) model["triangles"].push_back(k);
  return model;
}

/// Parts with their models, as far as the data set holds these (output bop); else the page draws boxes.
SortedJson scene_in_3d(const DataFolder& folder, const DataSetFacts& facts, std::size_t number) {
  const auto scene = scene_in(folder.scene(number));
  if (!scene) return {};
  SortedJson view = {
      {"scene", number}, {"parts", SortedJson::array()}, {"models", SortedJson::array()}, {"size", {0.4, 0.4, 0.4}}};
  view["grasps"] = grasp_view(folder.scene(number).string());
  const Vec3& size = scene->bin.inner_size;
  if (scene->bin.kind == Bin::Kind::box) view["size"] = {size.x(), size.y(), size.z()};
  std::map<int, int> object_of;
  const fs::path truth = BopFiles{folder.bop(facts, number), bop_suffix(facts.bop)}.truth();
  if (fs::is_regular_file(truth)) {
    const SortedJson images = SortedJson::parse(read_file(truth.string()));
    for (const SortedJson& entry : images.value("0", SortedJson::array()))
      object_of[entry.at("id")] = entry.at("obj_id");
  }
  std::map<int, std::size_t> models;
  std::size_t triangles = 0;
  for (const ScenePart& part : scene->parts) {
    if (!part.pose.finite()) continue;
    int place = -1;
    const auto object = object_of.find(part.id);
    if (object != object_of.end()) {
      const fs::path ply =
          bop_model_file(BopFolder{folder.root / "bop"}.models(), static_cast<std::size_t>(object->second));
      if (!models.count(object->second) && fs::is_regular_file(ply)) {
        SortedJson model = model_of(ply);
        triangles += model["triangles"].size() / 3;
        if (triangles > most_triangles) model = {{"vertices", SortedJson::array()}, {"triangles", SortedJson::array()}};
        models[object->second] = view["models"].size();
        view["models"].push_back(model);
      }
      if (models.count(object->second)) place = static_cast<int>(models[object->second]);
    }
    SortedJson row = {place};
    for (int i = 0; i < 3; ++i) row.push_back(rounded(part.pose.position[i]));
    for (int i = 0; i < 4; ++i) row.push_back(rounded(part.pose.orientation.coeffs()[i]));
    row.push_back(css_colour(part_colour(part.id)));
    view["parts"].push_back(row);
  }
  return view;
}

double mean_of(const std::vector<int>& histogram) {
  double sum = 0.0, weighted = 0.0;
  for (std::size_t i = 0; i < histogram.size(); ++i) {
    sum += histogram[i];
    weighted += histogram[i] * (static_cast<double>(i) + 0.5) / static_cast<double>(histogram.size());
  }
  return sum > 0.0 ? weighted / sum : 0.0;
}

SortedJson pictures_of(const SortedJson& rows, const DataFolder& folder, const DataSetFacts& facts) {
  SortedJson pictures = SortedJson::object();
  std::size_t used = 0;
  const std::size_t step = std::max<std::size_t>(1, rows.size() / most_pictures);
  for (std::size_t i = 0; i < rows.size() && used < bytes_of_pictures; i += step) {
    const std::size_t scene = rows[i][0];
    const std::string picture = small_picture(folder, facts, scene);
    if (picture.empty()) continue;
    pictures[std::to_string(scene)] = picture;
    used += picture.size();
  }
  return pictures;
}

SortedJson rows_of(const std::vector<SceneIndex::Rejected>& rejected) {
  SortedJson listed = SortedJson::array();
  for (std::size_t i = 0; i < std::min(rejected.size(), most_rejected); ++i) {
    std::string reasons;
    for (const SortedJson& reason : SortedJson::parse(rejected[i].reasons))
      reasons += (reasons.empty() ? "" : "; ") + reason.get<std::string>();
    listed.push_back({rejected[i].heap, rejected[i].attempt, reasons, rejected[i].path});
  }
  return listed;
}

}  // namespace

ReportResult write_report(const std::string& directory, const std::string& path) {
  const DataFolder folder{directory};
  const DataSetFacts facts = read_facts(directory);
  const SceneIndex index(folder.index(), true);
  const IndexCounts counts = index.counts();
  const std::size_t every = counts.scenes / most_rows + 1;
  std::vector<int> visible(20, 0), tilt(20, 0);
  std::size_t seen = 0, parts = 0;
  Seen published;
  SortedJson rows = SortedJson::array();
  std::vector<std::size_t> scenes;
  index.each_scene([&](const SceneIndex::Row& row) {
    const auto v = row.summary.at("visible").get<std::vector<int>>(),
               t = row.summary.at("tilt").get<std::vector<int>>();
    std::transform(v.begin(), v.end(), visible.begin(), visible.begin(), std::plus<int>());
    std::transform(t.begin(), t.end(), tilt.begin(), tilt.begin(), std::plus<int>());
    parts += row.summary.at("parts").get<std::size_t>();
    published.add(row.summary);
    scenes.push_back(row.scene);
    if (seen++ % every != 0) return;
    rows.push_back({row.scene, row.summary.at("parts"), rounded(mean_of(v)), rounded(row.summary.at("fill")),
                    rounded(row.summary.at("penetration")), rounded(row.summary.at("rest_s"))});
  });

  ReportResult result;
  result.scenes = scenes.size();
  const SortedJson pictures = pictures_of(rows, folder, facts);
  result.pictures = pictures.size();
  const std::vector<SceneIndex::Rejected> rejected = index.rejected();
  const SortedJson data = {
      {"name", fs::weakly_canonical(directory).filename().string()},
      {"plan", read_file((folder.root / "plan.yaml").string())},
      {"facts", {{"outputs", facts.formats}, {"version", facts.version}}},
      {"counts",
       {{"scenes", counts.scenes}, {"failed", counts.failed}, {"rejected", counts.rejected}, {"parts", parts}}},
      {"speed",
       {{"cpu_seconds_a_heap", counts.timed ? counts.cpu_s / static_cast<double>(counts.timed) : 0.0},
        {"seconds_a_heap", counts.timed ? counts.wall_s / static_cast<double>(counts.timed) : 0.0},
        {"stages_ms", index.stages_ms()}}},
      {"visible", visible},
      {"tilt", tilt},
      {"published", published.rows()},
      {"scenes", {{"columns", {"scene", "parts", "visible", "fill", "penetration", "rest"}}, {"rows", rows}}},
      {"pictures", pictures},
      {"rejected", {{"total", rejected.size()}, {"rows", rows_of(rejected)}}},
      {"scene3d", scenes.empty() ? SortedJson() : scene_in_3d(folder, facts, scenes[scenes.size() / 2])}};

  const std::string library = three_js();
  result.in_3d = !library.empty();
  const std::string page =
      filled_page(report_page, library, data.dump(-1, ' ', false, SortedJson::error_handler_t::replace));
  write_text(path, page);
  result.bytes = page.size();
  return result;
}

}  // namespace bin_scenes
