#include "bin_scenes/sensor/scenery.hpp"

#include "bin_scenes/core/error.hpp"
#include "sensor/bin_mesh.hpp"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <string>

namespace bin_scenes {

namespace {

/// One instruction set for every processor: the same bits everywhere. Embree's own setting `threads` stays unset, as
/// it limits the threads of the whole process.
RTCDevice device() {
  static const RTCDevice shared = rtcNewDevice("isa=sse4.2");
  if (!shared) throw environment_error("Embree gives no device", "sensors", "use a processor with SSE 4.2");
  return shared;
}

/// On one thread: how many there are must not decide how a tree is built, and the order of triangles in it decides
/// between two that are hit at the same place.
void commit(RTCScene scene) {
  tbb::task_arena alone(1);
  alone.execute([&] { rtcCommitScene(scene); });
}

void set_transform(RTCGeometry instance, const Pose& pose) {
  const Mat3 turn = pose.orientation.toRotationMatrix();
  float columns[12];
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) columns[3 * c + r] = static_cast<float>(c < 3 ? turn(r, c) : pose.position[r]);
  }
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
}

RTCRay to_embree(const Vec3& origin, const Vec3& direction, double near, double far) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = static_cast<float>(near);
  ray.tfar = static_cast<float>(far);
  ray.mask = ~0u;
  return ray;
}

bool usable(const Ray& ray) {
  return ray.direction.allFinite() && ray.origin.allFinite() && ray.far >= ray.near;
}

/// A mesh and its search tree.
struct Surface {
  PartModelPtr owner;  // none: `own` is the mesh
  Mesh own;
  RTCScene tree = nullptr;

  const Mesh& mesh() const { return owner ? owner->mesh() : own; }

  Surface(PartModelPtr model, Mesh alone) : owner(std::move(model)), own(std::move(alone)) {
    tree = rtcNewScene(device());
    rtcSetSceneFlags(tree, RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
    const Mesh& m = mesh();
    const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                3 * sizeof(float), m.vertices.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), m.triangles.size()));
    if (!corners || !indices) {
      throw environment_error("no memory for the triangles of a mesh", "sensors", "free memory, or use coarser meshes");
    }
    for (const Vec3& v : m.vertices) {
      for (int k = 0; k < 3; ++k) *corners++ = static_cast<float>(v[k]);
    }
    for (const Triangle& t : m.triangles) indices = std::copy(t.begin(), t.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree, geometry);
    rtcReleaseGeometry(geometry);
    commit(tree);
  }
  ~Surface() { rtcReleaseScene(tree); }
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
};
using SurfacePtr = std::shared_ptr<const Surface>;

}  // namespace

struct SceneryCache::State {
  struct Entry {
    std::weak_ptr<const PartModel> model;  // tells a new model at an old address from the one whose tree this is
    SurfacePtr surface;
  };
  std::mutex mutex;
  std::map<const PartModel*, Entry> entries;

  /// The surface must not keep its model alive in here: it aliases the mesh, and the placed scene holds the model.
  SurfacePtr surface_of(const PartModelPtr& model) {
    std::lock_guard<std::mutex> lock(mutex);
    for (auto it = entries.begin(); it != entries.end();) {
      it = it->second.model.expired() ? entries.erase(it) : std::next(it);
    }
    Entry& entry = entries[model.get()];
    if (!entry.surface) {
      const PartModelPtr borrowed(PartModelPtr(), model.get());
      entry = {model, std::make_shared<Surface>(borrowed, Mesh())};
    }
    return entry.surface;
  }
};

SceneryCache::SceneryCache() : state_(std::make_unique<State>()) {}
SceneryCache::~SceneryCache() = default;

struct Scenery::State {
  struct Body {
    SurfacePtr surface;
    PartModelPtr model;
    Pose pose;
    std::uint16_t label = 0;
    std::int32_t line = -1;
    int id = -1;
    Mat3 turn = Mat3::Identity();  // of the pose
  };
  RTCScene scene = nullptr;
  std::vector<Body> bodies;           // by Embree's number of the instance
  std::vector<std::int64_t> of_part;  // index into bodies by index into Scene::parts; -1: not there
  bool floor = false;                 // endless, z = 0

  ~State() {
    if (scene) rtcReleaseScene(scene);
  }

  void add(SurfacePtr surface, PartModelPtr model, const Pose& pose, std::uint16_t label, std::int32_t line, int id) {
    const RTCGeometry instance = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, surface->tree);
    set_transform(instance, pose);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene, instance, static_cast<unsigned>(bodies.size()));
    rtcReleaseGeometry(instance);
    bodies.push_back(
        {std::move(surface), std::move(model), pose, label, line, id, pose.orientation.toRotationMatrix()});
  }

  Hit first_hit(const Ray& ray) const;
  bool blocked(const Ray& ray) const;
};

