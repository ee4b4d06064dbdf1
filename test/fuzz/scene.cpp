/// scene.json, as `pour.scene` and a resumed job read it. What is read is written and read again, and has to be the
/// same scene.
#include "bin_scenes/output/scene_writer.hpp"
#include "fuzz.hpp"

#include <fstream>

using namespace bin_scenes;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const FuzzFolder folder;
  const std::string path = (folder.path / "scene.json").string();
  const auto read = [&](const char* text, std::size_t length) {
    std::ofstream(path, std::ios::binary).write(text, static_cast<std::streamsize>(length));
    return read_scene_json(path);
  };
  may_refuse([&] {
    const Scene scene = read(reinterpret_cast<const char*>(data), size);
    LoadedRequest loaded;
    loaded.request.parts.resize(scene.model_sha256.size());
    const std::string written = scene_json(scene, loaded);
    if (scene_json(read(written.data(), written.size()), loaded) != written)
      found("a scene that changes when it is written and read");
  });
  return 0;
}
