/// The passes of one step of the solver `thesis` on the device. A pass has the same name everywhere:
/// shaders/thesis/<name>.comp, its method here, its timer, and its CPU twin (test/solver/thesis/twin.hpp).
#pragma once

#include "bin_scenes/gl/prefix_sum.hpp"
#include "bin_scenes/gl/program.hpp"
#include "bin_scenes/gl/timer.hpp"
#include "memory.hpp"

namespace bin_scenes::thesis {

class Passes {
 public:
  Passes();

  /// Uploads the data of a batch, except data that the device has already, and resizes the buffers of a step's results.
  void load(const Memory& memory);
  /// Runs all passes of one step.
  void step();

  // The passes in their order.
  void begin_step();
  void force();
  void move_to_world();
  void count_cells();
  void prefix_sum();
  void scatter();
  void reorder();
  void detect();
  void plan();
  void count_pairs();
  void split_mass();
  void impulse();
  void pre_velocity();
  void velocity();
  void position();

  /// Returns the states of the bodies. Those that are given to the next load() stay on the device if they are the same.
  const std::vector<gpu::ThesisState>& states();
  /// Waits for the steps that were started, and returns their status since load().
  gpu::ThesisStatus status();
  std::vector<gpu::ThesisNeed> needs() const;
  std::size_t bytes() const;  ///< size of all buffers on the device
  /// Reads all buffers from the device, for tests.
  Memory download() const;

  gl::Timer& timer() { return timer_; }

 private:
  void bind() const;

  Memory held_;  ///< data that was last uploaded or read; its list of states is empty after a step has changed them
  std::vector<gpu::ThesisSettingsBlock> held_settings_;
  gl::Program force_, move_to_world_, count_cells_, scatter_, reorder_, detect_, plan_, count_pairs_, split_mass_,
      impulse_, pre_velocity_, velocity_, position_;
  gl::PrefixSum prefix_sum_;
  gl::Timer timer_;
  gl::ReadBack status_back_;

  gl::Buffer<gpu::ThesisSettingsBlock> settings_{"thesis.settings"};
  gl::Buffer<gpu::ThesisWorld> worlds_{"thesis.worlds"};
  gl::Buffer<gpu::ThesisSheet> sheets_{"thesis.sheets"};
  gl::Buffer<gpu::ThesisBody> bodies_{"thesis.bodies"};
  gl::Buffer<gpu::ThesisState> states_{"thesis.states"};
  gl::Buffer<gpu::ThesisInertia> inertias_{"thesis.inertias"};
  gl::Buffer<gpu::ThesisShape> shapes_{"thesis.shapes"};
  gl::Buffer<gpu::ThesisSphere> spheres_{"thesis.spheres"};
  gl::Buffer<gpu::vec4> centers_{"thesis.centers"};
  gl::Buffer<gpu::uint> sphere_cells_{"thesis.sphere_cells"}, cell_counts_{"thesis.cell_counts"},
      cell_starts_{"thesis.cell_starts"}, members_{"thesis.members"};
  gl::Buffer<gpu::ThesisSorted> sorted_{"thesis.sorted"};
  gl::Buffer<gpu::ThesisRange> contact_ranges_{"thesis.contact_ranges"};
  gl::Buffer<gpu::ThesisContact> contacts_{"thesis.contacts"};
  gl::Buffer<gpu::ThesisNeighbour> neighbours_{"thesis.neighbours"};
  gl::Buffer<gpu::uint> neighbour_counts_{"thesis.neighbour_counts"}, touching_spheres_{"thesis.touching_spheres"},
      touching_bodies_{"thesis.touching_bodies"};
  gl::Buffer<gpu::ThesisPush> pushes_{"thesis.pushes"};
  gl::Buffer<gpu::ThesisStatus> status_{"thesis.status"};
  gl::Buffer<gpu::ThesisNeed> needs_{"thesis.needs"};
};

}  // namespace bin_scenes::thesis
