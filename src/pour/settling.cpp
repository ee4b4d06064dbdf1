/// The table of transitions between stages, and what an observation of the heap says for them.
#include "pour/settling.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

using Finish = Pour::Finish;

constexpr double calm_share = 0.4;  ///< part of the rest window after which parts that have not moved are calm
constexpr double jolt = 0.02;  ///< s at the start of a check in which its forces are found and parts shift a little
constexpr double creep = 1.0;  ///< s of a probe, time-out for slow tipping; it ends sooner when all parts sleep
/// s: time-out of stages whose stiff contacts damp rocking poorly. Parts that alone have moved for this long rock.
constexpr double patience = 2.0;
constexpr int most_checks = 12;   ///< of the whole heap; those that still move in the last one are rechecked
constexpr int most_rechecks = 8;  ///< who still moves in the last one is unstable
/// s after the pour: from then on, checks are not repeated for the whole heap, since each of them makes other parts
/// move.
constexpr double last_call = 4.0;
constexpr double closing = 6.0;  ///< s after the pour: few parts that rock on are not waited for any longer
// Parts that may move in a check without it being repeated for the whole heap, at most n / 50: 3 of 150.
constexpr double tolerated_share = 0.02;

}  // namespace

/// One observation of the heap.
struct Settling::Seen {
  const HeapView& heap;
  double calm_s;      ///< s: time after which parts that stayed are calm
  double in_stage;    ///< s
  double last_stage;  ///< s: the same at the last observation
  int checks, rechecks;
  double since_pour;  ///< s
  bool staged;        ///< whether the solver has stages

  bool all_in() const { return heap.all_in() && heap.all_slow(); }
  bool rest() const { return heap.all_in() && heap.all_rest(); }
  bool calm() const { return heap.still_for_less_than(calm_s) == 0; }
  bool fast() const { return !heap.all_slow(); }
  bool too_many(std::size_t parts) const {
    return static_cast<double>(parts) > tolerated_share * static_cast<double>(heap.count());
  }
  /// Parts that moved in this check have not been verified where they lie now.
  std::size_t unverified() const { return heap.still_for_less_than(in_stage - jolt); }
  bool moved() const { return calm() && too_many(unverified()) && checks < most_checks && since_pour <= last_call; }
  /// Parts have had time to show that they move. Rest alone does not say so: its window reaches back into the stage
  /// before, so that a verification would end at its first observation.
  bool shown() const { return rest() && (in_stage >= heap.rest_window() || heap.all_asleep()); }
  bool verified() const { return shown() && unverified() == 0; }
  bool verifiable() const { return shown() && rechecks < most_rechecks; }
  /// No more than a few parts have moved for some time: these rock, and do not make others move in turn.
  bool nearly() const {
    const std::size_t moved = heap.still_for_less_than(patience);
    return moved <= 1 || !too_many(moved);
  }
  /// The last parts rock or turn on and on. One that has just begun to slip in a check is waited for.
  bool late() const { return since_pour > closing && in_stage > patience && !calm() && nearly(); }
  bool stood() const { return calm() && heap.all_rest(); }
  /// A part that tips or falls is waited for. On soft contacts the whole heap would sag again, and others fall as it is
  /// pressed: of hundreds there is always one.
  bool rocks() const {
    return !calm() && in_stage > patience && (fast() || too_many(heap.still_for_less_than(calm_s)));
  }
  /// True at one observation, the first at which the heap can be calm: a given start was not at rest.
  bool stirs() const { return in_stage >= calm_s && last_stage < calm_s && heap.still_for_less_than(0.5 * calm_s) > 0; }
};

struct Settling::Transition {
  Stage from;
  Finish least, most;  ///< asked for
  bool (*when)(const Seen&);
  Stage to;
};

