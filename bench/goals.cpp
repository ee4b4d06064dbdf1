/// The goals of the default solver, on every sample part: errors of ten seeds, and scene time against stock Bullet's in
/// the same run. Where exact convex pieces of a part are known, the referee has its say.
#include "framework/benchmark.hpp"
#include "goals_met.hpp"
#include "judged.hpp"

namespace bin_scenes::bench {
namespace {

struct Pile {
  const char* part;
  int judged;        ///< seeds that the referee sees
  int bullet_seeds;  ///< poured by stock Bullet as well
};
constexpr Pile piles[] = {{"channel_u", 10, 2},  {"ring_24", 3, 1},    {"bolt_hex", 10, 2}, {"bracket_l", 0, 0},
                          {"clip_spring", 0, 0}, {"conrod", 0, 0},     {"gear_spur", 0, 0}, {"mug", 0, 0},
                          {"nut_hex", 0, 0},     {"pipe_elbow", 0, 0}, {"pipe_tee", 0, 0},  {"teapot", 0, 0},
                          {"washer", 0, 0}};

PeerSettings stock_bullet() {
  PeerSettings peer;
  peer.engine = "bullet_stock";
  peer.time_step = 0.01;
  peer.iterations = 10;
  return peer;
}

void pile_row(Run& out, const Pile& pile, bool peer, int seeds, int judged) {
  const std::size_t count = out.quick() ? 8 : 150;
  const Row key = Row()
                      .key("part", pile.part)
                      .key("bodies", count)
                      .key("solver", peer ? "bullet_stock" : "sphere")
                      .key("sleeping", "yes");
  if (!out.wanted(key)) return;
  Request request = bin_of(pile.part, count);
  request.bin.inner_size = Vec3(0.40, 0.30, 0.20);
  if (!peer) {
    choose_solver(request, "sphere");
    warm_up(request);
  }
  std::vector<Row> scenes;
  for (int seed = 1; seed <= seeds; ++seed) {
    request.seed = static_cast<std::uint64_t>(seed);
    const Judged how{out.quick() ? 20.0 : 120.0, seed <= judged};
    scenes.push_back(judged_scene(out.scratch(), request, Run::pieces(pile.part),
                                  peer ? std::optional(stock_bullet()) : std::nullopt, how));
    if (scenes.back().at("scenes").empty()) break;
  }
  out.row(Row(key).append(over_all(scenes)));
}

void run(Run& out) {
  for (const Pile& pile : piles) {
    if (out.quick() && pile.judged == 0) continue;
    pile_row(out, pile, false, out.quick() ? 1 : 10, pile.judged);
    if (pile.bullet_seeds > 0) pile_row(out, pile, true, out.quick() ? 1 : pile.bullet_seeds, 1);
  }
}

const Registration registration{"goals", "150 parts of every shape against the goals, stock Bullet's time beside", run};

}  // namespace
}  // namespace bin_scenes::bench
