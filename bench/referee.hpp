/// An outside judge of final scenes: the parts' exact convex pieces in stock Bullet, double precision, 0.25 ms, no
/// margins. What overlaps is measured piece by piece; what rests stays, what overlaps, floats or was only called
/// resting moves.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <string>
#include <vector>

namespace bin_scenes::bench {

/// Vertices of the convex pieces that a part is made of, in its model frame (m).
using Pieces = std::vector<std::vector<Vec3>>;
/// Reads an OBJ file with the vertices of each piece behind a line `o NAME` (`scale` metres a unit). Throws an input
/// Error if there is none.
Pieces read_pieces(const std::string& path, double scale);

/// Overlap as the referee sees it, as shares of a part's diagonal.
struct Overlap {
  std::vector<double> pairs;  ///< of overlapping pairs: the deepest two pieces by GJK and EPA / the smaller diagonal
  std::vector<double> bin;    ///< by part: the deepest vertex behind the floor, or behind a wall below the rim
};

/// Of the parts of a box bin as they lie. `pieces` by part line. Escaped and unpoured parts are left out.
Overlap referee_overlap(const Scene& scene, const LoadedRequest& loaded, const std::vector<Pieces>& pieces);

struct Drift {
  std::vector<double> moved;   ///< of the centres of mass / diagonal, by part
  std::vector<double> turned;  ///< degrees
};

/// Lets the parts of a box bin go on from rest for `seconds`. `pieces` by part line. Escaped and unpoured parts are
/// left out. Sets globals of Bullet: run it in a process of its own.
Drift referee_drift(const Scene& scene, const LoadedRequest& loaded, const std::vector<Pieces>& pieces,
                    double seconds = 0.5);

}  // namespace bin_scenes::bench
