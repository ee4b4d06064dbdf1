// Pours 50 nuts, prints where they lie, takes the highest out and lets the others settle.
#include <bin_scenes/config/request_reader.hpp>
#include <bin_scenes/generate/generator.hpp>

#include <cstdio>

namespace bs = bin_scenes;

bs::Scene make(bs::Generator& generator, const bs::Request& request) {
  bs::Scene made;
  generator.generate(request, {}, [&](bs::Generator::Result&& result) { made = std::move(result.scene); });
  return made;
}

int main(int, char** argv) {
  bs::Request request = bs::read_request_text(
      "{seed: 7, bin: {inner_size: [0.12, 0.1, 0.1]}, parts: [{model: nut_hex.stl, unit: mm, count: 50}]}", argv[1]);
  bs::Generator generator;
  const bs::Scene full = make(generator, request);
  std::size_t highest = 0;
  for (const bs::ScenePart& part : full.parts) {
    const bs::Vec3& at = part.pose.position;
    std::printf("part %d at %.4f %.4f %.4f\n", int(part.id), at.x(), at.y(), at.z());
    if (at.z() > full.parts[highest].pose.position.z()) highest = part.id;
  }
  request.pour.pattern = bs::Pour::Pattern::given;
  request.parts[0].count = 49;
  for (const bs::ScenePart& part : full.parts)
    if (std::size_t(part.id) != highest) request.parts[0].poses.push_back(part.pose);
  const bs::Scene picked = make(generator, request);
  std::printf("took out part %zu: %zu parts, at rest: %d, hash %016llx\n", highest, picked.parts.size(),
              picked.report.at_rest, static_cast<unsigned long long>(full.report.state_hash));
}
