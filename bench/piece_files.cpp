#include "piece_files.hpp"

#include "bin_scenes/output/scene_writer.hpp"

#include <cstdio>
#include <filesystem>
#include <sstream>

namespace bin_scenes::bench {

void write_pieces(const std::string& folder, const std::vector<Prism>& prisms) {
  std::filesystem::create_directories(folder);
  std::ostringstream part;
  std::size_t first = 1;
  for (std::size_t k = 0; k < prisms.size(); ++k) {
    std::ostringstream vertices;
    vertices.precision(9);
    for (const Vec3& vertex : prisms[k]) vertices << "v " << vertex.transpose() << '\n';
    char name[32];
    std::snprintf(name, sizeof name, "/hull_%02d.obj", static_cast<int>(k));
    write_text(folder + name, vertices.str());
    part << vertices.str();
    const std::size_t sides = prisms[k].size() / 2;
    for (std::size_t i = 0; i < sides; ++i) {
      const std::size_t next = (i + 1) % sides;
      part << "f " << first + i << ' ' << first + next << ' ' << first + sides + next << ' ' << first + sides + i
           << '\n';
    }
    part << 'f';
    for (std::size_t i = sides; i-- > 0;) part << ' ' << first + i;
    part << "\nf";
    for (std::size_t i = 0; i < sides; ++i) part << ' ' << first + sides + i;
    part << '\n';
    first += prisms[k].size();
  }
  write_text(folder + "/part.obj", part.str());
}

}  // namespace bin_scenes::bench
