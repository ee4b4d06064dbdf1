/// One Embree scene of instances of the parts' trees. Embree names the triangle; distance and normal are computed in
/// double.
#include "bin_scenes/raster/scenery.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/mesh/bin_mesh.hpp"
#include "raster/scenery_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <string>

namespace bin_scenes {

namespace {

void set_transform(RTCGeometry instance, const Pose& pose) {
  const Mat3 turn = pose.orientation.toRotationMatrix();
  float columns[12];
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) columns[3 * c + r] = static_cast<float>(c < 3 ? turn(r, c) : pose.position[r]);
  }
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
}

/// Rays go to Embree in eights, the width of AVX2: neighbours share most of the path through the tree.
constexpr int lanes = 8;

bool usable(const Ray& ray) {
  return ray.direction.allFinite() && ray.origin.allFinite() && ray.far >= ray.near;
}

/// Fills one lane; says whether it holds a ray.
int set_lane(RTCRay8& packet, int lane, const Ray& ray) {
  packet.org_x[lane] = static_cast<float>(ray.origin.x());
  packet.org_y[lane] = static_cast<float>(ray.origin.y());
  packet.org_z[lane] = static_cast<float>(ray.origin.z());
  packet.dir_x[lane] = static_cast<float>(ray.direction.x());
  packet.dir_y[lane] = static_cast<float>(ray.direction.y());
  packet.dir_z[lane] = static_cast<float>(ray.direction.z());
  packet.tnear[lane] = static_cast<float>(ray.near);
  packet.tfar[lane] = static_cast<float>(ray.far);
  packet.time[lane] = 0.0f;
  packet.mask[lane] = ~0u;
  packet.id[lane] = packet.flags[lane] = 0;
  return usable(ray) ? -1 : 0;
}

RTCIntersectContext context_of(Scenery::Rays kind) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const bool scattered = kind == Scenery::Rays::scattered;
  context.flags = scattered ? RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT : RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

/// blocked[i] for rays that `ray_of(i)` gives.
template <class RayOf>
void occluded(RTCScene scene, const RayOf& ray_of, std::uint8_t* blocked, std::size_t count, Scenery::Rays kind) {
  RTCIntersectContext context = context_of(kind);
  for (std::size_t first = 0; first < count; first += lanes) {
    RTCRay8 packet;
    int valid[lanes];
    for (int lane = 0; lane < lanes; ++lane) {
      const std::size_t i = first + static_cast<std::size_t>(lane);
      valid[lane] = set_lane(packet, lane, ray_of(i < count ? i : first));
      if (i >= count) valid[lane] = 0;
    }
    rtcOccluded8(valid, scene, &context, &packet);
    for (int lane = 0; lane < lanes; ++lane) {
      const std::size_t i = first + static_cast<std::size_t>(lane);
      if (i < count) blocked[i] = valid[lane] && packet.tfar[lane] < 0.0f;
    }
  }
}

}  // namespace

struct SceneryCache::State {
  struct Entry {
    std::weak_ptr<const PartModel>
        model;  // distinguishes a new model at an old address from the one whose tree this is
    MeshTreePtr tree;
  };
  std::mutex mutex;
  std::map<const PartModel*, Entry> entries;

  /// The tree must not keep its model alive in here: it aliases the mesh, and the placed scene holds the model.
  MeshTreePtr tree_of(const PartModelPtr& model) {
    std::lock_guard<std::mutex> lock(mutex);
    for (auto it = entries.begin(); it != entries.end();) {
      it = it->second.model.expired() ? entries.erase(it) : std::next(it);
    }
    Entry& entry = entries[model.get()];
    if (!entry.tree) {
      const PartModelPtr borrowed(PartModelPtr(), model.get());
      entry = {model, std::make_shared<MeshTree>(borrowed, Mesh())};
    }
    return entry.tree;
  }
};

SceneryCache::SceneryCache() : state_(std::make_unique<State>()) {}
SceneryCache::~SceneryCache() = default;

struct Scenery::State {
  struct Body {
    MeshTreePtr tree;
    PartModelPtr model;
    Pose pose;
    std::uint16_t label = 0;
    std::int32_t line = -1;
    int id = -1;
    std::int64_t part = -1;  // index into Scene::parts
    std::uint32_t first_face = 0;
    Mat3 turn = Mat3::Identity();  // of the pose
  };
  RTCScene scene = nullptr;
  std::vector<Body> bodies;  // by Embree's number of the instance
  static constexpr std::uint32_t faces_a_step = 64;
  std::vector<std::uint32_t> body_at;  // of each 64th face
  std::vector<std::int64_t> of_part;   // index into bodies by index into Scene::parts; -1: not there
  std::optional<double> floor;         // z of an endless plane
  std::int32_t floor_line = -1;
  static constexpr std::uint32_t of_the_floor = ~0u;  // Hit::body

  ~State() {
    if (scene) rtcReleaseScene(scene);
  }