/// At each observation the first transition that applies is taken.
const Settling::Transition Settling::transitions[] = {
    // clang-format off
    // from           asked for                            when                                            to
    {Stage::pour,   Finish::settled, Finish::probed,  [](const Seen& s) { return s.all_in(); },       Stage::settle},
    {Stage::settle, Finish::settled, Finish::probed,  [](const Seen& s) { return s.late(); },         Stage::done},
    {Stage::press,  Finish::settled, Finish::probed,  [](const Seen& s) { return s.late(); },         Stage::done},
    {Stage::probe,  Finish::probed,  Finish::probed,  [](const Seen& s) { return s.late(); },         Stage::done},
    {Stage::verify, Finish::settled, Finish::probed,  [](const Seen& s) { return s.late(); },         Stage::done},
    {Stage::settle, Finish::settled, Finish::settled, [](const Seen& s) { return !s.staged && s.rest(); }, Stage::done},
    {Stage::settle, Finish::settled, Finish::settled, [](const Seen& s) { return s.staged && s.calm(); }, Stage::verify},
    {Stage::settle, Finish::pressed, Finish::probed,  [](const Seen& s) { return s.calm(); },         Stage::press},
    {Stage::press,  Finish::probed,  Finish::probed,  [](const Seen& s) { return s.calm(); },         Stage::probe},
    {Stage::press,  Finish::settled, Finish::probed,  [](const Seen& s) { return s.rocks(); },        Stage::settle},
    {Stage::press,  Finish::settled, Finish::pressed, [](const Seen& s) { return s.calm(); },         Stage::verify},
    {Stage::probe,  Finish::probed,  Finish::probed,  [](const Seen& s) { return s.moved(); },        Stage::probe},
    {Stage::probe,  Finish::probed,  Finish::probed,
     [](const Seen& s) { return s.stood() && (s.in_stage >= creep || s.heap.all_asleep()); },         Stage::verify},
    {Stage::probe,  Finish::probed,  Finish::probed,  [](const Seen& s) { return s.rocks(); },        Stage::settle},
    {Stage::verify,  Finish::settled, Finish::pressed, [](const Seen& s) { return s.shown(); },        Stage::done},
    {Stage::verify,  Finish::probed,  Finish::probed,  [](const Seen& s) { return s.moved(); },        Stage::verify},
    {Stage::verify,  Finish::probed,  Finish::probed,  [](const Seen& s) { return s.verified(); },     Stage::done},
    {Stage::verify,  Finish::probed,  Finish::probed,  [](const Seen& s) { return s.shown(); },        Stage::recheck},
    {Stage::verify,  Finish::settled, Finish::probed,  [](const Seen& s) { return s.rocks(); },        Stage::settle},
    {Stage::recheck, Finish::probed,  Finish::probed,  [](const Seen& s) { return s.verified(); },     Stage::done},
    {Stage::recheck, Finish::probed,  Finish::probed,  [](const Seen& s) { return s.verifiable(); },   Stage::recheck},
    {Stage::recheck, Finish::probed,  Finish::probed,  [](const Seen& s) { return s.shown(); },        Stage::done},
    {Stage::recheck, Finish::probed,  Finish::probed,
     [](const Seen& s) { return s.in_stage > patience && !s.calm() && s.nearly(); },                  Stage::done},
    {Stage::recheck, Finish::probed,  Finish::probed,  [](const Seen& s) { return s.rocks(); },        Stage::settle},
    {Stage::hold,   Finish::settled, Finish::probed,  [](const Seen& s) { return s.fast(); },         Stage::settle},
    {Stage::hold,   Finish::settled, Finish::probed,  [](const Seen& s) { return s.stirs(); },        Stage::settle},
    {Stage::hold,   Finish::settled, Finish::probed,  [](const Seen& s) { return s.rest(); },         Stage::done},
    {Stage::repair,   Finish::settled, Finish::probed,  [](const Seen& s) { return s.rest(); },         Stage::done},
    {Stage::repair,   Finish::settled, Finish::probed,
     [](const Seen& s) { return s.in_stage > patience && !s.calm(); },                                Stage::settle},
    // clang-format on
};

void Settling::start_clock() {
  poured_ -= advanced_;
  begun_ = advanced_ = 0.0;
}

void Settling::start(Stage stage) {
  if (stage != Stage::repair) friction_ = 1.0;
  checks_ = rechecks_ = 0;
  poured_ = checked_s_ = 0.0;
  gave_up_ = false;
  enter(stage, 0.0);
  advanced_ = 0.0;
}

void Settling::enter(Stage stage, double time) {
  last_ = stage_;
  stage_ = stage;
  if (last_ == Stage::pour) poured_ = time;
  begun_ = time;
  if (done()) return;
  friction_ = std::min(friction_, row(stage_).phase.friction);
  BIN_SCENES_ASSERT(friction_ > 0.0 && friction_ <= 1.0);
  checks_ += stage == Stage::probe || stage == Stage::verify;
  rechecks_ = stage == Stage::recheck ? rechecks_ + 1 : 0;
  BIN_SCENES_ASSERT(rechecks_ <= most_rechecks);
}

Settling::Seen Settling::seen(const HeapView& heap, double time) const {
  return {
      heap,     calm_share * heap.rest_window(), time - begun_, advanced_ - begun_, checks_, rechecks_, time - poured_,
      !ignored_};
}

std::array<double, 4> Settling::ages(const HeapView& heap, double time) const {
  const Seen at = seen(heap, time);
  return {at.calm_s, 0.5 * at.calm_s, at.in_stage - jolt, patience};
}

const Settling::Transition* Settling::next(const HeapView& heap, double time) const {
  if (done()) return nullptr;
  const Seen at = seen(heap, time);
  for (const Transition& t : transitions)
    if (t.from == stage_ && finish_ >= t.least && finish_ <= t.most && t.when(at)) return &t;
  return nullptr;
}

bool Settling::advance(const HeapView& heap, double time) {
  if (done()) return false;
  const Transition* const t = next(heap, time);
  const Seen at = seen(heap, time);
  BIN_SCENES_ASSERT(at.in_stage >= 0.0 && at.last_stage <= at.in_stage && at.since_pour >= 0.0);
  advanced_ = time;
  if (!t) return false;
  checked_s_ = at.in_stage - jolt;
  gave_up_ = t->from == Stage::recheck && t->to == Stage::done && !at.verified();
  enter(t->to, time);
  return true;
}

Phase Settling::phase() const {
  Phase phase = row(stage_).phase;
  phase.friction = friction_;
  return phase;
}

const char* Settling::finish() const {
  if (!done()) return "none";
  switch (last_) {
    case Stage::settle:
      return name_of(Finish::settled);
    case Stage::verify:
    case Stage::recheck:
      return name_of(finish_);
    default:
      return name_of(ignored_ ? Finish::settled : Finish::pressed);
  }
}

}  // namespace bin_scenes
