/// What one pass did, added up over its dispatches.
#pragma once

#include "races/module.hpp"

#include <cstdint>
#include <map>
#include <string>

namespace bin_scenes::meter {

using races::Word;

/// 32-byte pieces of memory: what a cache moves at least.
struct Sectors {
  std::uint64_t loaded = 0, stored = 0;
};

/// Of one line of source.
struct LineCost {
  double slots = 0, lane_slots = 0;
};

struct Counts {
  std::uint64_t dispatches = 0, groups = 0, warps = 0;
  double slots = 0;                                  ///< instructions issued, weighted (cost_of)
  double lane_slots = 0;                             ///< the same times the lanes that took part
  std::uint64_t loads = 0, stores = 0, l1_hits = 0;  ///< of buffers, by warp; hits by sector
  Sectors sectors;
  std::uint64_t shared_loads = 0, shared_stores = 0;
  std::uint64_t atomics = 0;                  ///< by warp
  std::uint64_t barriers = 0;                 ///< by group
  std::uint64_t branches = 0, divergent = 0;  ///< conditional ones, by warp; those of which both sides were taken
  double latency = 0, longest = 0;            ///< cycles of all groups, and of the slowest
  double dispatch_us = 0;                     ///< by which the dispatches ended, one after the other
  Word shared_words = 0;                      ///< of a group
  double code_bytes = 0;
  std::map<std::string, Sectors> buffers;
  std::map<std::string, LineCost> lines;  ///< "file:line"

  double lanes() const { return slots > 0 ? lane_slots / slots : 0; }
  double l1_share() const {
    return sectors.loaded ? static_cast<double>(l1_hits) / static_cast<double>(sectors.loaded) : 0;
  }
  /// Bytes between L1 and L2: loads that missed, and stores, which L1 writes through.
  double l2_bytes() const { return 32.0 * static_cast<double>(sectors.loaded - l1_hits + sectors.stored); }
};

}  // namespace bin_scenes::meter
