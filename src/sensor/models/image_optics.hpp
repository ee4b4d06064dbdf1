/// Settings of pictures that make them resemble photographs. All are off by default. The struct is stored in
/// Sensor::settings beside ImageSettings; its keys are in image_model.cpp.
#pragma once

namespace bin_scenes {

struct ImageOptics {
  double f_number = 0.0;        ///< focal length / diameter of the aperture; 0: a pinhole, which is sharp everywhere
  double focal_length = 0.016;  ///< m, focal length of the lens
  double focus = 0.0;  ///< m along the optical axis, depth at which the image is sharp; 0: median depth of the view
  double bevel = 0.0;  ///< m, radius of the fillets with which edges of parts are shaded; 0: sharp edges
  double soft = 0.5;   ///< least roughness of shiny surfaces that are seen by reflection; 0: their own roughness
};

}  // namespace bin_scenes
