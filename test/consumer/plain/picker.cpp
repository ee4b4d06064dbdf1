// Pours 50 nuts, prints where they lie, takes the highest one out and lets the others settle.
#include <bin_scenes/config/request_reader.hpp>
#include <bin_scenes/generate/generator.hpp>

#include <cstdio>

int main(int, char** argv) {
  bin_scenes::Generator generator;
  bin_scenes::Heap heap = generator.heap(bin_scenes::read_request_text(
      "{seed: 7, bin: {inner_size: [0.12, 0.1, 0.1]}, parts: [{model: nut_hex.stl, unit: mm, count: 50}]}", argv[1]));
  heap.settle();
  const bin_scenes::Scene full = heap.scene();
  int highest = 0;
  for (const bin_scenes::ScenePart& part : full.parts) {
    const bin_scenes::Vec3& at = part.pose.position;
    std::printf("part %d at %.4f %.4f %.4f\n", part.id, at.x(), at.y(), at.z());
    if (at.z() > full.parts[highest].pose.position.z()) highest = part.id;
  }
  heap.remove({highest});
  const bool at_rest = heap.settle();
  int same = 0;
  for (const bin_scenes::ScenePart& part : heap.scene().parts)
    same += part.pose.position == full.parts[part.id].pose.position;
  std::printf("took out part %d: at rest %d, %d of 49 parts did not move\n", highest, at_rest, same);
}
