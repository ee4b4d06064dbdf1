/// Which stage of settling a solver was put into, by its phase.
#pragma once

#include "pour/settling.hpp"

#include <algorithm>
#include <stdexcept>

namespace bin_scenes::testing {

/// Friction is left out: what once held less does so to the end.
inline Stage stage_of(const Phase& phase) {
  const auto same = [&](const StageRow& row) {
    return row.phase.fine_samples == phase.fine_samples && row.phase.stiffness == phase.stiffness &&
           row.phase.forgets == phase.forgets && row.phase.sleep == phase.sleep &&
           row.phase.begins_asleep == phase.begins_asleep;
  };
  const auto row = std::find_if(stage_rows.begin(), stage_rows.end(), same);
  if (row == stage_rows.end()) throw std::logic_error("no stage has this phase");
  return row->stage;
}

}  // namespace bin_scenes::testing
