/// A cache file: the first byte chooses what it should hold. Even numbers give the contents a right header, so that the
/// readers behind it see them; odd ones are the whole file.
#include "bin_scenes/core/cache.hpp"
#include "fuzz.hpp"
#include "part/part_bytes.hpp"

#include <fstream>

using namespace bin_scenes;

namespace {

template <class T>
void read_back(const CachedBytes& bytes) {
  ByteReader in(bytes);
  T value;
  in(value);
  if (!in.complete()) return;
  ByteWriter out;
  out(value);
  if (!(bytes == out.take())) found("contents that change when they are read and written");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const FuzzFolder folder;
  static const bool set = setenv("XDG_CACHE_HOME", folder.path.c_str(), 1) == 0 && unsetenv("BIN_SCENES_CACHE") == 0;
  if (!set || size < 1) return 0;
  const Bytes contents(data + 1, data + size);
  const Cache& cache = Cache::global();
  cache.write("kind", "key", contents);
  if (data[0] % 2 == 1) {
    for (const auto& entry : std::filesystem::directory_iterator(cache.directory()))
      std::ofstream(entry.path(), std::ios::binary)
          .write(reinterpret_cast<const char*>(contents.data()), static_cast<std::streamsize>(contents.size()));
  }
  const std::optional<CachedBytes> bytes = cache.read("kind", "key");
  if (!bytes) return 0;
  switch (data[0] / 2 % 6) {
    case 0:
      read_back<Mesh>(*bytes);
      break;
    case 1:
      read_back<LoadedMesh>(*bytes);
      break;
    case 2:
      read_back<DistanceField>(*bytes);
      break;
    case 3:
      read_back<SampleSet>(*bytes);
      break;
    case 4:
      read_back<SphereSet>(*bytes);
      break;
    default:
      read_back<ConvexHulls>(*bytes);
  }
  return 0;
}
