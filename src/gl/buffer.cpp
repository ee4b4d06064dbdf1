/// Allocation, growth and copies of storage buffers, and read-backs that do not stop the device. Sizes are checked
/// against the driver's limit.
#include "bin_scenes/gl/buffer.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/traffic.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

namespace bin_scenes::gl {

namespace {
constexpr int longest_wait_s = 600;  // software OpenGL on a busy machine takes minutes for a large step

Error lost(const std::string& what) {
  Device::current().lose();
  return environment_error("the OpenGL device " + what, Device::current().renderer(),
                           "make the scene again, from its parts on; solver.sphere.device: cpu needs no such device");
}

/// Behind what passes wrote there.
void update_barrier() {
  BIN_SCENES_ASSERT(Device::is_current());
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  ++traffic().barriers;
}
}  // namespace

Storage::~Storage() {
  if (id_) glDeleteBuffers(1, &id_);
}

Storage::Storage(Storage&& other) noexcept
    : label_(std::move(other.label_)),
      id_(std::exchange(other.id_, 0)),
      bytes_(std::exchange(other.bytes_, 0)),
      filled_(other.filled_) {}

Storage& Storage::operator=(Storage&& other) noexcept {
  std::swap(label_, other.label_);
  std::swap(id_, other.id_);
  std::swap(bytes_, other.bytes_);
  std::swap(filled_, other.filled_);
  return *this;
}

void Storage::allocate(std::size_t bytes) {
  bytes = std::max<std::size_t>(bytes, 16);  // an empty buffer can not be bound
  const long long limit = Device::current().limits().storage_bytes;
  if (bytes > static_cast<std::size_t>(limit))
    throw environment_error("GPU buffer '" + label_ + "' needs " + std::to_string(bytes >> 20) +
                                " MiB, but the driver allows " + std::to_string(limit >> 20) + " MiB per buffer",
                            Device::current().renderer(), "use fewer or coarser parts, or fewer scenes at once");
  if (id_) glDeleteBuffers(1, &id_), id_ = 0;
  while (glGetError() != GL_NO_ERROR) {
  }
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  if (glGetError() == GL_OUT_OF_MEMORY)
    throw environment_error(
        "out of device memory: GPU buffer '" + label_ + "' needs " + std::to_string(bytes >> 20) + " MiB",
        Device::current().renderer(), "use fewer parts or fewer scenes at once");
  glObjectLabel(GL_BUFFER, id_, static_cast<GLsizei>(label_.size()), label_.data());
  BIN_SCENES_ASSERT(id_ != 0 && bytes % 4 == 0);
  bytes_ = bytes;
  clear();
}

void Storage::grow(std::size_t bytes) {
  if (bytes <= bytes_) return;
  Storage larger(label_);
  larger.allocate(bytes);
  if (bytes_) larger.copy_from(*this, 0, 0, bytes_);
  *this = std::move(larger);
}

void Storage::write(std::size_t offset, const void* data, std::size_t bytes) {
  BIN_SCENES_ASSERT(offset + bytes <= bytes_);
  if (!bytes) return;
  update_barrier();
  // On NVIDIA (driver 580.159) a clear that is still running would undo a write of 80 kB that was asked for after it.
  if (std::exchange(filled_, false)) glFinish();
  traffic().bytes_uploaded += bytes;
  glNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Storage::read(std::size_t offset, void* data, std::size_t bytes) const {
  BIN_SCENES_ASSERT(offset + bytes <= bytes_);
  if (!bytes) return;
  // Not glGetNamedBufferSubData: NVIDIA's (driver 580.159) returns what was read before when the buffer has held the
  // arguments of the dispatch that wrote to it.
  ReadBack back;
  back.request(*this, offset, bytes);
  std::memcpy(data, back.wait(), bytes);
}

void Storage::copy_from(const Storage& source, std::size_t source_offset, std::size_t offset, std::size_t bytes) {
  BIN_SCENES_ASSERT(source_offset + bytes <= source.bytes_ && offset + bytes <= bytes_);
  if (!bytes) return;
  update_barrier();
  glCopyNamedBufferSubData(source.id_, id_, static_cast<GLintptr>(source_offset), static_cast<GLintptr>(offset),
                           static_cast<GLsizeiptr>(bytes));
}

void Storage::clear() {
  fill(0, 0, bytes_);
}

void Storage::fill(std::uint32_t word, std::size_t offset, std::size_t bytes) {
  BIN_SCENES_ASSERT(offset % 4 == 0 && bytes % 4 == 0 && offset + bytes <= bytes_);
  if (!bytes) return;
  update_barrier();
  glClearNamedBufferSubData(id_, GL_R32UI, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
                            GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
  filled_ = true;
}

void Storage::bind(unsigned binding) const {
  BIN_SCENES_ASSERT(Device::is_current());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}

void Storage::bind(unsigned binding, std::size_t offset, std::size_t bytes) const {
  BIN_SCENES_ASSERT(id_ != 0 && offset + bytes <= bytes_ && Device::is_current());
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, id_, static_cast<GLintptr>(offset),
                    static_cast<GLsizeiptr>(bytes));
}

void Storage::bind_indirect() const {
  BIN_SCENES_ASSERT(id_ != 0 && bytes_ >= 12 && Device::is_current());
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, id_);
}

void ReadBack::make_room(std::size_t bytes) {
  if (bytes <= bytes_) return;
  free();
  constexpr GLbitfield flags = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(bytes), nullptr, flags | GL_CLIENT_STORAGE_BIT);
  mapped_ = glMapNamedBufferRange(id_, 0, static_cast<GLsizeiptr>(bytes), flags);
  bytes_ = bytes;
}

