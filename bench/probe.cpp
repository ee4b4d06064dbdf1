/// What a card does to a few simple shaders (shaders/probe), so that the model of test/meter can be corrected and the
/// times of the passes be explained: latency of memory by size, code that outgrows the instruction caches, groups that
/// work at once by their shared memory, arrays in local memory, barriers.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"

#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/program.hpp"
#include "bin_scenes/gl/timer.hpp"

#include <algorithm>
#include <functional>

namespace bin_scenes::bench {
namespace {

using gl::Program;

/// Device time of a dispatch of so many groups (us): the best of three, after one that warms up.
double best_us(const Program& program, std::size_t groups) {
  double best = 0.0;
  for (int k = 0; k < 4; ++k) {
    gl::Timer timer;
    Profile profile;
    timer.begin("probe");
    gl::dispatch_groups(program, groups, gl::Barrier::all);
    timer.end();
    timer.collect(profile, true);
    const double us = 1e3 * profile.stages_ms.at("probe");
    if (k == 1 || (k > 1 && us < best)) best = us;
  }
  return best;
}

std::string text(std::size_t number) {
  return std::to_string(number);
}

/// ns a hop of a chain of so many megabytes.
Row chased(std::size_t kilobytes, unsigned hops) {
  gl::Device::current().make_current();
  const auto lines = static_cast<unsigned>(kilobytes * 8);
  gl::Storage chain("chain"), result("result");
  chain.allocate(std::size_t{lines} * 128);
  result.allocate(64);
  chain.bind(0);
  result.bind(1);
  const Program make = Program::compute("probe/chase.comp", {{"MAKE", ""}});
  make.set("lines", lines);
  gl::dispatch(make, lines, gl::Barrier::all);
  const Program chase = Program::compute("probe/chase.comp");
  chase.set("hops", hops);
  return Row().measure("ns_a_hop", 1e3 * best_us(chase, 1) / hops);
}

/// ns an instruction of one warp; `kilobytes` of 1 kB for each A of the shader.
Row straight(std::size_t kilobytes, std::size_t warps, unsigned rounds) {
  gl::Device::current().make_current();
  gl::Storage values("values");
  values.allocate(128);
  values.bind(0);
  std::string length;  // A is 1 kB, B 16, C 32
  std::size_t left = kilobytes;
  for (; left >= 32; left -= 32) length += "C ";
  for (; left >= 16; left -= 16) length += "B ";
  for (; left >= 1; left -= 1) length += "A ";
  const Program program = Program::compute("probe/straight.comp", {{"LENGTH", length}, {"GROUP", text(32 * warps)}});
  program.set("rounds", rounds);
  const double instructions = 64.0 * static_cast<double>(kilobytes) * rounds;
  return Row().measure("ns_an_instruction", 1e3 * best_us(program, 1) / instructions);
}

Row residency(std::size_t kilobytes, std::size_t group, unsigned rounds, std::size_t groups) {
  gl::Device::current().make_current();
  gl::Buffer<std::uint32_t> result("result");
  result.resize(2 + 1024);
  result.bind(0);
  const Program program =
      Program::compute("probe/residency.comp", {{"SHARED", text(256 * kilobytes)}, {"GROUP", text(group)}});
  program.set("rounds", rounds);
  gl::dispatch_groups(program, groups, gl::Barrier::all);
  const std::vector<std::uint32_t> words = result.download();
  std::size_t used = 0;
  std::uint32_t most = 0;
  for (std::size_t k = 2; k < words.size(); ++k) used += words[k] > 0, most = std::max(most, words[k]);
  return Row()
      .measure("groups_at_once", static_cast<double>(words[1]))
      .measure("multiprocessors", static_cast<double>(used))  // 0: the driver does not say
      .measure("most_groups_on_one", static_cast<double>(most));
}

Row local_array(bool in_registers, unsigned rounds) {
  gl::Device::current().make_current();
  gl::Storage values("values");
  values.allocate(128);
  values.bind(0);
  const gl::Defines defines = in_registers ? gl::Defines{{"REGISTERS", ""}} : gl::Defines{};
  const Program program = Program::compute("probe/local_array.comp", defines);
  program.set("rounds", rounds);
  return Row().measure("ns_a_round", 1e3 * best_us(program, 1) / rounds);
}

Row barriers(std::size_t group, unsigned rounds) {
  gl::Device::current().make_current();
  gl::Storage values("values");
  values.allocate(128);
  values.bind(0);
  const Program program = Program::compute("probe/barriers.comp", {{"GROUP", text(group)}});
  program.set("rounds", rounds);
  return Row().measure("ns_a_barrier", 1e3 * best_us(program, 1) / (2.0 * rounds));
}

void add(Run& out, const char* probe, std::size_t size_kb, std::size_t group, const std::function<Row()>& work) {
  const Row key = Row::keys("probe", probe, "size_kb", size_kb, "group", group);
  if (out.wanted(key)) out.row(Row(key).append(isolated(work).row));
}

void run(Run& out) {
  const bool quick = out.quick();
  const unsigned rounds = quick ? 100 : 20000;
  using Sizes = std::vector<std::size_t>;
  for (const std::size_t kb : quick ? Sizes{8, 12} : Sizes{8, 12, 16, 24, 32, 48})
    for (const std::size_t group : {64, 256})
      add(out, "residency", kb, group, [&] { return residency(kb, group, rounds, quick ? 8 : 16 * 132); });
  for (const std::size_t mb : quick ? Sizes{1} : Sizes{1, 4, 16, 32, 64, 128, 256})
    add(out, "chase", 1024 * mb, 1, [&] { return chased(1024 * mb, rounds); });
  for (const std::size_t kb : quick ? Sizes{1} : Sizes{16, 32, 64, 128, 256, 512})
    for (const std::size_t warps : quick ? Sizes{1} : Sizes{1, 8})
      add(out, "straight", kb, 32 * warps, [&] { return straight(kb, warps, quick ? 10 : 100); });
  for (const bool in_registers : {false, true})
    add(out, in_registers ? "registers" : "local_array", 0, 32, [&] { return local_array(in_registers, rounds); });
  for (const std::size_t group : {32, 64, 256}) add(out, "barriers", 0, group, [&] { return barriers(group, rounds); });
}

const Registration registration{
    "probe", "memory, instruction fetch, residency and barriers of a card", {"probe", "size_kb", "group"}, run};

}  // namespace
}  // namespace bin_scenes::bench