  void add(MeshTreePtr tree, PartModelPtr model, const Pose& pose, std::uint16_t label, std::int32_t line, int id) {
    const auto first_face =
        bodies.empty() ? 0 : bodies.back().first_face + static_cast<std::uint32_t>(bodies.back().tree->planes.size());
    const std::int64_t part = label ? static_cast<std::int64_t>(of_part.size()) - 1 : -1;
    BIN_SCENES_ASSERT(is_rigid(pose));
    const RTCGeometry instance = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, tree->embree);
    set_transform(instance, pose);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene, instance, static_cast<unsigned>(bodies.size()));
    rtcReleaseGeometry(instance);
    const auto number = static_cast<std::uint32_t>(bodies.size());
    const std::size_t end = first_face + tree->planes.size();
    while (body_at.size() * faces_a_step < end) body_at.push_back(number);
    Body body;
    body.tree = std::move(tree);
    body.model = std::move(model);
    body.pose = pose;
    body.label = label;
    body.line = line;
    body.id = id;
    body.part = part;
    body.first_face = first_face;
    body.turn = pose.orientation.toRotationMatrix();
    bodies.push_back(std::move(body));
  }

  bool hits_floor(const Ray& ray) const { return floor && usable(ray) && within(ray, floor_distance(ray)); }
  double floor_distance(const Ray& ray) const { return (*floor - ray.origin.z()) / ray.direction.z(); }  // may be NaN
  static bool within(const Ray& ray, double distance) { return distance >= ray.near && distance <= ray.far; }
  Hit hit_of(const Ray& ray, std::uint32_t body, std::uint32_t triangle, double about) const;
  Hit floor_hit(const Ray& ray) const;
  /// Number of the body whose face it is; none: no body has it.
  std::uint32_t body_of(std::uint32_t face) const;
};

Scenery::Scenery(const Scene& scene, const LoadedRequest& loaded, SceneryCache& cache)
    : state_(std::make_unique<State>()) {
  const Bin& bin = loaded.request.bin;
  State& s = *state_;
  s.scene = rtcNewScene(embree_device());
  rtcSetSceneFlags(s.scene, RTC_SCENE_FLAG_ROBUST);
  s.floor = loaded.request.table.height;
  s.floor_line = table_line;
  if (bin.kind == Bin::Kind::floor) s.floor = 0.0, s.floor_line = -1;
  if (bin.kind == Bin::Kind::mesh && loaded.bin_model) {
    s.add(cache.state().tree_of(loaded.bin_model), loaded.bin_model, bin.pose, 0, -1, -1);
  } else if (bin.kind == Bin::Kind::box) {
    s.add(std::make_shared<MeshTree>(nullptr, box_bin_mesh(bin)), nullptr, Pose(), 0, -1, -1);
  }
  for (const ScenePart& part : scene.parts) {
    s.of_part.push_back(-1);
    if (!is_there(part.state) || !part.pose.finite()) continue;
    if (part.id < 0 || part.id >= 65535) {
      throw input_error("part " + std::to_string(part.id) + " has no 16-bit label", "sensors",
                        "show at most 65,535 parts in one scene");
    }
    s.of_part.back() = static_cast<std::int64_t>(s.bodies.size());
    BIN_SCENES_ASSERT(part.line < loaded.parts.size());
    const PartModelPtr& model = loaded.parts[part.line];
    s.add(cache.state().tree_of(model), model, part.pose, static_cast<std::uint16_t>(part.id + 1),
          static_cast<std::int32_t>(part.line), part.id);
  }
  commit(s.scene);
}

Scenery::~Scenery() = default;
Scenery::Scenery(Scenery&&) noexcept = default;

/// Distance and normal from the triangle's plane.
Hit Scenery::State::hit_of(const Ray& ray, std::uint32_t number, std::uint32_t triangle, double about) const {
  Hit hit;
  const Body& body = bodies[number];
  hit.triangle = triangle;
  const Plane& plane = body.tree->planes[hit.triangle];
  const Vec3 normal = body.turn * plane.normal;
  const double rise = normal.dot(ray.direction);
  hit.distance = (plane.offset + normal.dot(body.pose.position - ray.origin)) / rise;
  // Of a triangle seen edge on, the plane says nothing; what single precision found does.
  if (!(std::abs(hit.distance - about) <= 1e-4 * about)) hit.distance = about;
  hit.normal = rise > 0.0 ? Vec3(-normal) : normal;
  hit.label = body.label;
  hit.line = body.line;
  hit.body = number;
  return hit;
}

Hit Scenery::State::floor_hit(const Ray& ray) const {
  return {floor_distance(ray), ray.direction.z() < 0.0 ? Vec3::UnitZ() : Vec3(-Vec3::UnitZ()), 0, floor_line, 0,
          of_the_floor};
}

std::uint32_t Scenery::State::body_of(std::uint32_t face) const {
  std::uint32_t number = body_at[face / faces_a_step];
  while (number + 1 < bodies.size() && bodies[number + 1].first_face <= face) ++number;
  return number;
}