void ReadBack::free() {
  if (fence_) glDeleteSync(static_cast<GLsync>(fence_));
  if (id_) glDeleteBuffers(1, &id_);
  fence_ = nullptr;
  id_ = 0;
}

ReadBack::~ReadBack() {
  free();
}

void ReadBack::request(const std::vector<Range>& ranges) {
  BIN_SCENES_ASSERT(each_is(ranges, [](const Range& range) { return range.source && range.source->id() != 0; }));
  std::size_t sum = 0;
  for (const Range& range : ranges) sum += range.bytes;
  make_room(sum);
  if (fence_) glDeleteSync(static_cast<GLsync>(fence_));
  update_barrier();
  std::size_t at = 0;
  for (std::size_t i = 0; i < ranges.size();) {
    Range whole = ranges[i++];
    for (; i < ranges.size() && ranges[i].source == whole.source && ranges[i].offset == whole.offset + whole.bytes; ++i)
      whole.bytes += ranges[i].bytes;
    BIN_SCENES_ASSERT(whole.offset + whole.bytes <= whole.source->bytes());
    glCopyNamedBufferSubData(whole.source->id(), id_, static_cast<GLintptr>(whole.offset), static_cast<GLintptr>(at),
                             static_cast<GLsizeiptr>(whole.bytes));
    at += whole.bytes;
  }
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  ++traffic().barriers;
  traffic().bytes_read_back += sum;
  fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  if (!fence_) throw lost("has lost its work");
  glFlush();
}

const void* ReadBack::wait() {
  if (fence_) {
    constexpr GLuint64 second = 1000000000;
    for (int waited = 0;; ++waited) {
      const GLenum state = glClientWaitSync(static_cast<GLsync>(fence_), GL_SYNC_FLUSH_COMMANDS_BIT, second);
      if (state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED) break;
      if (state == GL_WAIT_FAILED || glGetGraphicsResetStatus() != GL_NO_ERROR) throw lost("has lost its work");
      if (waited >= longest_wait_s) throw lost("has not answered for " + std::to_string(longest_wait_s) + " s");
    }
    glDeleteSync(static_cast<GLsync>(fence_));
    fence_ = nullptr;
  }
  return mapped_;
}

}  // namespace bin_scenes::gl
