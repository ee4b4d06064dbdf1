/// Proxies as bytes for the disk cache. The cache checks that the bytes are those once written and the key holds the
/// format version, so reading only guards against running over the end.
#pragma once

#include "bin_scenes/mesh/mesh_loader.hpp"
#include "bin_scenes/part/cache.hpp"
#include "bin_scenes/part/convex_hulls.hpp"
#include "bin_scenes/part/distance_field.hpp"
#include "bin_scenes/part/samples.hpp"
#include "bin_scenes/part/spheres.hpp"

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace bin_scenes {

/// Raise it whenever a layout below or the construction of a proxy changes: older cache files are then passed over.
constexpr int part_format = 7;

class ByteWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    put_raw(&value, sizeof value);
  }
  void put(const Vec3& v) { put_raw(v.data(), 3 * sizeof(double)); }
  void put(const std::string& text) {
    put(static_cast<std::uint64_t>(text.size()));
    put_raw(text.data(), text.size());
  }
  void put_raw(const void* data, std::size_t size) {
    if (size == 0) return;
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// After running over the end every read gives zeros, and ok() is false.
class ByteReader {
 public:
  explicit ByteReader(const CachedBytes& bytes) : bytes_(bytes) {}

  template <class T>
  void get(T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    get_raw(&value, sizeof value);
  }
  void get(Vec3& v) { get_raw(v.data(), 3 * sizeof(double)); }
  void get(bool& value) {  // a bool of any other byte would be neither true nor false
    std::uint8_t byte = 0;
    get(byte);
    ok_ = ok_ && byte <= 1;
    value = byte == 1;
  }
  void get(std::string& text) {
    text.resize(count(1));
    get_raw(text.data(), text.size());
  }
  /// A number of elements of at least `element` bytes each; never more than the bytes left can hold.
  std::size_t count(std::size_t element) {
    std::uint64_t n = 0;
    get(n);
    if (n > (bytes_.size() - at_) / element) ok_ = false;
    return ok_ ? static_cast<std::size_t>(n) : 0;
  }
  void get_raw(void* data, std::size_t size) {
    ok_ = ok_ && size <= bytes_.size() - at_;
    if (size == 0) return;
    if (!ok_) {
      std::memset(data, 0, size);
      return;
    }
    std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  bool ok() const { return ok_; }
  bool complete() const { return ok_ && at_ == bytes_.size(); }

 private:
  const CachedBytes& bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

void put(ByteWriter& out, const Mesh& mesh);
void put(ByteWriter& out, const LoadedMesh& loaded);
void put(ByteWriter& out, const DistanceField& field);
void put(ByteWriter& out, const SampleSet& set);
void put(ByteWriter& out, const SphereSet& set);
void put(ByteWriter& out, const ConvexHulls& set);

void get(ByteReader& in, Mesh& mesh);
void get(ByteReader& in, LoadedMesh& loaded);
void get(ByteReader& in, DistanceField& field);
void get(ByteReader& in, SampleSet& set);
void get(ByteReader& in, SphereSet& set);
void get(ByteReader& in, ConvexHulls& set);

}  // namespace bin_scenes