Hit Scenery::hit(const Ray& ray, std::uint32_t face, double about) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (face == no_face) return {nan, Vec3::Constant(nan), 0, -1, 0, State::of_the_floor};
  if (face == floor_face) return state_->floor_hit(ray);
  const std::uint32_t body = state_->body_of(face);
  return state_->hit_of(ray, body, face - state_->bodies[body].first_face, about);
}

Vec3 Scenery::smooth_normal(const Hit& hit, const Vec3& point) const {
  const bool of_floor = state_->bodies.empty() || hit.body == State::of_the_floor;
  if (of_floor) return hit.normal;
  const State::Body& body = state_->bodies[hit.body];
  const SmoothNormals& smooth = body.tree->smooth_normals()[hit.triangle];
  if (smooth.even) return hit.normal;
  const Vec3 here = body.turn.transpose() * (point - body.pose.position);
  const Vec3 normal = (body.turn * smooth.at(here)).normalized();
  return normal.dot(hit.normal) < 0.0 ? Vec3(-normal) : normal;
}

void Scenery::first_hits(const Ray* rays, Hit* hits, std::size_t count, Rays kind) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  RTCIntersectContext context = context_of(kind);
  for (std::size_t first = 0; first < count; first += lanes) {
    RTCRayHit8 packet;
    int valid[lanes];
    for (int lane = 0; lane < lanes; ++lane) {
      const std::size_t i = first + static_cast<std::size_t>(lane);
      valid[lane] = set_lane(packet.ray, lane, rays[i < count ? i : first]);
      packet.hit.geomID[lane] = packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
      if (i >= count) {
        valid[lane] = 0;
        continue;
      }
      hits[i] = hit(rays[i], no_face, nan);
      if (!state_->hits_floor(rays[i])) continue;
      hits[i] = state_->floor_hit(rays[i]);
      packet.ray.tfar[lane] = static_cast<float>(hits[i].distance);
    }
    rtcIntersect8(valid, state_->scene, &context, &packet);
    for (int lane = 0; lane < lanes; ++lane) {
      if (!valid[lane] || packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
      const std::size_t i = first + static_cast<std::size_t>(lane);
      hits[i] = state_->hit_of(rays[i], packet.hit.instID[0][lane], packet.hit.primID[lane], packet.ray.tfar[lane]);
    }
  }
}

void Scenery::blocked(const Ray* rays, std::uint8_t* blocked, std::size_t count, Rays kind) const {
  occluded(
      state_->scene, [&](std::size_t i) { return rays[i]; }, blocked, count, kind);
  for (std::size_t i = 0; state_->floor && i < count; ++i) blocked[i] |= state_->hits_floor(rays[i]);
}

void Scenery::blocked_by(std::size_t part, const Ray* rays, std::uint8_t* blocked, std::size_t count) const {
  const std::int64_t index = state_->of_part.at(part);
  if (index < 0) {
    std::fill(blocked, blocked + count, std::uint8_t{0});
    return;
  }
  const State::Body& body = state_->bodies[static_cast<std::size_t>(index)];
  const Mat3 back = body.turn.transpose();
  const auto in_part = [&](std::size_t i) {
    const Ray& ray = rays[i];
    return Ray{back * (ray.origin - body.pose.position), back * ray.direction, ray.near, ray.far};
  };
  occluded(body.tree->embree, in_part, blocked, count, Rays::side_by_side);
}

std::size_t Scenery::part_count() const {
  return state_->of_part.size();
}

Scenery::Placed Scenery::part(std::size_t part) const {
  const std::int64_t index = state_->of_part.at(part);
  if (index < 0) return {};
  const State::Body& body = state_->bodies[static_cast<std::size_t>(index)];
  return {&body.tree->mesh(), body.pose, body.id};
}

std::size_t Scenery::body_count() const {
  return state_->bodies.size();
}

Scenery::Body Scenery::body(std::size_t index) const {
  const State::Body& body = state_->bodies.at(index);
  Body out;
  out.mesh = &body.tree->mesh();
  out.planes = &body.tree->planes;
  out.closed = body.tree->closed;
  out.first_face = body.first_face;
  out.pose = body.pose;
  out.part = body.part;
  out.label = body.label;
  out.line = body.line;
  return out;
}

Scenery::Face Scenery::face(std::uint32_t face) const {
  if (face >= floor_face) return {no_face, 0, Vec3::Zero(), false, face == floor_face};
  const std::uint32_t number = state_->body_of(face);
  const State::Body& body = state_->bodies[number];
  const std::uint32_t triangle = face - body.first_face;
  return {number, triangle, body.turn * body.tree->planes[triangle].normal, body.tree->outermost[triangle] != 0};
}

std::uint32_t Scenery::face_of(const Hit& hit) const {
  if (std::isnan(hit.distance)) return no_face;
  return hit.body == State::of_the_floor ? floor_face : state_->bodies[hit.body].first_face + hit.triangle;
}

std::optional<double> Scenery::floor_height() const {
  return state_->floor;
}

std::int32_t Scenery::floor_line() const {
  return state_->floor_line;
}

}  // namespace bin_scenes
