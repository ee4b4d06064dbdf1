#include "random_part.hpp"

#include "piece_files.hpp"

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bin_scenes::bench {

namespace {

/// A prism or frustum: two rings of as many vertices, the lower first.
struct Piece {
  Pose pose;
  Vec3 half;  ///< of its box, own axes
  std::vector<Vec3> vertices;
};

/// Its rings in its own axes, then moved.
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

}  // namespace

int write_random_part(const std::string& folder, std::uint64_t seed) {
  Random random(seed, 0, Stream::probe);
  std::vector<Piece> pieces = pieces_of(random);
  Aabb box;
  for (const Piece& piece : pieces)
    for (const Vec3& vertex : piece.vertices) box.extend(vertex);
  const double scale = random.uniform(45.0, 65.0) / box.diagonal();

  std::vector<Prism> prisms;
  for (const Piece& piece : pieces) {
    prisms.push_back(piece.vertices);
    for (Vec3& vertex : prisms.back()) vertex *= scale;
  }
  write_pieces(folder, prisms);
  return static_cast<int>(pieces.size());
}

}  // namespace bin_scenes::bench
