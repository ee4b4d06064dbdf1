/// An example of a consumer, to begin a pipeline with: PCL's ICP registers each labelled segment of the cloud with the
/// model of its part, and the pose that comes out is compared with the true one on TF.
///
///     points   ─► one cloud a label ──────┐
///     markers  ─► points on the model ────┼─► ICP ─► TF frame icp_<part>, and a line of the log
///     scene,   ─► a displaced first guess ┘
///     /tf
///
/// A real pipeline has segments and first guesses of its own; the truth shows how good they are.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/sha256.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "messages.hpp"

#include <pcl/point_types.h>
#include <pcl/registration/correspondence_rejection_surface_normal.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/transformation_estimation_point_to_plane_lls.h>
#include <pcl_conversions/pcl_conversions.h>
#include <resource_retriever/retriever.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

/// The fields of the cloud that are used here, under the names that they have there.
struct LabelledPoint {
  PCL_ADD_POINT4D;
  PCL_ADD_NORMAL4D;
  std::uint32_t label;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
POINT_CLOUD_REGISTER_POINT_STRUCT(LabelledPoint, (float, x, x)(float, y, y)(float, z, z)(float, normal_x, normal_x)(
                                                     float, normal_y, normal_y)(float, normal_z,
                                                                                normal_z)(std::uint32_t, label, label))

namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Icp = pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal>;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::size_t model_points = 20000;
constexpr int rounds = 100;
constexpr double reach = 0.004;         // m: correspondences are no longer than this
constexpr double largest_angle = 45.0;  // degrees between the two normals of a correspondence

Cloud::PointType point(const Vector3d& position, const Vector3d& normal) {
  pcl::PointNormal point;
  point.getVector3fMap() = position.cast<float>();
  point.getNormalVector3fMap() = normal.cast<float>();
  return point;
}

Isometry3d pose_of(const geometry_msgs::Transform& t) {
  return Eigen::Translation3d(t.translation.x, t.translation.y, t.translation.z) *
         Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z);
}

geometry_msgs::Transform transform_of(const Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.rotation());
  geometry_msgs::Transform t;
  t.translation.x = pose.translation().x();
  t.translation.y = pose.translation().y();
  t.translation.z = pose.translation().z();
  t.rotation.x = q.x();
  t.rotation.y = q.y();
  t.rotation.z = q.z();
  t.rotation.w = q.w();
  return t;
}

bin_scenes::Mesh mesh_of(const std::vector<geometry_msgs::Point>& corners) {
  bin_scenes::Mesh mesh;
  for (const geometry_msgs::Point& p : corners) mesh.vertices.emplace_back(p.x, p.y, p.z);
  for (std::uint32_t v = 0; v + 2 < mesh.vertices.size(); v += 3) mesh.triangles.push_back({v, v + 1, v + 2});
  return mesh;
}

/// The mesh that a marker shows, in metres.
bin_scenes::Mesh mesh_of(const visualization_msgs::Marker& marker) {
  if (marker.type == visualization_msgs::Marker::TRIANGLE_LIST) return mesh_of(marker.points);
  const resource_retriever::MemoryResource file = resource_retriever::Retriever().get(marker.mesh_resource);
  const std::string bytes(reinterpret_cast<const char*>(file.data.get()), file.size);
  bin_scenes::LoadOptions options;
  options.scale = marker.scale.x;
  return bin_scenes::load_mesh({marker.mesh_resource, bytes, bin_scenes::sha256_hex(bytes)}, options).mesh;
}

/// Points spread evenly over the surface of a mesh, with its normals.
Cloud::Ptr sampled(const bin_scenes::Mesh& mesh) {
  std::vector<double> area_until;  // of the triangles up to this one
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area_until.push_back(area += mesh.area_vector(t).norm());
  std::mt19937 random;
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto cloud = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < model_points; ++i) {
    const auto found = std::upper_bound(area_until.begin(), area_until.end() - 1, share(random) * area);
    const auto t = static_cast<std::size_t>(found - area_until.begin());
    const auto& [a, b, c] = mesh.triangles[t];
    const double r = std::sqrt(share(random)), s = share(random);
    const Vector3d at = (1.0 - r) * mesh.vertices[a] + r * (1.0 - s) * mesh.vertices[b] + r * s * mesh.vertices[c];
    cloud->push_back(point(at, mesh.area_vector(t).normalized()));
  }
  return cloud;
}

