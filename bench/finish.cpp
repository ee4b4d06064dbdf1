/// What each finish of a pour costs and leaves, and the preset quick below them: samples, parts drawn from seeds, and
/// small bins, with the referee's word. Two columns say how many scenes meet the goals of accuracy.
#include "framework/benchmark.hpp"
#include "goals_met.hpp"
#include "judged.hpp"
#include "made_part.hpp"

#include <cstdio>

namespace bin_scenes::bench {
namespace {

constexpr int seeds = 3, unseen_parts = 10;

struct SampleBin {
  const char* part;
  std::size_t count;
};
constexpr SampleBin samples[] = {{"channel_u", 150}, {"bolt_hex", 150}, {"ring_24", 150},    {"gear_spur", 150},
                                 {"channel_u", 40},  {"gear_spur", 40}, {"clip_spring", 40}, {"bolt_hex", 40}};

void finish_as(Request& request, const std::string& name) {
  for (const Pour::Finish finish : {Pour::Finish::settled, Pour::Finish::pressed, Pour::Finish::probed})
    if (name == name_of(finish)) request.pour.finish = finish;
}

/// A part in a bin under each finish and solver.
void rows(Run& out, const std::string& part, const Request& asked, const std::string& pieces, int scenes_each) {
  const std::size_t count = asked.parts[0].count;
  for (const std::string solver : {"sphere", "sphere/quick", "bullet"})
    for (const std::string finish : {"settled", "pressed", "probed"}) {
      if (solver != "sphere" && finish != "settled") continue;  // all that quick does, and all alike to bullet
      const Row key = Row().key("part", part).key("bodies", count).key("solver", solver).key("finish", finish);
      if (!out.wanted(key)) continue;
      Request request = asked;
      choose_solver(request, solver);
      finish_as(request, finish);
      warm_up(request);
      out.row(Row(key).append(over_all(
          judged_scenes(out.scratch(), request, pieces, {}, {out.quick() ? 20.0 : 120.0, scenes_each}, scenes_each))));
    }
}

void run(Run& out) {
  const int scenes_each = out.quick() ? 1 : seeds;
  for (const SampleBin& bin : samples) {
    Request request = bin_of(bin.part, out.quick() ? 8 : bin.count);
    request.bin.inner_size = bin.count == 40 ? Vec3(0.20, 0.15, 0.20) : Vec3(0.40, 0.30, 0.20);
    rows(out, bin.part, request, Run::pieces(bin.part), scenes_each);
    if (out.quick()) return;
  }
  for (int part = 1; part <= unseen_parts; ++part) {
    char name[32];
    std::snprintf(name, sizeof name, "random_%02d", part);
    const std::string folder = out.scratch() + "/" + name;
    write_random_part(folder, static_cast<std::uint64_t>(part));
    Request request = bin_of(name, 150);
    request.parts[0].model = "part.obj";
    request.parts[0].path = folder + "/part.obj";
    request.bin.inner_size = Vec3(0.40, 0.30, 0.20);
    rows(out, name, request, folder + "/pieces.obj", 1);
  }
}

const Registration registration{
    "finish", "what each finish of a pour costs and leaves", {"part", "bodies", "solver", "finish"}, run};

}  // namespace
}  // namespace bin_scenes::bench
