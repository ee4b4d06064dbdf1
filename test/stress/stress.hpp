/// Vocabulary of the stress suite: a theme is a list of rows, a row a list of cases, a case a request and what must
/// hold of its scenes. Each case runs under each solver of its row in a process of its own (apart.hpp), through the
/// YAML that write_request makes of it, so that what failed is what the file says.
#pragma once

#include "stress/shapes.hpp"

#include "bin_scenes/scene/request.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes::stress {

/// What must hold of every scene of a case, beside: the process lives, no velocity is NaN, nothing leaves the bin or
/// goes through its walls, nothing overlaps too much, and what is called at rest stays (`stays` below).
struct Expect {
  bool refused = false;       ///< the request must end in one input Error, and nothing else of this list counts
  bool rests = true;          ///< every part must come to rest; false: it may also be said to move
  bool all_in = true;         ///< every part must have found room
  std::size_t escapes = 0;    ///< so many parts must leave the bin, no more, no fewer
  bool spills = false;        ///< parts above the rim may fall off it: `escapes` does not count
  double penetration = 0.02;  ///< largest overlap of a pair, or of a part and the bin / smaller diagonal
  double energy = 0.02;       ///< energy gained / energy put in (drops from start to floor, start velocities)
  double momentum = std::numeric_limits<double>::infinity();  ///< change / sum of |momenta|; same of angular momentum
  double speed = std::numeric_limits<double>::infinity();     ///< m/s that no centre of mass may exceed
  double height = -std::numeric_limits<double>::infinity();   ///< m above which the highest centre must end: it stands
  double ceiling = std::numeric_limits<double>::infinity();   ///< m below which it must end: all have landed
  std::optional<Vec3> side;  ///< first part's centre must end on this side of the second's, in the second's frame
  bool flat = false;         ///< over many scenes: neither bytes in use nor CPU time a scene may grow
  bool traced = true;        ///< false: energy, momentum and speed are not looked at, scenes may run side by side
};

constexpr double stays = 0.02;  ///< displacement / diagonal in 0.5 s beyond which a part called resting was not

struct Case {
  std::string name;  ///< unique within its row
  Request request;
  Expect expect;
  std::map<std::string, Mesh> models;  ///< by file name, written beside the request
};

/// A case that is known to fail, by "solver: case name", and why. Everything else failing is a regression.
using Known = std::map<std::string, std::string>;

/// Causes that more than one theme meets.
inline const char* const trembles = "trembles or creeps by more than rest allows";
inline const char* const restarted =
    "stands when the run goes on; the re-run begins without the contact forces that held it";
inline const char* const impact =
    "an impact turns each body about a lever that is up to a step's displacement off the one it is struck at";

struct Row {
  std::string theme, name;
  std::vector<std::string> solvers;  ///< of "sphere", "sphere/gpu", "bullet", "thesis"
  std::vector<Case> cases;
  Known known;
};

inline const std::vector<std::string> both = {"sphere", "bullet"};
/// Where the passes of `sphere` on OpenGL are cheap enough on a software device: few parts, few steps.
inline const std::vector<std::string> both_forms = {"sphere", "sphere/gpu", "bullet"};

// One file a theme; `soak` asks for the long form. Rows may differ in cases, never in what is expected of a case.
std::vector<Row> mass_ratios(bool soak);
std::vector<Row> stacks(bool soak);
std::vector<Row> time_steps(bool soak);
std::vector<Row> sizes(bool soak);
std::vector<Row> overlaps(bool soak);
std::vector<Row> speeds(bool soak);
std::vector<Row> thin_parts(bool soak);
std::vector<Row> materials(bool soak);
std::vector<Row> bins(bool soak);
std::vector<Row> numbers(bool soak);
std::vector<Row> random_requests(bool soak);

// Words for cases.

inline Case a_case(const std::string& name) {
  Case c;
  c.name = name;
  c.request.seed = 1;
  c.request.pour.limit = 6.0;
  return c;
}
inline Case on_floor(const std::string& name) {
  Case c = a_case(name);
  c.request.bin.kind = Bin::Kind::floor;
  return c;
}
inline Case in_free_flight(const std::string& name) {
  Case c = a_case(name);
  c.request.bin.kind = Bin::Kind::none;
  c.request.gravity.setZero();
  return c;
}

/// Adds a line of parts, `file` naming the mesh in m.
inline PartLine& pour_in(Case& c, const std::string& file, const Mesh& mesh, std::size_t count) {
  c.models[file] = mesh;
  PartLine line;
  line.model = file;
  line.unit = Unit::metre;
  line.count = count;
  c.request.parts.push_back(line);
  return c.request.parts.back();
}
/// Adds a line of parts that start at given places, all of them without a turn.
inline PartLine& put(Case& c, const std::string& file, const Mesh& mesh, const std::vector<Vec3>& places) {
  PartLine& line = pour_in(c, file, mesh, places.size());
  c.request.pour.pattern = Pour::Pattern::given;
  for (const Vec3& place : places) line.poses.push_back({place, Quat::Identity()});
  return line;
}
/// The same velocity for every part of a line.
inline void throw_with(PartLine& line, const Vec3& linear, const Vec3& angular = Vec3::Zero()) {
  line.velocities.assign(line.poses.size(), Twist{linear, angular});
}
inline std::string with(const std::string& text, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return text + buffer;
}

}  // namespace bin_scenes::stress
