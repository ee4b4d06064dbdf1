#include "page/audit_page.hpp"

#include "page/html.hpp"
#include "page/svg.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

extern const char* const audit_page_html;

namespace {

std::string figure_text(double value) {
  return short_number(value, 3);
}

/// Shares of parts over the value, up to the 99th of a hundred; what lies beyond counts to the last bar.
std::string histogram(const AuditMeasure& measure) {
  constexpr std::size_t bars = 30;
  constexpr double width = 300.0, height = 90.0;
  std::vector<double> sorted = measure.values;
  std::sort(sorted.begin(), sorted.end());
  const double end = std::max(sorted[(sorted.size() - 1) * 99 / 100], 1e-9);
  std::vector<std::size_t> counts(bars, 0);
  for (const double value : sorted)
    ++counts[std::min(bars - 1, static_cast<std::size_t>(value / end * static_cast<double>(bars)))];
  const double most = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
  Svg svg("viewBox=\"0 0 300 110\" width=\"100%\"");
  for (std::size_t i = 0; i < bars; ++i) {
    const double tall = height * static_cast<double>(counts[i]) / most, step = width / static_cast<double>(bars);
    svg.bar({step * static_cast<double>(i), height - tall}, {step - 1.0, tall}, "#3b6ea5");
  }
  svg.text({0.0, 104.0}, "0");
  svg.text({width, 104.0}, figure_text(end) + " " + measure.unit, "end");
  return svg.str();
}

/// The worst parts or images, with their signed figures.
std::string worst_table(const nlohmann::ordered_json& list, const std::string& title, std::size_t faulty) {
  if (list.empty()) return "";
  std::string table = "<h2 class=worst>" + title + "; " + std::to_string(faulty) +
                      " above a limit or with faults</h2><table><tr><th>scene</th><th class=n>image</th>";
  const bool parts = list.front().contains("entry");
  if (parts) table += "<th class=n>entry</th><th class=n>object</th><th class=n>IoU</th>";
  table += "<th class=n>shift, px</th><th class=n>depth, mm</th><th>what is wrong</th></tr>";
  for (const auto& item : list) {
    const auto cell = [&](const char* key) {
      if (!item.contains(key)) return std::string("<td class=n>-</td>");
      const auto& value = item.at(key);
      const std::string text = value.is_array() ? figure_text(value.at(0)) + ", " + figure_text(value.at(1))
                                                : figure_text(value.get<double>());
      return "<td class=n>" + text + "</td>";
    };
    table += "<tr><td>" + escaped(item.at("scene").get<std::string>()) + "</td>" + cell("image");
    if (parts) table += cell("entry") + cell("object") + cell("iou");
    std::string faults;
    for (const auto& fault : item.at("faults")) faults += (faults.empty() ? "" : "; ") + fault.get<std::string>();
    table += cell("shift_px") + cell("depth_mm") + "<td>" + escaped(faults) + "</td></tr>";
  }
  return table + "</table>";
}

}  // namespace

std::string audit_page(const std::string& name, const nlohmann::ordered_json& json, AuditFigures& figures) {
  std::string page = "<h1>Audit of " + escaped(name) + "</h1><p>" + json.at("scenes").dump() + " scenes, " +
                     json.at("heaps").dump() + " heaps, " + json.at("parts").dump() + " parts, " +
                     json.at("escaped").dump() + " escaped; they lie in " +
                     escaped(json.at("lies_in").get<std::string>()) + ".</p><table><tr><th>measure</th><th>unit</th>";
  for (const char* title : {"p50", "p95", "max", "limit", "parts above"})
    page += std::string("<th class=n>") + title + "</th>";
  page += "</tr>";
  for (const auto& m : json.at("measures")) {
    page += "<tr><td>" + m.at("name").get<std::string>() + "</td><td>" + m.at("unit").get<std::string>() + "</td>";
    for (const char* key : {"p50", "p95", "max", "limit"}) page += "<td class=n>" + figure_text(m.at(key)) + "</td>";
    page += "<td class=n>" + figure_text(100.0 * m.at("above").get<double>()) + " %</td></tr>";
  }
  page += "</table>";
  for (const auto& fault : json.at("faults")) page += "<p class=bad>" + escaped(fault.get<std::string>()) + "</p>";
  page += worst_table(json.at("worst_parts"), "Worst parts", json.at("parts_with_faults"));
  page += worst_table(json.at("worst_images"), "Worst images", json.at("images_with_faults"));
  page += "<div class=charts>";
  for (const AuditMeasure* measure : figures.all()) {
    if (measure->values.empty()) continue;
    page += std::string("<div><h2>") + measure->name + "</h2>" + histogram(*measure) + "</div>";
  }
  std::string whole = audit_page_html;
  put(whole, "<!--BODY-->", page + "</div>");
  return whole;
}

}  // namespace bin_scenes
