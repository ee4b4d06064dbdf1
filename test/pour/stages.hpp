/// Which stage of settling a solver was put into, by what it was told.
#pragma once

#include "pour/settling.hpp"

#include <algorithm>
#include <stdexcept>

namespace bin_scenes::testing {

/// Friction is left out: what once held less does so to the end.
inline Stage stage_of(const Phase& told) {
  const auto same = [&](const StageRow& row) {
    return row.told.fine_samples == told.fine_samples && row.told.stiffness == told.stiffness &&
           row.told.forgets == told.forgets && row.told.sleep == told.sleep &&
           row.told.begins_asleep == told.begins_asleep;
  };
  const auto row = std::find_if(stage_rows.begin(), stage_rows.end(), same);
  if (row == stage_rows.end()) throw std::logic_error("no stage is told like that");
  return row->stage;
}

}  // namespace bin_scenes::testing
