#include "bin_scenes/sensor/range_camera.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/program.hpp"
#include "bin_scenes/gl/raster.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace bin_scenes {

namespace {

std::vector<float> corners_of(const Mesh& mesh) {
  std::vector<float> corners;
  corners.reserve(18 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 normal = mesh.area_vector(t).normalized();
    for (const std::uint32_t v : mesh.triangles[t]) {
      for (int k = 0; k < 3; ++k) corners.push_back(static_cast<float>(mesh.vertices[v][k]));
      for (int k = 0; k < 3; ++k) corners.push_back(static_cast<float>(normal[k]));
    }
  }
  return corners;
}

/// Optical frame -> clip. Row v of the image is row v of the framebuffer, whose pixel centres lie at +0.5; depth runs
/// from 1 at `near` to 0 at `far`, which spends a float's precision evenly over the range.
void set_projection(const gl::Program& program, const Sensor& s) {
  const double w = s.width, h = s.height, range = s.far - s.near;
  const double rows[4][4] = {{2.0 * s.k[0] / w, 2.0 * s.k[1] / w, (2.0 * s.k[2] + 1.0) / w - 1.0, 0.0},
                             {0.0, 2.0 * s.k[4] / h, (2.0 * s.k[5] + 1.0) / h - 1.0, 0.0},
                             {0.0, 0.0, -s.near / range, s.near * s.far / range},
                             {0.0, 0.0, 1.0, 0.0}};
  float matrix[16];
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) matrix[4 * c + r] = static_cast<float>(rows[r][c]);
  }
  program.set("projection", matrix);
}

void set_pose(const gl::Program& program, const Pose& pose) {
  const Mat3 turn = pose.orientation.toRotationMatrix();
  float matrix[16] = {};
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) matrix[4 * c + r] = static_cast<float>(turn(r, c));
    matrix[12 + c] = static_cast<float>(pose.position[c]);
  }
  matrix[15] = 1.0f;
  program.set("model_view", matrix);
}

void append_box(Mesh& mesh, const Vec3& lower, const Vec3& upper) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1 ? upper : lower).x(), (i & 2 ? upper : lower).y(), (i & 4 ? upper : lower).z());
  }
  for (const Triangle& t : {Triangle{0, 2, 3}, Triangle{0, 3, 1}, Triangle{4, 5, 7}, Triangle{4, 7, 6},
                            Triangle{0, 1, 5}, Triangle{0, 5, 4}, Triangle{2, 6, 7}, Triangle{2, 7, 3},
                            Triangle{0, 4, 6}, Triangle{0, 6, 2}, Triangle{1, 3, 7}, Triangle{1, 7, 5}}) {
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
}

