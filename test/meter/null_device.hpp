/// A device that takes no time: it answers what the host reads, and computes nothing. The answers were recorded while a
/// real device computed one world. So the host takes the same decisions as beside a real device, and what a run costs
/// is what the host costs.
///
/// libepoxy calls OpenGL through pointers; a null device puts its own functions there for as long as it lives. One at a
/// time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes::meter {

/// What was read back of each buffer of one world, in turn, by the label of the buffer.
using Tape = std::map<std::string, std::vector<std::vector<unsigned char>>>;

/// Copies to the host that were asked for.
struct Reads {
  std::uint64_t copies = 0, bytes = 0;
};

class NullDevice {
 public:
  /// Records what the device in use answers. It waits for the device at each copy, and makes the run slow.
  NullDevice();
  /// Answers from a tape. A world reads its own place of a buffer, so that any number of worlds can be answered: the
  /// n-th read of a place is given the n-th record of the buffer, or zeros behind the end of the tape. Dispatches are
  /// dropped.
  explicit NullDevice(Tape tape);
  ~NullDevice();
  NullDevice(const NullDevice&) = delete;
  NullDevice& operator=(const NullDevice&) = delete;

  const Tape& tape() const { return tape_; }
  const Reads& reads() const { return reads_; }
  /// CPU seconds that answering took: a real device writes its answers itself.
  double cpu_s() const { return cpu_s_; }
  /// Reads for which the tape had no record.
  std::uint64_t unanswered() const { return unanswered_; }

  // What OpenGL is asked for; the functions at the pointers of libepoxy call these.
  bool answers() const { return answers_; }
  void note_mapping(unsigned buffer, void* place) { mapped_[buffer] = static_cast<unsigned char*>(place); }
  bool reaches_host(unsigned buffer) const { return mapped_.count(buffer) != 0; }
  void record(unsigned source, std::ptrdiff_t offset, std::ptrdiff_t bytes);
  void answer(unsigned source, std::ptrdiff_t offset, unsigned target, std::ptrdiff_t at, std::ptrdiff_t bytes);

 private:
  void take_places();

  bool answers_;
  Tape tape_;
  std::map<unsigned, unsigned char*> mapped_;                                ///< buffers that the host sees
  std::map<std::pair<std::string, std::ptrdiff_t>, std::size_t> positions_;  ///< records that a place was given
  Reads reads_;
  double cpu_s_ = 0.0;
  std::uint64_t unanswered_ = 0;
};

}  // namespace bin_scenes::meter
