/// Parts as lists of convex prisms in millimetres: drawn from a seed, or thin ones by name. Each is written as a mesh
/// and as the list of its pieces, which the referee judges by.
#include "made_part.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/mesh/mesh.hpp"
#include "bin_scenes/output/scene_writer.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

namespace bin_scenes::bench {

namespace {

/// Corners of a convex prism or frustum (mm): two rings of as many, the lower first, both counterclockwise
/// as seen from above.
using Prism = std::vector<Vec3>;
using Prisms = std::vector<Prism>;

/// FOLDER/part.obj, the prisms as overlapping solids of one file, and FOLDER/pieces.obj, their vertices alone as in
/// models/pieces. Returns the number of prisms.
int write_pieces(const std::string& folder, const Prisms& prisms) {
  std::filesystem::create_directories(folder);
  std::ostringstream part, pieces;
  std::size_t first = 1;
  for (std::size_t k = 0; k < prisms.size(); ++k) {
    std::ostringstream vertices;
    vertices.precision(9);
    for (const Vec3& vertex : prisms[k]) vertices << "v " << vertex.transpose() << '\n';
    pieces << "o piece_" << k << '\n' << vertices.str();
    part << vertices.str();
    const std::size_t sides = prisms[k].size() / 2, top = first + sides;
    std::ostringstream lower, upper;
    for (std::size_t i = 0; i < sides; ++i) {
      const std::size_t next = (i + 1) % sides;
      part << "f " << first + i << ' ' << first + next << ' ' << top + next << ' ' << top + i << '\n';
      lower << ' ' << top - 1 - i;
      upper << ' ' << top + i;
    }
    part << 'f' << lower.str() << "\nf" << upper.str() << '\n';
    first = top + sides;
  }
  write_text(folder + "/part.obj", part.str());
  write_text(folder + "/pieces.obj", pieces.str());
  return static_cast<int>(prisms.size());
}

struct Piece {
  Pose pose;
  Vec3 half;  ///< of its box, own axes
  Prism vertices;
};

Piece piece_of(Random& random, const Pose& pose) {
  Piece piece{pose, Vec3(random.uniform(0.08, 0.6), random.uniform(0.08, 0.6), random.uniform(0.08, 0.6)), {}};
  const int sides = random.uniform() < 0.6 ? 4 : static_cast<int>(5 + random.below(6));
  const double taper = random.uniform() < 0.3 ? random.uniform(0.5, 1.0) : 1.0;
  const double corner = std::cos(M_PI / sides);  // as wide as its box between sides, not between corners
  for (const int end : {-1, 1})
    for (int i = 0; i < sides; ++i) {
      const double turn = 2.0 * M_PI * (i + 0.5) / sides, width = (end > 0 ? taper : 1.0) / corner;
      piece.vertices.push_back(pose * Vec3(width * piece.half.x() * std::cos(turn),
                                           width * piece.half.y() * std::sin(turn), end * piece.half.z()));
    }
  return piece;
}

Quat some_turn(Random& random) {
  if (random.uniform() < 0.4) return random.orientation();
  const auto quarter = [&](const Vec3& axis) {
    return Quat(Eigen::AngleAxisd(0.5 * M_PI * static_cast<double>(random.below(4)), axis));
  };
  return quarter(Vec3::UnitX()) * quarter(Vec3::UnitY()) * quarter(Vec3::UnitZ());
}

/// Through a place of an earlier piece, well inside it, so that what joins them is as thick as a wall.
std::vector<Piece> pieces_of(Random& random) {
  std::vector<Piece> pieces = {piece_of(random, Pose{})};
  const std::size_t count = 2 + random.below(5);
  while (pieces.size() < count) {
    const Piece& earlier = pieces[random.below(pieces.size())];
    const auto inside = [&] { return random.uniform(-0.7, 0.7); };
    const Vec3 at =
        earlier.pose * Vec3(inside() * earlier.half.x(), inside() * earlier.half.y(), inside() * earlier.half.z());
    Pose pose{at, some_turn(random)};
    Piece piece = piece_of(random, pose);
    const Vec3 shift = pose.orientation * Vec3(0, 0, random.uniform(-0.8, 0.8) * piece.half.z());
    for (Vec3& vertex : piece.vertices) vertex += shift;
    piece.pose.position += shift;
    pieces.push_back(piece);
  }
  return pieces;
}

Prism box(const Vec3& center, const Vec3& size) {
  Prism prism;
  for (const double z : {-0.5, 0.5})
    for (const auto& [x, y] : {std::pair(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
      prism.push_back(center + Vec3(x, y, z).cwiseProduct(size));
  return prism;
}

Vec3 on_circle(double radius, double turns, double z) {
  return {radius * std::cos(2 * M_PI * turns), radius * std::sin(2 * M_PI * turns), z};
}

/// A wire from p to q, longer by half its radius at either end, so that those of a path overlap.
Prism wire(const Vec3& p, const Vec3& q, double radius) {
  constexpr int sides = 8;
  const Vec3 along = (q - p).normalized(), u = along.unitOrthogonal(), v = along.cross(u);
  Prism prism;
  for (const Vec3& end : {Vec3(p - 0.5 * radius * along), Vec3(q + 0.5 * radius * along)})
    for (int i = 0; i < sides; ++i) {
      const Vec3 around = on_circle(radius, (i + 0.5) / sides, 0);
      prism.push_back(end + around.x() * u + around.y() * v);
    }
  return prism;
}

Prisms sheet() {
  return {box(Vec3::Zero(), {50, 30, 0.5})};
}

Prisms disc() {
  Prism prism;
  for (const double z : {0.0, 0.6})
    for (int i = 0; i < 24; ++i) prism.push_back(on_circle(25, i / 24.0, z));
  return {prism};
}

Prisms lattice() {
  Prisms bars;
  for (int i = -2; i <= 2; ++i) {
    bars.push_back(box({10.0 * i, 0, 0}, {2, 42, 2}));
    bars.push_back(box({0, 10.0 * i, 0}, {42, 2, 2}));
  }
  return bars;
}

Prisms comb() {
  Prisms teeth = {box(Vec3::Zero(), {50, 6, 3})};
  for (int i = -4; i <= 4; ++i) teeth.push_back(box({5.5 * i, 12, 0}, {2, 22, 3}));
  return teeth;
}

Prisms frame() {
  Prisms bars;
  for (const int side : {-1, 1}) {
    bars.push_back(box({0, 18.0 * side, 0}, {50, 4, 3}));
    bars.push_back(box({23.0 * side, 0, 0}, {4, 40, 3}));
  }
  return bars;
}

Prisms tube() {
  Prisms wall;
  for (int i = 0; i < 16; ++i) {
    const double from = i / 16.0, to = (i + 1) / 16.0;
    Prism sector;
    for (const double z : {0.0, 45.0})
      for (const Vec3& corner :
           {on_circle(11, from, z), on_circle(13, from, z), on_circle(13, to, z), on_circle(11, to, z)})
        sector.push_back(corner);
    wall.push_back(sector);
  }
  return wall;
}

Prisms wire_ring() {
  Prisms ring;
  for (int i = 0; i < 16; ++i) ring.push_back(wire(on_circle(22, i / 16.0, 0), on_circle(22, (i + 1) / 16.0, 0), 1.2));
  return ring;
}

Prisms spring() {
  const auto at = [](int i) { return on_circle(10, 0.1 * i, 0.7 * i); };
  Prisms coil;
  for (int i = 0; i < 44; ++i) coil.push_back(wire(at(i), at(i + 1), 1.3));
  return coil;
}

const std::map<std::string, Prisms (*)()> thin = {{"sheet", sheet},         {"disc", disc},    {"lattice", lattice},
                                                  {"comb", comb},           {"frame", frame},  {"tube", tube},
                                                  {"wire_ring", wire_ring}, {"spring", spring}};

}  // namespace

int write_random_part(const std::string& folder, std::uint64_t seed) {
  Random random(seed, 0, Stream::probe);
  std::vector<Piece> pieces = pieces_of(random);
  Aabb box;
  for (const Piece& piece : pieces)
    for (const Vec3& vertex : piece.vertices) box.extend(vertex);
  const double scale = random.uniform(45.0, 65.0) / box.diagonal();

  Prisms prisms;
  for (const Piece& piece : pieces) {
    prisms.push_back(piece.vertices);
    for (Vec3& vertex : prisms.back()) vertex *= scale;
  }
  return write_pieces(folder, prisms);
}

std::vector<std::string> thin_parts() {
  std::vector<std::string> names;
  for (const auto& [name, make] : thin) names.push_back(name);
  return names;
}

int write_thin_part(const std::string& folder, const std::string& name) {
  const auto found = thin.find(name);
  if (found == thin.end()) throw input_error("no thin part of this name", name, "see bench/made_part.hpp");
  return write_pieces(folder, found->second());
}

}  // namespace bin_scenes::bench