/// PCL's step of ICP, which divides by zero where correspondences leave a motion open (few points, a round part), and
/// whose search trees abort over what comes out. Such a step is none, and is remembered.
struct SafeStep : pcl::registration::TransformationEstimationPointToPlaneLLS<pcl::PointNormal, pcl::PointNormal> {
  using Base = pcl::registration::TransformationEstimationPointToPlaneLLS<pcl::PointNormal, pcl::PointNormal>;
  using Base::estimateRigidTransformation;
  mutable bool failed = false;

  void estimateRigidTransformation(const Cloud& source, const Cloud& target,
                                   const pcl::Correspondences& correspondences, Matrix4& step) const override {
    Base::estimateRigidTransformation(source, target, correspondences, step);
    constexpr float farthest = 1e3f;  // m
    if (step.allFinite() && step.cwiseAbs().maxCoeff() < farthest) return;
    step.setIdentity();
    failed = true;
  }
};

/// A model, and the ICP that brings points onto it.
struct Model {
  Cloud::Ptr points;
  Icp icp;
  const pcl::shared_ptr<SafeStep> step = pcl::make_shared<SafeStep>();

  explicit Model(const visualization_msgs::Marker& marker) : points(sampled(mesh_of(marker))) {
    icp.setInputTarget(points);
    icp.setTransformationEstimation(step);
    icp.setMaximumIterations(rounds);
    icp.setMaxCorrespondenceDistance(reach);
    icp.setTransformationEpsilon(1e-12);
    const auto same_side = pcl::make_shared<pcl::registration::CorrespondenceRejectorSurfaceNormal>();
    same_side->setThreshold(std::cos(largest_angle * M_PI / 180.0));
    icp.addCorrespondenceRejector(same_side);  // thin sheets have another surface close behind
  }

  /// Pose of the model in the frame of the points; `guess` is where to begin. None if ICP does not converge.
  std::optional<Isometry3d> pose(const Cloud::Ptr& segment, const Isometry3d& guess) {
    icp.setInputSource(segment);
    Cloud moved;
    step->failed = false;
    icp.align(moved, guess.inverse().matrix().cast<float>());
    if (!icp.hasConverged() || step->failed) return std::nullopt;
    return Isometry3d(icp.getFinalTransformation().cast<double>()).inverse();
  }

  /// How far the surfaces of the model lie apart at two poses: mean of the distances from points to tangent planes (m).
  /// A turn that changes nothing, as of a round part about its axis, does not count.
  double surfaces_apart(const Isometry3d& a, const Isometry3d& b) {
    const Isometry3d between = a.inverse() * b;
    double sum = 0.0;
    pcl::Indices nearest(1);
    std::vector<float> square(1);
    for (const pcl::PointNormal& p : *points) {
      const Vector3d there = between * Vector3d(p.getVector3fMap().cast<double>());
      icp.getSearchMethodTarget()->nearestKSearch(point(there, Vector3d::Zero()), 1, nearest, square);
      const pcl::PointNormal& q = (*points)[static_cast<std::size_t>(nearest[0])];
      sum += std::abs(q.getNormalVector3fMap().cast<double>().dot(there - q.getVector3fMap().cast<double>()));
    }
    return sum / static_cast<double>(points->size());
  }
};

class IcpCheck {
 public:
  IcpCheck() : listener_(buffer_) {
    const ros::NodeHandle params("~");
    params.param("offset", offset_, offset_);
    params.param("turn", turn_, turn_);
    params.param("least_points", least_points_, least_points_);
    params.param("tolerance", tolerance_, tolerance_);
    subscribers_ = {keep("scene", scene_), keep("markers", markers_), keep("points", points_)};
  }

 private:
  /// Topics arrive in any order: those of one scene have one stamp.
  template <class Message>
  ros::Subscriber keep(const char* topic, boost::shared_ptr<const Message>& last) {
    using Pointer = boost::shared_ptr<const Message>;
    const boost::function<void(const Pointer&)> callback = [this, &last](const Pointer& message) {
      last = message;
      if (!scene_ || !markers_ || markers_->markers.empty() || !points_) return;
      const ros::Time stamp = points_->header.stamp;
      if (scene_->header.stamp != stamp || markers_->markers[0].header.stamp != stamp) return;
      check(*std::exchange(points_, nullptr));
    };
    return node_.subscribe<Message>(topic, 1, callback);
  }

