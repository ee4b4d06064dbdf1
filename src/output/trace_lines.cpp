#include "output/trace_lines.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace bin_scenes {

namespace {

using Json = nlohmann::ordered_json;

void append(Json& row, const Vec3& v) {
  for (int i = 0; i < 3; ++i) row.push_back(v[i]);
}

double lightest_weight(const LoadedRequest& loaded) {
  double mass = std::numeric_limits<double>::infinity();
  for (std::size_t line = 0; line < loaded.parts.size(); ++line)
    if (!loaded.request.parts[line].stays())
      mass = std::min(mass, mass_of(loaded.request.parts[line], *loaded.parts[line]));
  const double weight = mass * loaded.request.gravity.norm();
  return std::isfinite(weight) && weight > 0.0 ? weight : 1.0;
}

}  // namespace

const char* const trace_lines_format = "bin_scenes/trace/1";

TraceLines::TraceLines(const std::string& path) : file_(path) {}

void TraceLines::begin(const LoadedRequest& loaded) {
  write(Json{{"format", trace_lines_format}, {"weight", lightest_weight(loaded)}}.dump());
}

void TraceLines::add(const TraceSample& sample) {
  BIN_SCENES_ASSERT(file_.size() > 0 && sample.time >= 0.0);
  Json parts = Json::array(), contacts = Json::array();
  for (const ScenePart& part : sample.parts) {
    if (!part.pose.finite()) continue;
    BIN_SCENES_ASSERT(is_rigid(part.pose));
    Json row = {part.id};
    append(row, part.pose.position);
    for (int i = 0; i < 4; ++i) row.push_back(part.pose.orientation.coeffs()[i]);
    parts.push_back(row);
  }
  for (const SceneContact& contact : sample.contacts) {
    BIN_SCENES_ASSERT(contact.a >= 0 && contact.a != contact.b && is_unit(contact.normal));
    Json row = {contact.a, contact.b};
    append(row, contact.point);
    append(row, contact.normal);
    append(row, contact.force);
    row.push_back(static_cast<int>(contact.action));
    contacts.push_back(row);
  }
  write(Json{{"time", sample.time}, {"parts", parts}, {"contacts", contacts}}.dump());
}

void TraceLines::write(const std::string& line) {
  file_.append(line.data(), line.size());
  file_.append("\n", 1);
}

}  // namespace bin_scenes
