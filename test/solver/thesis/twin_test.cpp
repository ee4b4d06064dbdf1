// Each pass against its CPU twin, from the same input: whole numbers exactly, floats to a few roundings.
#include "twin.hpp"
#include "scenes.hpp"
#include "solver/thesis/passes.hpp"

#include "bin_scenes/gl/device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace bin_scenes::thesis::test {
namespace {

using Twin = void (*)(Memory&);
using Pass = void (Passes::*)();

/// Two worlds in mid-collision: bodies of several shapes against each other, a fixed one, floor and walls.
class TwinTest : public ::testing::Test {
 protected:
  void SetUp() override {
    gl::Device::current().make_current();
    for (int w = 0; w < 2; ++w) {
      WorldBuilder builder;
      builder.def.bin.inner_size = Vec3(0.1, 0.1, 0.1);
      const std::size_t a = builder.shape(cube(3, 0.005)), b = builder.shape(rod(4, 0.006));
      builder.body(b, Vec3(0.004, 0.013, 0.034), Vec3::Zero(), 1.0, 0.5, 0.0, true);
      builder.body(a, Vec3(0, 0, 0.0145), Vec3(0.3, 0, -0.4), 0.1, 0.4, 0.5);
      builder.body(b, Vec3(0.004, 0.003, 0.0345), Vec3(0, 0.2, -0.6), 0.2, 0.6);
      builder.body(a, Vec3(0.036, -0.01, 0.03), Vec3(1, 0, 0), 0.1);
      builder.body(a, Vec3(0, -0.03, 0.08), Vec3(0, 0, w), 0.1);  // touches nothing
      for (std::size_t i = 1; i < builder.starts.size(); ++i) {
        builder.starts[i].pose.orientation =
            Quat(Eigen::AngleAxisd(0.2 * (double(i) + w), Vec3(1, double(i), 1).normalized()));
        builder.starts[i].velocity.angular = Vec3(double(i), 2, -1);
      }
      worlds_[w] = make_world(builder.def, builder.shapes, {});
      worlds_[w].present.assign(builder.starts.size(), true);
      for (std::size_t i = 0; i < builder.starts.size(); ++i)
        worlds_[w].states[i] = to_state(builder.starts[i], worlds_[w].shapes[builder.def.bodies[i].part]);
    }
    std::vector<BodyIndex> index;
    Capacity capacity;
    capacity.contacts = 8;
    passes_ = std::make_unique<Passes>();
    passes_->load(lay_out({&worlds_[0], &worlds_[1]}, {}, capacity, 0.01, index));
    passes_->begin_step();
  }

  /// Runs a pass on both sides from the device's state.
  void run(Pass pass, Twin twin) {
    cpu_ = passes_->download();
    (passes_.get()->*pass)();
    gpu_ = passes_->download();
    twin(cpu_);
  }
  /// The passes before the one under test.
  void advance_to(std::initializer_list<Pass> passes) {
    for (Pass pass : passes) (passes_.get()->*pass)();
  }
  void to_contacts() {
    advance_to({&Passes::force, &Passes::move_to_world, &Passes::count_cells, &Passes::prefix_sum, &Passes::scatter,
                &Passes::reorder, &Passes::detect});
  }
  void to_impulses() {
    to_contacts();
    advance_to({&Passes::plan, &Passes::count_pairs, &Passes::plan, &Passes::split_mass});
  }

