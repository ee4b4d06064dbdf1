/// The sensor model `laser_line`: a sheet of light and a camera that move over the bin together. Each step gives one
/// profile, which is a row of the image.
///
/// The line crosses the rows or the columns of the camera image, whichever is nearer to the normal of the sheet. The
/// camera has one sample per row (or column) along the line. In each of them, the device searches the peak of the line
/// across columns (or rows), and the ray of the peak intersects the sheet at the measured point.
///
/// Light that other surfaces reflect adds to the image. Its brightest spot beside a line can be mistaken for the line
/// (sheet_glow.hpp).
#pragma once

#include "bin_scenes/core/random.hpp"
#include "light/illumination.hpp"
#include "light/indirect_field.hpp"
#include "light/sheet_glow.hpp"
#include "sensor/models/imager.hpp"
#include "sensor/models/line_peak.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace bin_scenes {

struct Profiles {
  int width = 0, height = 0;                  ///< number of samples of a profile; number of profiles
  std::vector<Validity> validity;             ///< row-major, like all images below
  std::vector<std::array<float, 3>> points;   ///< m, in the optical frame of Setup::camera_pose; NaN where not valid
  std::vector<std::array<float, 3>> normals;  ///< true unit normals, in the same frame
  std::vector<std::uint16_t> label;           ///< true label of the part whose line was found; 0: no part
  std::vector<float> intensity;               ///< signal of the line's peak
  std::vector<float> snr;                     ///< signal / standard deviation of the noise and speckle of one pixel
};

class LaserLine {
 public:
  struct Setup {
    Lens camera;
    Pose camera_pose, laser_pose;  ///< in the bin frame, at the centre of the scan; the sheet is the laser's y-z plane
    double line_width = 3e-4;      ///< m, between the points of 1/e^2 of the peak
    Vec3 scan = 5e-4 * Vec3::UnitX();  ///< m, displacement from one profile to the next, bin frame
    int profiles = 1000;
    LaserLineSettings settings;
    ImagerSettings imager;
    bool noise = true;
    double near = 0.0, far = 1e9;     ///< m, range of depths that the camera reports
    IndirectField::Setup indirect{};  ///< Setup::samples: number of paths for 32 rays of the fan
  };
  /// @param key  random numbers for the samples of indirect light
  LaserLine(const Scenery& scenery, const Surfaces& surfaces, const Setup& setup,
            const Random& key = Random(0, 0, Stream::sensor));

  Profiles scanned(const Random& random) const;
  /// Returns the standard deviation of the depth (m) of the centre sample of the centre profile, estimated by random
  /// trials with lines at any position between two rows. NaN where there is no line.
  double depth_sigma() const;

 private:
  /// Light of the laser on a surface, as one sample of the camera sees it: its position in the image and in the scene.
  struct Line {
    int sample;
    double across, depth,
        signal;          ///< pixel, m along the optical axis, share of the full well; signal 0: reflected light
    Vec3 point, normal;  ///< point on the surface (m) and its unit normal, bin frame
    std::uint16_t label;
    bool visible;
  };
  /// The lines that the camera can see in one profile.
  struct Lines {
    std::vector<Line> lines;      ///< the lines, ordered by sample
    std::vector<Validity> codes;  ///< for each sample: validity code that states why there is no line
  };
  struct Carriage {
    Vec3 laser, eye;  ///< positions of laser and camera in the bin frame, at one profile
  };

  double along(const Eigen::Vector2d& pixel) const { return upright_ ? pixel.y() : pixel.x(); }
  double across(const Eigen::Vector2d& pixel) const { return upright_ ? pixel.x() : pixel.y(); }
  void keep_what_the_camera_can_see();
  std::vector<Hit> fan(const Vec3& origin) const;
  std::optional<Eigen::Vector2d> pixel_of(const Carriage& at, const Vec3& point) const {
    return setup_.camera.project(to_camera_ * (point - at.eye));
  }
  void find_lines(const Carriage& at, const std::vector<Hit>& hits, Lines& lines) const;
  /// Two rays `a` and `b` of the fan (indices), and the samples in whose columns they meet the plane of a surface.
  struct Span {
    std::size_t a;
    double at_a;
    std::size_t b;
    double at_b;
  };
  std::optional<Line> line_at(const Carriage& at, int sample, const Hit& hit, std::size_t own, const Span& span) const;
  void extend(const Carriage& at, const std::vector<Hit>& hits, std::size_t own, std::size_t next,
              std::vector<Line>& asked) const;
  void keep_lit(const Carriage& at, const std::vector<Line>& asked, std::vector<Line>& lines) const;
  void hide(const Carriage& at, std::vector<Line>& lines) const;
  SheetGlow::Camera glow_camera() const;
  void follow(const Carriage& at, const std::vector<Hit>& hits, const Random& key, SheetGlow& glow) const;
  void add_second_lines(const Carriage& at, const SheetGlow& glow, std::vector<Line>& lines) const;
  void read_lines(const Carriage& at, const Lines& lines, const SheetGlow* glow, Random draw, Profiles& out,
                  std::size_t profile) const;
  Carriage carriage(const Vec3& offset) const {
    return {setup_.laser_pose.position + offset, setup_.camera_pose.position + offset};
  }
  /// A line as the device measures it, with the longest exposure that does not saturate.
  struct Reading {
    LinePeak peak;
    double scale;  ///< exposure / LaserLineSettings::power
  };
  std::optional<Reading> read(std::vector<float>& window, double sigma, Random& draw) const;
  double sigma_at(double depth) const;
  double noise_of(double signal) const;
  int reach_of(double sigma) const {
    return static_cast<int>(std::ceil(4.0 * sigma)) + 2;
  }  ///< returns half the width of the window that is searched (pixels)

  const Scenery& scenery_;
  const Surfaces& surfaces_;
  Setup setup_;
  Imager imager_;
  Random rays_;
  bool upright_;  ///< the line is vertical in the image, with one sample for each row
  int samples_;
  std::vector<Vec3> directions_;  ///< unit directions of the laser's fan of rays, bin frame
  Mat3 to_camera_;                ///< rotation from the bin frame to the camera frame
  Vec3 sheet_;                    ///< normal of the sheet of light, bin frame
  double reference_ = 1.0;        ///< m, distance from the laser at which the exposure is defined
  std::vector<double> scales_;    ///< exposures / LaserLineSettings::power, the longest first
};

}  // namespace bin_scenes