Scenery::Scenery(const Scene& scene, const Request& request, const std::vector<PartModelPtr>& parts,
                 const PartModelPtr& bin_model, SceneryCache& cache)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.scene = rtcNewScene(device());
  rtcSetSceneFlags(s.scene, RTC_SCENE_FLAG_ROBUST);
  s.floor = request.bin.kind == Bin::Kind::floor;
  if (request.bin.kind == Bin::Kind::mesh && bin_model) {
    s.add(cache.state().surface_of(bin_model), bin_model, request.bin.pose, 0, -1, -1);
  } else if (request.bin.kind == Bin::Kind::box) {
    s.add(std::make_shared<Surface>(nullptr, box_bin_mesh(request.bin)), nullptr, Pose(), 0, -1, -1);
  }
  for (const ScenePart& part : scene.parts) {
    s.of_part.push_back(-1);
    if (part.state == PartState::not_poured || !part.pose.finite()) continue;
    if (part.id < 0 || part.id >= 65535) {
      throw input_error("part " + std::to_string(part.id) + " has no 16-bit label", "sensors",
                        "show at most 65,535 parts in one scene");
    }
    s.of_part.back() = static_cast<std::int64_t>(s.bodies.size());
    const PartModelPtr& model = parts[part.line];
    s.add(cache.state().surface_of(model), model, part.pose, static_cast<std::uint16_t>(part.id + 1),
          static_cast<std::int32_t>(part.line), part.id);
  }
  commit(s.scene);
}

Scenery::~Scenery() = default;
Scenery::Scenery(Scenery&&) noexcept = default;

Hit Scenery::State::first_hit(const Ray& ray) const {
  Hit hit{std::numeric_limits<double>::quiet_NaN(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), 0, -1, 0};
  if (!usable(ray)) return hit;
  double far = ray.far;
  if (floor && ray.direction.z() != 0.0) {
    const double distance = -ray.origin.z() / ray.direction.z();
    if (distance >= ray.near && distance <= far) {
      hit.distance = far = distance;
      hit.normal = ray.direction.z() < 0.0 ? Vec3::UnitZ() : Vec3(-Vec3::UnitZ());
    }
  }
  RTCRayHit query{to_embree(ray.origin, ray.direction, ray.near, far), {}};
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;

  const Body& body = bodies[query.hit.instID[0]];
  const Mesh& mesh = body.surface->mesh();
  const Triangle& corners = mesh.triangles[query.hit.primID];
  const Vec3& a = mesh.vertices[corners[0]];
  const Vec3 normal = body.turn * (mesh.vertices[corners[1]] - a).cross(mesh.vertices[corners[2]] - a);
  const double rise = normal.dot(ray.direction), length = normal.norm();
  hit.distance = normal.dot(body.turn * a + body.pose.position - ray.origin) / rise;
  // Of a triangle seen edge on, the plane says nothing; what single precision found does.
  const double single = query.ray.tfar;
  if (!(std::abs(hit.distance - single) <= 1e-4 * single)) hit.distance = single;
  hit.normal = normal * ((rise > 0.0 ? -1.0 : 1.0) / length);
  hit.label = body.label;
  hit.line = body.line;
  hit.triangle = query.hit.primID;
  return hit;
}

bool Scenery::State::blocked(const Ray& ray) const {
  if (!usable(ray)) return false;
  if (floor) {
    const double distance = -ray.origin.z() / ray.direction.z();
    if (distance >= ray.near && distance <= ray.far) return true;
  }
  RTCRay query = to_embree(ray.origin, ray.direction, ray.near, ray.far);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &query);
  return query.tfar < 0.0f;
}

void Scenery::first_hits(const Ray* rays, Hit* hits, std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) hits[i] = state_->first_hit(rays[i]);
}

void Scenery::blocked(const Ray* rays, std::uint8_t* blocked, std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) blocked[i] = state_->blocked(rays[i]);
}

void Scenery::blocked_by(std::size_t part, const Ray* rays, std::uint8_t* blocked, std::size_t count) const {
  std::fill(blocked, blocked + count, std::uint8_t{0});
  const std::int64_t index = state_->of_part.at(part);
  if (index < 0) return;
  const State::Body& body = state_->bodies[static_cast<std::size_t>(index)];
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const Mat3 back = body.turn.transpose();
  for (std::size_t i = 0; i < count; ++i) {
    if (!usable(rays[i])) continue;
    RTCRay query =
        to_embree(back * (rays[i].origin - body.pose.position), back * rays[i].direction, rays[i].near, rays[i].far);
    rtcOccluded1(body.surface->tree, &context, &query);
    blocked[i] = query.tfar < 0.0f;
  }
}

std::size_t Scenery::part_count() const {
  return state_->of_part.size();
}

Scenery::Placed Scenery::part(std::size_t part) const {
  const std::int64_t index = state_->of_part.at(part);
  if (index < 0) return {};
  const State::Body& body = state_->bodies[static_cast<std::size_t>(index)];
  return {&body.surface->mesh(), body.pose, body.id};
}

}  // namespace bin_scenes