  struct Part {
    std::string frame;
    visualization_msgs::Marker marker;
  };
  /// Those with a marker.
  std::map<int, Part> parts_by_id() const {
    std::map<int, std::string> frames;
    for (const auto& part : scene_->parts) frames[part.id] = part.frame_id;
    std::map<int, Part> parts;
    for (const auto& marker : markers_->markers)
      if (marker.ns == "parts" && marker.action == marker.ADD && frames.count(marker.id))
        parts[marker.id] = {frames[marker.id], marker};
    return parts;
  }

  Model& model_of(const visualization_msgs::Marker& marker) {
    std::string key = marker.mesh_resource + " " + std::to_string(marker.scale.x);
    for (const geometry_msgs::Point& p : marker.points)
      for (const double x : {p.x, p.y, p.z}) key.append(reinterpret_cast<const char*>(&x), sizeof x);
    const auto known = models_.find(key);
    return known != models_.end() ? known->second : models_.try_emplace(key, marker).first->second;
  }

  /// A first guess: the truth, turned and shifted.
  Isometry3d displaced(const Isometry3d& truth) {
    std::normal_distribution<double> normal;
    const auto direction = [&] { return Vector3d(normal(random_), normal(random_), normal(random_)).normalized(); };
    return truth * Eigen::Translation3d(offset_ * direction()) * Eigen::AngleAxisd(turn_, direction());
  }

  void check(const sensor_msgs::PointCloud2& message) {
    pcl::PointCloud<LabelledPoint> cloud;
    pcl::fromROSMsg(message, cloud);     // no field needs another name
    std::map<int, Cloud::Ptr> segments;  // by part id
    for (const LabelledPoint& p : cloud) {
      if (p.label == 0 || !std::isfinite(p.z) || !std::isfinite(p.normal_x)) continue;
      Cloud::Ptr& segment = segments[static_cast<int>(p.label) - 1];
      if (!segment) segment = pcl::make_shared<Cloud>();
      segment->push_back(point(p.getVector3fMap().cast<double>(), p.getNormalVector3fMap().cast<double>()));
    }
    const std::map<int, Part> parts = parts_by_id();
    int checked = 0, agree = 0, lost = 0;
    for (const auto& [id, segment] : segments) {
      const auto part = parts.find(id);
      if (part == parts.end() || static_cast<int>(segment->size()) < least_points_) continue;
      try {
        ++checked;
        const std::optional<double> apart = check_part(part->second, segment, message.header);
        lost += !apart;
        agree += apart && *apart <= tolerance_;
      } catch (const std::exception& error) {
        ROS_ERROR("part %d: %s", id, error.what());
      }
    }
    ROS_INFO("%d of %d parts with at least %d points agree with TF within %.2g mm, %d did not converge", agree, checked,
             least_points_, 1e3 * tolerance_, lost);
  }

  /// Distance of the surfaces (m); none if ICP did not converge.
  std::optional<double> check_part(const Part& part, const Cloud::Ptr& segment, const std_msgs::Header& header) {
    const char* const frame = part.frame.c_str();
    // The cloud's own stamp: part frames are found there however late this is.
    const Isometry3d truth =
        pose_of(buffer_.lookupTransform(header.frame_id, part.frame, header.stamp, ros::Duration(1.0)).transform);
    Model& model = model_of(part.marker);
    const std::optional<Isometry3d> found = model.pose(segment, displaced(truth));
    if (!found) {
      ROS_INFO("%s: %zu points, ICP did not converge", frame, segment->size());
      return std::nullopt;
    }
    const double apart = model.surfaces_apart(truth, *found);
    ROS_INFO("%s: %zu points, the model's surface %.3f mm from that on TF", frame, segment->size(), 1e3 * apart);
    geometry_msgs::TransformStamped message;
    message.header = header;
    message.child_frame_id = "icp_" + part.frame;
    message.transform = transform_of(*found);
    broadcaster_.sendTransform(message);
    return apart;
  }

  ros::NodeHandle node_;
  double offset_ = 0.002;     ///< ~offset (m) and
  double turn_ = 0.03;        ///< ~turn (rad) of the first guess from the truth
  int least_points_ = 300;    ///< ~least_points: segments with fewer are left alone
  double tolerance_ = 0.001;  ///< ~tolerance (m) of the log's last line
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::mt19937 random_;
  std::map<std::string, Model> models_;
  bin_scenes_msgs::SceneConstPtr scene_;
  visualization_msgs::MarkerArrayConstPtr markers_;
  sensor_msgs::PointCloud2ConstPtr points_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "icp_check");
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });  // as roscpp does for SIGINT
  const IcpCheck check;
  ros::spin();
}
