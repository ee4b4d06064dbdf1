#include "config/plan_surfaces.hpp"

#include <algorithm>
#include <cstdio>
#include <set>

namespace bin_scenes::config {

namespace {

/// Index of the part line of a key such as parts[2].surface.albedo.
std::size_t line_of(const std::string& path) {
  std::size_t line = 0;
  std::sscanf(path.c_str(), "parts[%zu]", &line);
  return line;
}

}  // namespace

bool is_of_surface(const std::string& path) {
  const std::size_t end = path.find("].surface");
  return path.rfind("parts[", 0) == 0 && end != std::string::npos && path.find(']') == end;
}

void split_surfaces(Request& request, Amount& amount, const std::vector<Draw>& draws, std::size_t kinds,
                    const std::function<Request(std::size_t kind)>& drawn) {
  std::set<std::size_t> varied;
  for (const Draw& draw : draws)
    if (is_of_surface(draw.path)) varied.insert(line_of(draw.path));
  if (kinds < 2 || varied.empty()) return;
  std::vector<Request> others;
  for (std::size_t kind = 1; kind < kinds; ++kind) others.push_back(drawn(kind));
  std::vector<PartLine> lines;
  std::vector<double> shares;
  for (std::size_t i = 0; i < request.parts.size(); ++i) {
    const PartLine& line = request.parts[i];
    const double share = i < amount.shares.size() ? amount.shares[i] : 1.0;
    const std::size_t pieces = varied.count(i) && !line.fixed && line.poses.empty() ? kinds : 1;
    for (std::size_t kind = 0; kind < pieces; ++kind) {
      lines.push_back(line);
      lines.back().count = (line.count + kind) / pieces;
      if (kind > 0) lines.back().surface = others[kind - 1].parts.at(i).surface;
      shares.push_back(share / static_cast<double>(pieces));
      if (pieces > 1 && lines.back().count == 0 && !amount.parts && !amount.fill) {
        lines.pop_back();
        shares.pop_back();
      }
    }
  }
  request.parts = std::move(lines);
  amount.shares = std::move(shares);
}

}  // namespace bin_scenes::config