  World worlds_[2];
  std::unique_ptr<Passes> passes_;
  Memory cpu_, gpu_;
};

void expect_near(const gpu::vec4& a, const gpu::vec4& b, float scale, const char* what) {
  const float tolerance = 4e-6f * scale;  // some thirty roundings
  EXPECT_NEAR(a.x, b.x, tolerance) << what;
  EXPECT_NEAR(a.y, b.y, tolerance) << what;
  EXPECT_NEAR(a.z, b.z, tolerance) << what;
  EXPECT_NEAR(a.w, b.w, tolerance) << what;
}

/// Contacts of each sphere.
std::vector<gpu::uint> counts(const Memory& m) {
  std::vector<gpu::uint> out;
  for (const gpu::ThesisRange& range : m.contact_ranges) out.push_back(range.count);
  return out;
}
const gpu::ThesisContact& contact(const Memory& m, std::size_t sphere, gpu::uint i) {
  return m.contacts[m.contact_ranges[sphere].first + i];
}

void expect_states_near(const Memory& a, const Memory& b) {
  for (std::size_t i = 0; i < a.states.size(); ++i) {
    expect_near(a.states[i].position, b.states[i].position, 1, "position");
    expect_near(a.states[i].orientation, b.states[i].orientation, 1, "orientation");
    expect_near(a.states[i].velocity, b.states[i].velocity, 1, "velocity");
    expect_near(a.states[i].spin, b.states[i].spin, 20, "spin");
  }
}

TEST_F(TwinTest, Force) {
  run(&Passes::force, twin::force);
  expect_states_near(gpu_, cpu_);
  EXPECT_EQ(gpu_.neighbour_counts, cpu_.neighbour_counts);
  for (std::size_t i = 0; i < cpu_.inertias.size(); ++i) {
    const float scale = cpu_.bodies[i].inverse_inertia.x + cpu_.bodies[i].inverse_inertia.z;
    expect_near(gpu_.inertias[i].diagonal, cpu_.inertias[i].diagonal, scale, "diagonal");
    expect_near(gpu_.inertias[i].mixed, cpu_.inertias[i].mixed, scale, "mixed");
  }
}

TEST_F(TwinTest, MoveToWorld) {
  run(&Passes::move_to_world, twin::move_to_world);
  for (std::size_t s = 0; s < cpu_.centers.size(); ++s) expect_near(gpu_.centers[s], cpu_.centers[s], 0.1f, "center");
}

TEST_F(TwinTest, Grid) {
  advance_to({&Passes::move_to_world});
  run(&Passes::count_cells, twin::count_cells);
  EXPECT_EQ(gpu_.sphere_cells, cpu_.sphere_cells);
  EXPECT_EQ(gpu_.cell_counts, cpu_.cell_counts);
  run(&Passes::prefix_sum, twin::prefix_sum);
  EXPECT_EQ(gpu_.cell_starts, cpu_.cell_starts);
  EXPECT_EQ(gpu_.cell_starts.back(), gpu_.settings.spheres);
  run(&Passes::scatter, twin::scatter);
  for (std::size_t c = 0; c + 1 < cpu_.cell_starts.size(); ++c)  // inside a cell any order
    for (Memory* m : {&gpu_, &cpu_})
      std::sort(m->members.begin() + m->cell_starts[c], m->members.begin() + m->cell_starts[c + 1]);
  EXPECT_EQ(gpu_.members, cpu_.members);
  EXPECT_EQ(gpu_.cell_counts, std::vector<gpu::uint>(gpu_.cell_counts.size(), 0)) << "not ready for the next step";
  run(&Passes::reorder, twin::reorder);
  for (std::size_t i = 0; i < cpu_.sorted.size(); ++i) {
    EXPECT_EQ(gpu_.sorted[i].owner.x, cpu_.sorted[i].owner.x);
    EXPECT_EQ(gpu_.sorted[i].owner.y, cpu_.sorted[i].owner.y);
    EXPECT_EQ(std::memcmp(&gpu_.sorted[i].center, &cpu_.sorted[i].center, sizeof(gpu::vec4)), 0);
  }
}

std::vector<gpu::uint> sorted(std::vector<gpu::uint> list, std::size_t count) {
  list.resize(count);
  std::sort(list.begin(), list.end());
  return list;
}

TEST_F(TwinTest, Detect) {
  advance_to({&Passes::force, &Passes::move_to_world, &Passes::count_cells, &Passes::prefix_sum, &Passes::scatter,
              &Passes::reorder});
  run(&Passes::detect, twin::detect);
  EXPECT_EQ(counts(gpu_), counts(cpu_));
  EXPECT_GT(cpu_.status.touching_spheres, 20u) << "too few contacts to show anything";
  EXPECT_EQ(gpu_.status.touching_spheres, cpu_.status.touching_spheres);
  EXPECT_EQ(sorted(gpu_.touching_spheres, gpu_.status.touching_spheres),
            sorted(cpu_.touching_spheres, cpu_.status.touching_spheres));
  EXPECT_EQ(gpu_.needs[0].contacts, cpu_.needs[0].contacts);
  EXPECT_EQ(gpu_.needs[1].contacts, cpu_.needs[1].contacts);
  gpu::uint slots = 0;  // each taken by one sphere, none left out
  std::map<gpu::uint, gpu::uint> taken;
  for (const gpu::ThesisRange& range : gpu_.contact_ranges)
    if (range.count) taken[range.first] = range.count;
  for (const auto& [first, count] : taken) {
    EXPECT_EQ(first, slots);
    slots += count;
  }
  EXPECT_EQ(gpu_.status.slots, slots);
  bool sphere = false, sheet = false, fixed = false;
  for (std::size_t s = 0; s < cpu_.contact_ranges.size(); ++s) {
    // Equal depths may come in either order where roundings differ: compare by the other's id.
    std::map<gpu::uint, gpu::ThesisContact> mine, twins;
    for (gpu::uint i = 0; i < cpu_.contact_ranges[s].count; ++i) {
      mine[contact(gpu_, s, i).other.x] = contact(gpu_, s, i);
      twins[contact(cpu_, s, i).other.x] = contact(cpu_, s, i);
    }
    for (const auto& [other, contact] : twins) {
      ASSERT_EQ(mine.count(other), 1u) << "sphere " << s << " misses " << other;
      const gpu::ThesisContact& own = mine[other];
      EXPECT_EQ(own.other.y, contact.other.y);
      expect_near(own.normal, contact.normal, 1, "normal");
      expect_near(own.arm, contact.arm, 1, "arm");
      expect_near(own.total, contact.total, 10, "goal");
      sheet = sheet || (other & THESIS_NODE);
      sphere = sphere || other < cpu_.settings.moving_spheres;
      fixed = fixed || (!(other & THESIS_NODE) && other >= cpu_.settings.moving_spheres);
    }
  }
  EXPECT_TRUE(sphere && sheet && fixed) << "a kind of contact never occurred";
}

TEST_F(TwinTest, DetectOfTooManyKeepsTheDeepest) {
  std::vector<BodyIndex> index;
  Capacity capacity;
  capacity.contacts = 1;
  passes_->load(lay_out({&worlds_[0], &worlds_[1]}, {}, capacity, 0.01, index));
  passes_->begin_step();
  advance_to({&Passes::force, &Passes::move_to_world, &Passes::count_cells, &Passes::prefix_sum, &Passes::scatter,
              &Passes::reorder});
  run(&Passes::detect, twin::detect);
  EXPECT_EQ(counts(gpu_), counts(cpu_));
  EXPECT_EQ(gpu_.status.overflow, gpu::uint{THESIS_CONTACT_OVERFLOW});
  EXPECT_EQ(gpu_.needs[0].contacts, cpu_.needs[0].contacts) << "the need is counted on beyond the capacity";
  for (std::size_t s = 0; s < cpu_.contact_ranges.size(); ++s)
    if (cpu_.contact_ranges[s].count) {
      EXPECT_NEAR(contact(gpu_, s, 0).normal.w, contact(cpu_, s, 0).normal.w, 1e-7);
    }
}

TEST_F(TwinTest, DetectWithoutRoomForAllTellsHowMuchIsMissing) {
  to_contacts();
  const gpu::uint need = passes_->download().status.slots;
  std::vector<BodyIndex> index;
  Capacity capacity;
  capacity.contacts = 8;
  Memory memory = lay_out({&worlds_[0], &worlds_[1]}, {}, capacity, 0.01, index);
  memory.settings.slots = need - 1;
  passes_->load(memory);
  passes_->begin_step();
  to_contacts();
  run(&Passes::plan, twin::plan);
  EXPECT_EQ(gpu_.status.overflow, gpu::uint{THESIS_SLOT_OVERFLOW});
  EXPECT_EQ(gpu_.status.most_slots, need);
  EXPECT_EQ(gpu_.status.most_slots, cpu_.status.most_slots);
  for (const gpu::ThesisRange& range : gpu_.contact_ranges) EXPECT_LE(range.first + range.count, need - 1);
  // What was left out lets bodies through each other: later needs are not to be trusted.
  passes_->begin_step();
  to_contacts();
  run(&Passes::plan, twin::plan);
  EXPECT_EQ(gpu_.status.most_slots, need);
}

TEST_F(TwinTest, CountPairsAndSplitMass) {
  to_contacts();
  run(&Passes::plan, twin::plan);
  EXPECT_EQ(gpu_.status.sphere_groups.x, cpu_.status.sphere_groups.x);
  run(&Passes::count_pairs, twin::count_pairs);
  EXPECT_EQ(gpu_.neighbour_counts, cpu_.neighbour_counts);
  EXPECT_EQ(gpu_.status.contacts, cpu_.status.contacts);
  EXPECT_EQ(sorted(gpu_.touching_bodies, gpu_.status.touching_bodies),
            sorted(cpu_.touching_bodies, cpu_.status.touching_bodies));
  const auto table = [](const Memory& m) {
    std::map<std::pair<std::size_t, gpu::uint>, gpu::uint> counts;
    for (std::size_t i = 0; i < m.neighbours.size(); ++i)
      if (m.neighbours[i].key != THESIS_NO_KEY)
        counts[{i / m.settings.neighbour_slots, m.neighbours[i].key}] = m.neighbours[i].count + 1;
    return counts;
  };
  EXPECT_EQ(table(gpu_), table(cpu_));
  EXPECT_EQ(gpu_.needs[0].neighbours, cpu_.needs[0].neighbours);
  run(&Passes::plan, twin::plan);
  EXPECT_EQ(gpu_.status.body_groups.x, cpu_.status.body_groups.x);
  run(&Passes::split_mass, twin::split_mass);
  gpu::uint most = 0;
  for (std::size_t s = 0; s < cpu_.contact_ranges.size(); ++s)
    for (gpu::uint i = 0; i < cpu_.contact_ranges[s].count; ++i) {
      EXPECT_EQ(contact(gpu_, s, i).other.z, contact(cpu_, s, i).other.z);
      most = std::max(most, contact(cpu_, s, i).other.z);
    }
  EXPECT_GT(most, 1u);
}

TEST_F(TwinTest, ImpulseAndVelocity) {
  to_impulses();
  for (int iteration = 0; iteration < 3; ++iteration) {  // the later ones take back, too
    run(&Passes::impulse, twin::impulse);
    for (std::size_t s = 0; s < cpu_.contact_ranges.size(); ++s)
      for (gpu::uint i = 0; i < cpu_.contact_ranges[s].count; ++i) {
        expect_near(contact(gpu_, s, i).impulse, contact(cpu_, s, i).impulse, 0.5f, "impulse");
        expect_near(contact(gpu_, s, i).total, contact(cpu_, s, i).total, 0.5f, "total");
      }
    run(&Passes::pre_velocity, twin::pre_velocity);
    for (std::size_t s = 0; s < cpu_.contact_ranges.size(); ++s) {
      if (cpu_.contact_ranges[s].count == 0) continue;
      expect_near(gpu_.pushes[s].linear, cpu_.pushes[s].linear, 0.5f, "linear push");
      expect_near(gpu_.pushes[s].angular, cpu_.pushes[s].angular, 0.01f, "angular push");
    }
    run(&Passes::velocity, twin::velocity);
    expect_states_near(gpu_, cpu_);
  }
}

TEST_F(TwinTest, Position) {
  to_impulses();
  advance_to({&Passes::impulse, &Passes::pre_velocity, &Passes::velocity});
  run(&Passes::position, twin::position);
  expect_states_near(gpu_, cpu_);
}

}  // namespace
}  // namespace bin_scenes::thesis::test
