/// Ray casting against the true meshes of a scene, shared by all cameras, projectors and lasers. It returns geometry
/// only; what a sensor makes of it is the task of the sensor models.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace bin_scenes {

/// A ray in the bin frame (m). Distances along the ray are in units of its direction, which need not have unit length:
/// with a direction whose z is 1 in an optical frame, they are depths.
struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();  ///< a direction that is not finite hits nothing
  double near = 0.0, far = 1e9;
};

/// The first intersection of a ray with a surface.
struct Hit {
  double distance;         ///< distance in units of the ray's direction; NaN: nothing was hit
  Vec3 normal;             ///< unit normal of the face in the bin frame, towards the origin of the ray
  std::uint16_t label;     ///< id + 1 of the part; 0 for the bin and for nothing
  std::int32_t line;       ///< index into Request::parts; -1 for the bin and for nothing, table_line for the table
  std::uint32_t triangle;  ///< index in the mesh of the part or the bin
  std::uint32_t body = 0;  ///< index of the body in the scenery (Scenery::body())
};

/// The search trees of models. A tree is built once for each model and kept as long as the model lives. May be used by
/// several threads.
class SceneryCache {
 public:
  SceneryCache();
  ~SceneryCache();
  struct State;
  State& state() const { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// All surfaces of a scene that light can reach. They are placed once and serve any number of views and threads. Parts
/// that were not poured, or whose pose is not finite, are left out.
///
/// Embree finds the triangle in single precision; distance and normal are those of the triangle's plane in double
/// precision.
class Scenery {
 public:
  static constexpr std::int32_t table_line = -2;  ///< in place of the index of a part line

  /// Throws an input Error if the id of a part is too large for a 16-bit label.
  Scenery(const Scene& scene, const LoadedRequest& loaded, SceneryCache& cache);
  ~Scenery();
  Scenery(Scenery&&) noexcept;

  /// Whether neighbouring rays have similar directions. It is a hint that influences the speed only.
  enum class Rays { side_by_side, scattered };
  /// Finds the first hit of each of `count` rays.
  void first_hits(const Ray* rays, Hit* hits, std::size_t count, Rays kind = Rays::side_by_side) const;
  /// Returns the hit of a ray on a face that is known already. @param about  approximate distance of the hit
  Hit hit(const Ray& ray, std::uint32_t face, double about) const;
  /// Returns the normal of the smooth surface that the triangles approximate, at a point that was hit: it changes
  /// continuously across edges whose faces differ by less than 35 degrees. It points to the side that was hit.
  Vec3 smooth_normal(const Hit& hit, const Vec3& point) const;
  /// Sets blocked[i] to 1 if a surface is between `near` and `far` of ray i, and to 0 otherwise.
  void blocked(const Ray* rays, std::uint8_t* blocked, std::size_t count, Rays kind = Rays::side_by_side) const;
  /// The same test as if Scene::parts[part] were alone in the scene; all results are 0 if that part is not in the
  /// scene.
  void blocked_by(std::size_t part, const Ray* rays, std::uint8_t* blocked, std::size_t count) const;

  /// The mesh and the pose (bin frame) of Scene::parts[part]; empty if the part is not in the scene.
  struct Placed {
    const Mesh* mesh = nullptr;
    Pose pose;
    int id = -1;
  };
  std::size_t part_count() const;
  Placed part(std::size_t part) const;

  /// The plane of a triangle: its unit normal, and the dot product of the normal with any point of the plane (m).
  struct Plane {
    Vec3 normal;
    double offset;
  };
  /// A placed mesh: a part or the bin.
  struct Body {
    const Mesh* mesh = nullptr;
    const std::vector<Plane>* planes = nullptr;  ///< planes of the triangles, in the frame of the mesh
    bool closed = false;           ///< whether only the front sides of the triangles can be seen from outside
    std::uint32_t first_face = 0;  ///< face number of triangle 0
    Pose pose;
    std::int64_t part = -1;  ///< index into Scene::parts; -1 for the bin
    std::uint16_t label = 0;
    std::int32_t line = -1;
  };
  std::size_t body_count() const;
  Body body(std::size_t body) const;

  /// A face is a triangle of a body. Faces are numbered consecutively over all bodies.
  static constexpr std::uint32_t no_face = ~0u, floor_face = no_face - 1;
  struct Face {
    std::uint32_t body = no_face, triangle = 0;
    Vec3 normal = Vec3::Zero();  ///< outward, bin frame
    bool outermost = false;      ///< whether the whole body is on the inner side of the plane of the face
    bool on_floor = false;
  };
  /// Returns the face with a number; its body is no_face for no_face.
  Face face(std::uint32_t face) const;
  /// Returns the number of the face that a ray hit.
  std::uint32_t face_of(const Hit& hit) const;

  /// The endless plane below everything: the floor at z = 0, or the table. None: there is no such plane.
  std::optional<double> floor_height() const;
  std::int32_t floor_line() const;  ///< Hit::line of that plane

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes
