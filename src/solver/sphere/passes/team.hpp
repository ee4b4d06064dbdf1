/// Runs loops of a few microseconds in several threads: the colors of a large block. A parallel loop of the task
/// scheduler would cost as much as such a color takes. Here, helper threads wait for the next loop and claim pieces of
/// it with one atomic ticket.
///
/// The leading thread never waits for a helper to arrive, only for pieces that a helper has claimed: without helpers,
/// it does all the work itself.
#pragma once

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

namespace bin_scenes::sphere {

class Team {
 public:
  /// Runs `lead()` with this team; until it returns, up to `helpers` other threads of the arena help.
  template <class Lead>
  void run(int helpers, const Lead& lead) {
    tbb::task_group group;
    helped_ = helpers > 0;
    over_ = false;
    for (int k = 0; k < helpers; ++k) group.run([this] { help(); });
    struct End {  // also if it is cancelled
      Team& team;
      tbb::task_group& group;
      ~End() {
        team.over_ = true;
        group.wait();
      }
    } end{*this, group};
    lead();
  }

  /// Calls `work(first, last)` for pieces of the range 0 to `count`, in any order, and returns when all are done.
  template <class Work>
  void share(std::uint32_t count, std::uint32_t grain, const Work& work) {
    if (!helped_ || count <= grain) {
      if (count > 0) work(std::uint32_t{0}, count);
      return;
    }
    call_ = [](const void* what, std::uint32_t first, std::uint32_t last) {
      (*static_cast<const Work*>(what))(first, last);
    };
    work_ = &work;
    grain_ = grain;
    count_ = count;
    done_.store(0, std::memory_order_relaxed);
    ticket_.store((ticket_.load(std::memory_order_relaxed) & ~std::uint64_t{0xffffffff}) + next_loop + count,
                  std::memory_order_release);
    while (claim()) {
    }
    for (int k = 0; done_.load(std::memory_order_acquire) != count; ++k) pause(k);
  }

 private:
  // The ticket contains the number of the loop and, in its lower 32 bits, how much of the loop is not claimed yet.
  static constexpr std::uint64_t next_loop = std::uint64_t{1} << 32;

  /// Executes a piece of the loop, if one is left. The loop's function and range do not change until the piece is done.
  bool claim() {
    std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
    while (const auto left = static_cast<std::uint32_t>(ticket)) {
      // A stale grain can only be read with a stale ticket, which the exchange refuses.
      const std::uint32_t grain = grain_.load(std::memory_order_relaxed), piece = std::min(left, grain);
      if (!ticket_.compare_exchange_weak(ticket, ticket - piece, std::memory_order_acq_rel)) continue;
      const std::uint32_t first = count_.load(std::memory_order_relaxed) - left;
      call_.load(std::memory_order_relaxed)(work_.load(std::memory_order_relaxed), first, first + piece);
      done_.fetch_add(piece, std::memory_order_release);
      return true;
    }
    return false;
  }

  void help() {
    for (int k = 0; !over_.load(std::memory_order_relaxed);) {
      if (claim())
        k = 0;
      else
        pause(k++);
    }
  }

  /// Waits a little; the longer it has waited, the more it leaves the processor to others.
  static void pause(int waited) {
    constexpr int most = 2000;
    if (waited >= most) return std::this_thread::yield();
#ifdef __x86_64__
    __builtin_ia32_pause();
#endif
  }

  using Call = void (*)(const void*, std::uint32_t, std::uint32_t);
  bool helped_ = false;
  std::atomic<bool> over_{false};
  std::atomic<std::uint64_t> ticket_{0};
  std::atomic<std::uint32_t> done_{0}, grain_{1}, count_{0};
  std::atomic<const void*> work_{nullptr};
  std::atomic<Call> call_{nullptr};
};

}  // namespace bin_scenes::sphere
