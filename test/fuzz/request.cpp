/// A request file. What is read is written and read again, and has to be the same request.
#include "bin_scenes/config/request_reader.hpp"
#include "fuzz.hpp"

#include <fstream>

using namespace bin_scenes;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const FuzzFolder folder;
  static const bool made = static_cast<bool>(std::ofstream(folder.path / "a.stl") << "solid a\nendsolid\n");
  if (!made) found("the model cannot be written");
  PathRules rules;
  rules.roots = {folder.path.string()};
  may_refuse([&] {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const Request request = read_request_text(text, folder.path.string(), {}, rules);
    const std::string written = write_request(request);
    try {
      if (write_request(read_request_text(written, folder.path.string(), {}, rules)) != written)
        found("a request that changes when it is written and read");
    } catch (const Error& error) {
      found(std::string("a request that is written but not read: ") + error.what());
    }
  });
  return 0;
}
