/// Ray casting against the true meshes of a scene, shared by all cameras, projectors and lasers.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace bin_scenes {

/// A ray in the bin frame (m). Distances along the ray are in units of its direction, which need not have unit length:
/// with a direction of z = 1 in an optical frame they are depths.
struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();  ///< not finite: hits nothing
  double near = 0.0, far = 1e9;
};

struct Hit {
  double distance;         ///< in units of the direction; NaN: nothing was hit
  Vec3 normal;             ///< of the face hit, unit, bin frame, towards the ray's origin
  std::uint16_t label;     ///< 0 of the bin and of nothing, id + 1 of a part
  std::int32_t line;       ///< index into Request::parts; -1 of the bin and of nothing
  std::uint32_t triangle;  ///< of the part's or bin's mesh
  std::uint32_t body = 0;  ///< of Scenery's own numbers
};

/// The search trees of models. A tree is made once for each model and kept while the model lives. Thread-safe.
class SceneryCache {
 public:
  SceneryCache();
  ~SceneryCache();
  struct State;
  State& state() const { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// All surfaces of a scene that light can meet. They are placed once and serve any number of views and threads. Parts
/// that were not poured, or whose pose is not finite, are left out.
///
/// Embree finds the triangle in single precision; distance and normal are those of the triangle's plane in double.
class Scenery {
 public:
  /// Throws an input Error if a part's id has no 16-bit label.
  Scenery(const Scene& scene, const LoadedRequest& loaded, SceneryCache& cache);
  ~Scenery();
  Scenery(Scenery&&) noexcept;

  /// Whether neighbouring rays have similar directions; a hint that changes the speed only.
  enum class Rays { side_by_side, scattered };
  /// First hit of each of `count` rays.
  void first_hits(const Ray* rays, Hit* hits, std::size_t count, Rays kind = Rays::side_by_side) const;
  /// The hit of a ray on a face that is known already. @param about  approximate distance of the hit
  Hit hit(const Ray& ray, std::uint32_t face, double about) const;
  /// Normal at a point that was hit, of the surface that the triangles stand for: it turns evenly across edges at which
  /// faces meet in less than 35 degrees. Towards the side that was hit.
  Vec3 smooth_normal(const Hit& hit, const Vec3& point) const;
  /// blocked[i] = 1 if anything lies between `near` and `far` of ray i, else 0.
  void blocked(const Ray* rays, std::uint8_t* blocked, std::size_t count, Rays kind = Rays::side_by_side) const;
  /// The same as if Scene::parts[part] were alone in the scene; all 0 if that part is not in the scene.
  void blocked_by(std::size_t part, const Ray* rays, std::uint8_t* blocked, std::size_t count) const;

  /// Mesh and pose (bin frame) of Scene::parts[part]; empty if the part is not in the scene.
  struct Placed {
    const Mesh* mesh = nullptr;
    Pose pose;
    int id = -1;
  };
  std::size_t part_count() const;
  Placed part(std::size_t part) const;

  /// The plane of a triangle: unit normal, and its product with any point.
  struct Plane {
    Vec3 normal;
    double offset;
  };
  /// One placed mesh: a part or the bin.
  struct Body {
    const Mesh* mesh = nullptr;
    const std::vector<Plane>* planes = nullptr;  ///< of the mesh's triangles, in its frame
    bool closed = false;                         ///< from outside only the fronts of triangles are visible
    std::uint32_t first_face = 0;                ///< that of its triangle 0
    Pose pose;
    std::int64_t part = -1;  ///< index into Scene::parts; -1: the bin
    std::uint16_t label = 0;
    std::int32_t line = -1;
  };
  std::size_t body_count() const;
  Body body(std::size_t body) const;

  /// Faces number the triangles of all bodies consecutively, body after body.
  static constexpr std::uint32_t no_face = ~0u, floor_face = no_face - 1;
  struct Face {
    std::uint32_t body = no_face, triangle = 0;
    Vec3 normal = Vec3::Zero();  ///< outward, bin frame
    bool outermost = false;      ///< all of the body lies behind its plane
    bool on_floor = false;
  };
  Face face(std::uint32_t face) const;
  /// The face that a ray hit.
  std::uint32_t face_of(const Hit& hit) const;

  /// Whether an endless floor lies at z = 0.
  bool on_floor() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes
