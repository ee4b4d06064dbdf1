/// The data of a PartModel: its mesh, and the shapes that have been made so far. Each shape is made when it is first
/// requested, once, under a lock of its own; several threads may use one PartModel. This is the private part of
/// part_model.hpp.
#pragma once

#include "bin_scenes/part/part_model.hpp"

#include <map>
#include <mutex>

namespace bin_scenes {

struct PartModel::State {
  std::string path, mesh_key;  // mesh_key: hash of the mesh, the key of everything made from it
  LoadedMesh loaded;
  MassProperties mass;
  double diagonal = 0, radius = 0;

  std::once_flag corners_once;
  std::vector<Vec3> corners;
  std::once_flag query_once;
  std::unique_ptr<MeshQuery> query;

  /// Shapes of one kind, by their options. They are pointers, so that references stay valid while more are added.
  template <class T>
  struct Made {
    std::mutex mutex;
    std::map<std::string, std::unique_ptr<T>> by_options;
  };
  Made<SphereSet> spheres;
  Made<DistanceField> fields;
  Made<ConvexHulls> hulls;
  Made<SampleSet> samples;
};

}  // namespace bin_scenes
