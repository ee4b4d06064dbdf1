/// Writes structs as bytes and reads them back, for the disk cache and for the results of contained processes. The
/// members of a struct are listed once, and a stream writes or reads them in this order:
///
///     template <class Stream>
///     void members(Stream& stream, Sphere& sphere) {
///       stream(sphere.center, sphere.radius);
///     }
///
/// Both sides are the same program on the same machine, so the byte order is that of the machine. Files for other
/// programs are not written in this format.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace bin_scenes {

/// True if a type has no padding and no pointers, so that a list of such values is copied with one call.
template <class T>
struct IsPlain : std::bool_constant<(std::is_arithmetic_v<T> || std::is_enum_v<T>)&&!std::is_same_v<T, bool>> {};
template <>
struct IsPlain<Vec3> : std::true_type {};
template <class T, std::size_t size>
struct IsPlain<std::array<T, size>> : IsPlain<T> {};

/// Base class of the writer and the reader: calls members() for structs and handles lists and texts.
template <class Stream>
class ByteStream {
 public:
  template <class... Values>
  void operator()(Values&... values) {
    (value(values), ...);
  }
  /// Writes or reads a list whose items are copied byte by byte.
  template <class Item>
  void raw_list(std::vector<Item>& list) {
    self().size(list, sizeof(Item));
    self().raw(list.data(), list.size() * sizeof(Item));
  }

 private:
  Stream& self() { return static_cast<Stream&>(*this); }

  template <class T>
  void value(T& value) {
    if constexpr (IsPlain<T>::value)
      self().raw(&value, sizeof value);
    else if constexpr (std::is_same_v<T, bool>)
      self().flag(value);
    else
      members(self(), value);
  }
  void value(std::string& text) {
    self().size(text, 1);
    self().raw(text.data(), text.size());
  }
  template <class Item>
  void value(std::vector<Item>& list) {
    if constexpr (IsPlain<Item>::value) return raw_list(list);
    self().size(list, sizeof(std::uint64_t));  // no struct that is listed takes less
    for (Item& item : list) value(item);
  }
};

/// @tparam Buffer  container of bytes: std::string, or std::vector<std::uint8_t>
template <class Buffer>
class WriterInto : public ByteStream<WriterInto<Buffer>> {
 public:
  void raw(const void* data, std::size_t size) {
    if (size == 0) return;
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  void flag(bool value) { raw(&value, 1); }
  template <class List>
  void size(const List& list, std::size_t /*item*/) {
    const std::uint64_t n = list.size();
    raw(&n, sizeof n);
  }
  bool ok() const { return true; }
  Buffer take() { return std::move(bytes_); }

 private:
  Buffer bytes_;
};

/// Reads the bytes that WriterInto wrote. Once a read exceeds the end, every read returns zeros, and ok() is false.
class ByteReader : public ByteStream<ByteReader> {
 public:
  /// @param bytes  has data() and size(), and must outlive this object
  template <class Bytes>
  explicit ByteReader(const Bytes& bytes)
      : at_(reinterpret_cast<const std::uint8_t*>(bytes.data())), left_(bytes.size()) {}

  void raw(void* data, std::size_t size) {
    ok_ = ok_ && size <= left_;
    if (size == 0) return;
    if (!ok_) {
      std::memset(data, 0, size);
      return;
    }
    std::memcpy(data, at_, size);
    at_ += size;
    left_ -= size;
  }
  void flag(bool& value) {  // a bool of any other byte would be neither true nor false
    std::uint8_t byte = 0;
    raw(&byte, 1);
    ok_ = ok_ && byte <= 1;
    value = byte == 1;
  }
  /// Reads the length of a list and resizes the list. If too few bytes remain for that many items, ok() becomes false.
  template <class List>
  void size(List& list, std::size_t item) {
    std::uint64_t n = 0;
    raw(&n, sizeof n);
    if (n > left_ / item) ok_ = false;
    list.resize(ok_ ? static_cast<std::size_t>(n) : 0);
  }
  bool ok() const { return ok_; }
  bool complete() const { return ok_ && left_ == 0; }

 private:
  const std::uint8_t* at_;
  std::size_t left_;
  bool ok_ = true;
};

}  // namespace bin_scenes
