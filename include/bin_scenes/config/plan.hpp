/// The plan of a data set: a request whose values are drawn again for each heap, and a description of the scenes and
/// files that are made from the heaps. `bin_scenes dataset` reads a plan and makes the data set (src/dataset); this
/// header only reads and draws.
#pragma once

#include "bin_scenes/config/formats.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/types.hpp"
#include "bin_scenes/scene/request.hpp"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// All errors of a plan, each with its line.
class PlanErrors : public Error {
 public:
  explicit PlanErrors(std::vector<Error> all);
  const std::vector<Error>& all() const { return all_; }

 private:
  std::vector<Error> all_;
};

/// A model that may occur in the scenes of a plan. Its BOP object number is its index in Plan::objects plus 1.
struct PlanObject {
  std::string model;   ///< the model file as the plan writes it
  std::string path;    ///< its absolute path
  std::string sha256;  ///< digest of the file
  std::optional<Unit> unit;
  double scale = 1.0;
  std::optional<double> thickness;
  Tessellation tessellation;
  std::string solid;
  /// Symmetries that the plan states, instead of a search on the mesh: axes (model frame) about which the part looks
  /// the same at any angle, and rotations after which it looks the same.
  std::optional<std::vector<Vec3>> continuous;
  std::optional<std::vector<Quat>> discrete;
};
/// Whether a part line refers to this model, read with the same options.
bool is_of(const PlanObject& object, const PartLine& line);

/// Depletion of a heap: it is poured, and then parts are removed step by step. Each state is a scene.
struct Depletion {
  std::size_t steps = 0;  ///< number of scenes of a heap in addition to the first one
  bool by_grasp = false;  ///< true: each step removes one part that the grippers can pick; false: each step removes the
                          ///< highest parts, and their number is drawn
};

/// The number of estimates per image that bop_toolkit keeps for most data sets.
constexpr std::size_t bop_most_estimates = 100;

/// A plan that was read and checked. Drawing from it does not change it.
class Plan {
 public:
  std::uint64_t seed = 0;
  std::size_t heaps = 1;             ///< number of heaps to pour; key `scenes`
  std::size_t attempts = 3;          ///< how often a heap that is not accepted is drawn and poured again at most
  std::vector<std::string> formats;  ///< some of json, pcd, ply, png, bag, mcap, grasps, bop, shards; key `outputs`
  McapProfile mcap = McapProfile::ros1;
  /// BOP visibility. 0: a pixel shows the part that is truly seen there. Otherwise: a part is visible in a pixel if it
  /// is at most this far (m) behind the measured surface. Keys bop.visible and bop.tolerance.
  double tolerance = 0.0;
  BopLayout bop;             ///< keys bop.layout, bop.format, bop.modalities and bop.evaluate
  bool run_lengths = false;  ///< BOP: masks are run lengths in JSON files instead of PNG files; key bop.masks
  /// BOP: an image with more visible parts than this is not a target; 0 means no limit. Key bop.most_targets.
  std::size_t most_targets = 0;
  double most_not_poured = 0.05;  ///< share of the parts of a heap that may find no room; key `not_poured`
  std::size_t shard_size = 1000;  ///< number of images in a shard
  /// Names of splits and their shares of the heaps; empty: all heaps belong to "train".
  std::vector<std::pair<std::string, double>> split;
  Depletion depletion;
  std::vector<PlanObject> objects;
  Request reference;               ///< the request of the plan, before any value is drawn
  std::vector<std::string> notes;  ///< decisions of the reader that the user should know
  std::string text;                ///< the text of the plan file
  /// Digest of everything that determines a heap: the request, the models, and all keys of the plan except `scenes`.
  std::string sha256;

  /// Returns the number of scenes of the data set.
  std::size_t scenes() const { return heaps * (depletion.steps + 1); }
  /// Whether the data set contains files of this format.
  bool wants(const std::string& format) const;
  bool wants_gray() const;  ///< whether an output shows the grey images of range sensors

  using VolumeOf = std::function<double(const PartLine&)>;  ///< returns the volume (m3) of one part of a line
  /// Returns the request of one attempt at one heap, drawn from (seed, heap, attempt) only. Request::first is the index
  /// of the first scene of the heap. Throws an input Error if the drawn values contradict each other.
  Request request(std::size_t heap, std::size_t attempt, const VolumeOf& volume_of) const;
  /// Returns the number of parts to remove before step `step` >= 1 of a depletion.
  std::size_t take(std::size_t heap, std::size_t attempt, std::size_t step) const;

  struct State;
  std::shared_ptr<const State> state;
};

/// Reads a plan, and checks its request with the extreme values of each distribution. Throws PlanErrors.
Plan read_plan(const std::string& path);

}  // namespace bin_scenes
