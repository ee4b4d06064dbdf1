/// The goals of range sensors: error against closed forms and a ray cast of the tests, noise over its formula, and what
/// a view costs.
#include "sensors/rows.hpp"

namespace bin_scenes::bench {

Row Figure::key() const {
  return Row()
      .key("what", what)
      .key("setting", setting)
      .key("distance_m", distance_m)
      .key("incidence_deg", incidence_deg)
      .key("albedo", albedo);
}

Row row_of(const Figure& figure, double value, const std::string& unit, const std::string& goal) {
  return figure.key().exact("value", value).info("unit", unit).info("goal", goal);
}

namespace {

void run(Run& out) {
  truth_rows(out);
  fringe_rows(out);
  light_rows(out);
  stereo_rows(out);
  time_rows(out);
}

const Registration registration{"sensors",
                                "range sensors: error without noise, noise over its formula, shadows, time a view",
                                {"what", "setting", "distance_m", "incidence_deg", "albedo"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
