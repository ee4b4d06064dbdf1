/// Storage buffers (GL_SHADER_STORAGE_BUFFER), which compute passes read and write.
/// Contents are zero after (re)allocation. The driver's limit on the size of a block (128 MiB on llvmpipe) is checked.
#pragma once

#include "bin_scenes/core/assertion.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace bin_scenes::gl {

/// Untyped buffer on the device; sizes and offsets in bytes.
class Storage {
 public:
  explicit Storage(std::string label = "buffer") : label_(std::move(label)) {}
  ~Storage();
  Storage(Storage&& other) noexcept;
  Storage& operator=(Storage&& other) noexcept;

  /// New contents, all zero. Throws an environment Error if the driver's limit on a block is exceeded.
  void allocate(std::size_t bytes);
  /// Makes room for at least `bytes`, keeping the contents; new bytes are zero. Never shrinks.
  void grow(std::size_t bytes);
  void write(std::size_t offset, const void* data, std::size_t bytes);
  /// Waits for the device. See ReadBack for a read that does not.
  void read(std::size_t offset, void* data, std::size_t bytes) const;
  void copy_from(const Storage& source, std::size_t source_offset, std::size_t offset, std::size_t bytes);
  void clear();
  /// Sets `bytes` bytes from `offset` on (both multiples of 4) to copies of one word.
  void fill(std::uint32_t word, std::size_t offset, std::size_t bytes);

  void bind(unsigned binding) const;
  /// A sub-range; `offset` a multiple of the driver's alignment (at most 256).
  void bind(unsigned binding, std::size_t offset, std::size_t bytes) const;
  /// Binds the buffer as the source of indirect dispatches.
  void bind_indirect() const;

  std::size_t bytes() const { return bytes_; }
  unsigned id() const { return id_; }
  const std::string& label() const { return label_; }

 private:
  std::string label_;
  unsigned id_ = 0;
  std::size_t bytes_ = 0;
  bool filled_ = false;  ///< by fill(), and not written since
};

/// `count` elements of one type whose layout in memory is std430's.
template <class T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0, "a buffer holds whole words");

 public:
  explicit Buffer(std::string label = "buffer") : storage_(std::move(label)) {}

  void resize(std::size_t count) { storage_.allocate(count * sizeof(T)), count_ = count; }
  /// Keeps the contents.
  void grow(std::size_t count) {
    if (count > count_) storage_.grow(count * sizeof(T)), count_ = count;
  }
  /// Replaces the contents; reallocates only if the number of elements exceeds the capacity.
  void upload(const std::vector<T>& values) {
    if (values.size() > count_) resize(values.size());
    upload(0, values.data(), values.size());
  }
  void upload(std::size_t first, const T* values, std::size_t count) {
    BIN_SCENES_ASSERT(first + count <= count_);
    storage_.write(first * sizeof(T), values, count * sizeof(T));
  }
  std::vector<T> download() const { return download(0, count_); }
  std::vector<T> download(std::size_t first, std::size_t count) const {
    BIN_SCENES_ASSERT(first + count <= count_);
    std::vector<T> values(count);
    storage_.read(first * sizeof(T), values.data(), count * sizeof(T));
    return values;
  }
  void clear() { storage_.clear(); }
  void fill(std::uint32_t word, std::size_t first, std::size_t count) {
    storage_.fill(word, first * sizeof(T), count * sizeof(T));
  }
  void bind(unsigned binding) const { storage_.bind(binding); }
  void bind(unsigned binding, std::size_t first, std::size_t count) const {
    storage_.bind(binding, first * sizeof(T), count * sizeof(T));
  }

  std::size_t size() const { return count_; }
  const Storage& storage() const { return storage_; }
  Storage& storage() { return storage_; }

 private:
  Storage storage_;
  std::size_t count_ = 0;
};

/// Copies ranges of buffers to the host without stalling: request() starts the copy, ready() returns whether it has
/// finished.
class ReadBack {
 public:
  struct Range {
    const Storage* source;
    std::size_t offset, bytes;
  };

  explicit ReadBack(std::size_t bytes = 0) { make_room(bytes); }
  ~ReadBack();
  ReadBack(const ReadBack&) = delete;
  ReadBack& operator=(const ReadBack&) = delete;

  void request(const Storage& source, std::size_t offset, std::size_t bytes) { request({{&source, offset, bytes}}); }
  /// Ranges are stored one behind the other; adjacent ranges of one buffer are one copy.
  void request(const std::vector<Range>& ranges);
  bool pending() const { return fence_ != nullptr; }
  bool ready() const;  ///< never waits
  const void* wait();  ///< waits if necessary; valid until the next request()
  template <class T>
  const T& wait_as() {
    return *static_cast<const T*>(wait());
  }

 private:
  void make_room(std::size_t bytes);
  void free();

  unsigned id_ = 0;
  std::size_t bytes_ = 0;
  const void* mapped_ = nullptr;
  void* fence_ = nullptr;
};

}  // namespace bin_scenes::gl