/// Floor and walls of an analytic bin; an endless floor reaches as far as the sensor sees.
Mesh bin_mesh(const Bin& bin, const Sensor& sensor) {
  Mesh mesh;
  if (bin.kind == Bin::Kind::floor) {
    const Vec3& eye = sensor.pose->position;
    // Beyond this every ray has left the range, whatever the opening of the lens.
    const double corner = std::hypot(sensor.width / sensor.k[0], sensor.height / sensor.k[4], 1.0);
    const double reach = sensor.far * corner;
    mesh.vertices = {{eye.x() - reach, eye.y() - reach, 0.0},
                     {eye.x() + reach, eye.y() - reach, 0.0},
                     {eye.x() + reach, eye.y() + reach, 0.0},
                     {eye.x() - reach, eye.y() + reach, 0.0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  } else if (bin.kind == Bin::Kind::box) {
    const double x = 0.5 * bin.inner_size.x(), y = 0.5 * bin.inner_size.y(), z = bin.inner_size.z(),
                 t = bin.wall_thickness;
    append_box(mesh, {-x - t, -y - t, -t}, {x + t, y + t, 0.0});
    append_box(mesh, {-x - t, -y - t, 0.0}, {-x, y + t, z});
    append_box(mesh, {x, -y - t, 0.0}, {x + t, y + t, z});
    append_box(mesh, {-x, -y - t, 0.0}, {x, -y, z});
    append_box(mesh, {-x, y, 0.0}, {x, y + t, z});
  }
  return mesh;
}

}  // namespace

struct RangeCamera::State {
  gl::Device& device = gl::Device::current();
  gl::Program program = gl::Program::graphics("sensor/range.vert", "sensor/range.frag");
  struct Entry {
    std::weak_ptr<const PartModel> model;  // tells a new model at an old address from the one that was uploaded
    std::unique_ptr<gl::Triangles> surface;
  };
  std::map<const PartModel*, Entry> surfaces;

  const gl::Triangles& surface_of(const PartModelPtr& model) {
    Entry& entry = surfaces[model.get()];
    if (entry.model.lock() != model) entry = {model, std::make_unique<gl::Triangles>(corners_of(model->mesh()))};
    return *entry.surface;
  }

  RangeImage render(const Scene& scene, const Sensor& sensor, const Bin& bin, const std::vector<PartModelPtr>& parts,
                    const PartModelPtr& bin_model);
  std::vector<std::vector<bool>> silhouettes(const Scene& scene, const Sensor& sensor,
                                             const std::vector<PartModelPtr>& parts);
};

namespace {

bool present(const ScenePart& part) {
  return is_there(part.state) && part.pose.finite();
}

}  // namespace

RangeCamera::RangeCamera() : state_(std::make_unique<State>()) {}
RangeCamera::~RangeCamera() {
  state_->device.make_current();
}

RangeImage RangeCamera::State::render(const Scene& scene, const Sensor& sensor, const Bin& bin,
                                      const std::vector<PartModelPtr>& parts, const PartModelPtr& bin_model) {
  RangeImage image;
  image.sensor = sensor;
  const Pose view = sensor.pose->inverse();
  using Channel = gl::Target::Channel;
  gl::Target target(sensor.width, sensor.height, {Channel::float1, Channel::uint16, Channel::float4});
  target.begin();
  program.use();
  set_projection(program, sensor);

  program.set("label", 0u);
  if (bin.kind == Bin::Kind::mesh && bin_model) {
    set_pose(program, view * bin.pose);
    surface_of(bin_model).draw();
  } else if (const Mesh mesh = bin_mesh(bin, sensor); !mesh.empty()) {
    set_pose(program, view);
    gl::Triangles(corners_of(mesh)).draw();
  }
  for (const ScenePart& part : scene.parts) {
    if (!present(part)) continue;
    program.set("label", static_cast<unsigned>(part.id) + 1u);
    set_pose(program, view * part.pose);
    surface_of(parts[part.line]).draw();
  }

  const std::size_t pixels = static_cast<std::size_t>(sensor.width) * sensor.height;
  image.depth.resize(pixels);
  image.label.resize(pixels);
  std::vector<std::array<float, 4>> normals(pixels);
  target.read(0, image.depth.data());
  target.read(1, image.label.data());
  target.read(2, normals.front().data());
  for (const auto& [x, y, z, cosine] : normals) {
    image.normal.push_back({x, y, z});
    image.intensity.push_back(std::isnan(cosine) ? 0.0f : cosine);
  }

  int largest = -1;
  for (const ScenePart& part : scene.parts) largest = std::max(largest, part.id);
  image.visible.assign(static_cast<std::size_t>(largest + 1), 0);
  image.total = image.visible;
  for (const std::uint16_t label : image.label) {
    if (label) ++image.visible[label - 1u];
  }

  // The same once more with every part as if it were alone.
  target.begin_counting();
  for (const ScenePart& part : scene.parts) {
    if (!present(part)) continue;
    set_pose(program, view * part.pose);
    target.count([&] { surface_of(parts[part.line]).draw(); });
  }
  const std::vector<std::size_t> alone = target.counts();
  std::size_t next = 0;
  for (const ScenePart& part : scene.parts) {
    if (present(part)) image.total[static_cast<std::size_t>(part.id)] = alone[next++];
  }
  return image;
}

/// By part id.
std::vector<std::vector<bool>> RangeCamera::State::silhouettes(const Scene& scene, const Sensor& sensor,
                                                               const std::vector<PartModelPtr>& parts) {
  const Pose view = sensor.pose->inverse();
  gl::Target target(sensor.width, sensor.height, {gl::Target::Channel::float1, gl::Target::Channel::uint16});
  std::vector<std::uint16_t> labels(static_cast<std::size_t>(sensor.width) * sensor.height);
  std::vector<std::vector<bool>> all;
  for (const ScenePart& part : scene.parts) {
    const auto id = static_cast<std::size_t>(part.id);
    if (id >= all.size()) all.resize(id + 1);
    if (!present(part)) continue;
    target.begin();
    program.use();
    set_projection(program, sensor);
    program.set("label", 1u);
    set_pose(program, view * part.pose);
    surface_of(parts[part.line]).draw();
    target.read(1, labels.data());
    all[id].assign(labels.begin(), labels.end());
  }
  return all;
}

std::vector<RangeImage> RangeCamera::render(const Scene& scene, const Request& request,
                                            const std::vector<PartModelPtr>& parts, const PartModelPtr& bin_model,
                                            bool silhouettes) {
  for (const ScenePart& part : scene.parts) {
    if (part.id < 0 || part.id >= 65535) {
      throw input_error("part " + std::to_string(part.id) + " has no 16-bit label", "sensors",
                        "render at most 65,535 parts in one scene");
    }
  }
  state_->device.make_current();
  for (auto it = state_->surfaces.begin(); it != state_->surfaces.end();) {
    it = it->second.model.expired() ? state_->surfaces.erase(it) : std::next(it);
  }
  Aabb bounds;
  if (bin_model) {
    for (const Vec3& v : bin_model->mesh().vertices) bounds.extend(request.bin.pose * v);
  }
  std::vector<RangeImage> images;
  for (const Sensor& sensor : request.sensors) {
    const Sensor full = resolved(sensor, request.bin, bin_model ? &bounds : nullptr);
    images.push_back(state_->render(scene, full, request.bin, parts, bin_model));
    if (silhouettes) images.back().silhouette = state_->silhouettes(scene, full, parts);
  }
  return images;
}

}  // namespace bin_scenes
