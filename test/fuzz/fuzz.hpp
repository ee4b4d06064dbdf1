/// What all fuzzers share. A fuzzer is one file with one function, LLVMFuzzerTestOneInput: libFuzzer links it as
/// fuzz_<name>, and the test fuzz_corpus_<name> replays its corpus, an archive, in an ordinary build.
#pragma once

#include "bin_scenes/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace bin_scenes {

/// Ends the fuzzer, which keeps the input.
[[noreturn]] inline void found(const std::string& what) {
  std::fprintf(stderr, "found: %s\n", what.c_str());
  std::abort();
}

/// Runs what may refuse its input. Any exception but Error ends the fuzzer, as does a message that is not one printable
/// line below 1 kB.
template <class Work>
void may_refuse(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.size() >= 1000) found("a message of " + std::to_string(message.size()) + " bytes");
    for (const unsigned char c : message)
      if (c < 0x20 || c == 0x7f) found("a message that is not printable: " + message);
  }
}

/// A folder for the files of this process, removed when it ends.
class FuzzFolder {
 public:
  FuzzFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "bin_scenes_fuzz_XXXXXX").string();
    if (!mkdtemp(name.data())) found("no temporary folder");
    path = name;
  }
  ~FuzzFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::filesystem::path path;
};

}  // namespace bin_scenes
