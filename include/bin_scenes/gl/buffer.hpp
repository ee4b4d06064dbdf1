/// Storage buffers (GL_SHADER_STORAGE_BUFFER), which compute passes read and write. New contents are zero. The driver's
/// limit on the size of a buffer (128 MiB on llvmpipe) is checked on allocation. All functions must be called on the
/// thread whose context is current (gl/device.hpp).
#pragma once

#include "bin_scenes/core/assertion.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace bin_scenes::gl {

/// A buffer on the device without an element type. Sizes and offsets are in bytes.
class Storage {
 public:
  explicit Storage(std::string label = "buffer") : label_(std::move(label)) {}
  ~Storage();
  Storage(Storage&& other) noexcept;
  Storage& operator=(Storage&& other) noexcept;

  /// Replaces the contents by `bytes` zeros. Throws an environment Error if the driver's limit is exceeded.
  void allocate(std::size_t bytes);
  /// Enlarges the buffer to at least `bytes` and keeps its contents; the new bytes are zero. It never shrinks.
  void grow(std::size_t bytes);
  void write(std::size_t offset, const void* data, std::size_t bytes);
  /// Copies a range to the host and waits for the device. ReadBack is a read that does not wait.
  void read(std::size_t offset, void* data, std::size_t bytes) const;
  void copy_from(const Storage& source, std::size_t source_offset, std::size_t offset, std::size_t bytes);
  void clear();
  /// Fills `bytes` bytes from `offset` on with copies of one word; both are multiples of 4.
  void fill(std::uint32_t word, std::size_t offset, std::size_t bytes);

  void bind(unsigned binding) const;
  /// Binds a part of the buffer. `offset` is a multiple of the driver's alignment (at most 256).
  void bind(unsigned binding, std::size_t offset, std::size_t bytes) const;
  /// Binds the buffer as the source of indirect dispatches.
  void bind_indirect() const;

  std::size_t bytes() const { return bytes_; }
  unsigned id() const { return id_; }

 private:
  std::string label_;
  unsigned id_ = 0;
  std::size_t bytes_ = 0;
  bool filled_ = false;  ///< filled by fill(), and not written since
};

/// A buffer of `count` elements of one type, whose layout in memory must be that of std430.
template <class T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0, "a buffer holds whole words");

 public:
  explicit Buffer(std::string label = "buffer") : storage_(std::move(label)) {}

  void resize(std::size_t count) { storage_.allocate(count * sizeof(T)), count_ = count; }
  /// Enlarges the buffer and keeps its contents.
  void grow(std::size_t count) {
    if (count > count_) storage_.grow(count * sizeof(T)), count_ = count;
  }
  /// Replaces the contents. It reallocates only if the number of elements exceeds the capacity.
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

/// Copies ranges of buffers to the host: request() starts the copy, and wait() waits for its end.
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
  /// Starts the copy. The ranges follow each other in the result; adjacent ranges of one buffer are one copy.
  void request(const std::vector<Range>& ranges);
  const void* wait();  ///< waits if necessary; the data are valid until the next request()
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
