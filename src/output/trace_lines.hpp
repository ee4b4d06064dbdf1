/// Writes a trace as lines of JSON (.jsonl), with contacts, for the time slider of `bin_scenes view --trace`. The first
/// line names the format; each further line is one sample. A line is short and complete in itself, so that a long trace
/// needs no memory.
#pragma once

#include "bin_scenes/output/trace.hpp"
#include "output/whole_file.hpp"

namespace bin_scenes {

extern const char* const trace_lines_format;  ///< value of "format" in the first line

/// A sample is {"time": s, "parts": [[id, x, y, z, qx, qy, qz, qw], ...], "contacts": [[a, b, point x, y, z, normal x,
/// y, z, force x, y, z, action], ...]}: poses of model frames and contacts in the bin frame, SI units; b is -1 for the
/// bin, and action is the number of a ContactAction. Parts that have not entered the bin are left out.
class TraceLines final : public Trace {
 public:
  explicit TraceLines(const std::string& path);
  bool shows_contacts() const override { return true; }
  /// Writes the first line with the weight (N) of the lightest part, by which the page scales the arrows of forces.
  void begin(const LoadedRequest& loaded) override;
  void add(const TraceSample& sample) override;
  void finish() override { file_.commit(); }

 private:
  void write(const std::string& line);

  WholeFile file_;
};

}  // namespace bin_scenes
