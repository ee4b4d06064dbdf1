/// The plan of a data set: a request whose values are drawn anew for each heap, and what is made of the heaps.
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

/// Every fault of a plan, each with its line.
class PlanErrors : public Error {
 public:
  explicit PlanErrors(std::vector<Error> all);
  const std::vector<Error>& all() const { return all_; }

 private:
  std::vector<Error> all_;
};

/// A model that scenes of the plan may show. Its place in Plan::objects is its number in BOP's files, less one.
struct PlanObject {
  std::string model;   ///< as the plan writes it
  std::string path;    ///< resolved
  std::string sha256;  ///< of the file
  std::optional<Unit> unit;
  double scale = 1.0;
  std::optional<double> thickness;
  Tessellation tessellation;
  std::string solid;
  /// Axes (model frame) about which the part looks the same at any angle, and rotations after which it does; given by
  /// the plan instead of being looked for on the mesh.
  std::optional<std::vector<Vec3>> continuous;
  std::optional<std::vector<Quat>> discrete;
};
bool is_of(const PlanObject& object, const PartLine& line);

/// A heap is poured, then parts are taken out step by step; each state is a scene.
struct Depletion {
  std::size_t steps = 0;  ///< scenes of a heap beside the first
  bool by_grasp = false;  ///< one part at a time that the grippers can pick; else the highest, as many as are drawn
};

constexpr std::size_t bop_most_estimates = 100;  ///< that bop_toolkit keeps of an image, of most data sets

class Plan {
 public:
  std::uint64_t seed = 0;
  std::size_t heaps = 1;             ///< to pour; key `scenes`
  std::size_t attempts = 3;          ///< for a heap: one that is not accepted is drawn and poured anew so many times
  std::vector<std::string> formats;  ///< of json, pcd, ply, png, bag, mcap, grasps, bop, shards; key `outputs`
  McapProfile mcap = McapProfile::ros1;
  /// bop: 0: a pixel shows the part that is truly seen there; else m behind the measured surface up to which a part is
  /// visible. Keys bop.visible and bop.tolerance.
  double tolerance = 0.0;
  BopLayout bop;                  ///< keys bop.layout, format, modalities and evaluate
  bool run_lengths = false;       ///< bop: masks are run lengths in JSON files instead of PNG files; key bop.masks
  std::size_t most_targets = 0;   ///< bop: visible parts of an image that is a target, 0: any; key bop.most_targets
  double most_not_poured = 0.05;  ///< share of a heap's parts that may find no room; key `not_poured`
  std::size_t shard_size = 1000;  ///< images in a shard
  std::vector<std::pair<std::string, double>> split;  ///< name and share of heaps; empty: all are of "train"
  Depletion depletion;
  std::vector<PlanObject> objects;
  Request reference;               ///< the template, nothing drawn
  std::vector<std::string> notes;  ///< what the reader decided and its user should know
  std::string text;                ///< of the file
  std::string sha256;              ///< of everything that decides a heap: keys but `scenes`, template and models

  std::size_t scenes() const { return heaps * (depletion.steps + 1); }
  bool wants(const std::string& format) const;

  using VolumeOf = std::function<double(const PartLine&)>;  ///< m3, of one part
  /// Request of one attempt at one heap, drawn from (seed, heap, attempt) alone; Request::first is its first scene.
  /// Throws an input Error if the values drawn do not go together.
  Request request(std::size_t heap, std::size_t attempt, const VolumeOf& volume_of) const;
  /// Number of parts to take out before step `step` >= 1 of a depletion.
  std::size_t take(std::size_t heap, std::size_t attempt, std::size_t step) const;

  /// What is drawn, for people: path and distribution as the plan writes them.
  std::vector<std::pair<std::string, std::string>> drawn() const;

  struct State;
  std::shared_ptr<const State> state;
};

/// Reads a plan and tries the ends of each distribution on its request. Throws PlanErrors.
Plan read_plan(const std::string& path);

}  // namespace bin_scenes
