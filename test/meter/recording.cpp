#include "meter/recording.hpp"

#include "races/referee.hpp"

#include <zlib.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace bin_scenes::meter {

namespace {

using races::Memory;

/// Everything as words and counted strings, one after the other.
class Writer {
 public:
  void number(std::size_t value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void text(const std::string& value) {
    number(value.size());
    bytes_ += value;
  }
  void words(const std::vector<Word>& values) {
    number(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Word));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  std::size_t number() {
    std::size_t value = 0;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }
  std::string text() {
    const std::size_t size = number();
    return std::string(take(size), size);
  }
  std::vector<Word> words() {
    std::vector<Word> values(number());
    std::memcpy(values.data(), take(values.size() * sizeof(Word)), values.size() * sizeof(Word));
    return values;
  }

 private:
  const char* take(std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("a recorded dispatch that is cut short");
    at_ += size;
    return bytes_.data() + at_ - size;
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
};

/// The interpreter that looks for races notes who touches each word.
std::vector<Memory> with_touched_words(const Taken& taken) {
  const races::Module module = races::compile(taken.source, taken.pass);
  std::vector<Memory> memory = taken.buffers;
  for (Memory& m : memory) m.watch();
  races::Referee referee;
  races::run(taken.dispatch(module, memory), referee);
  std::vector<Memory> kept = taken.buffers;
  for (std::size_t k = 0; k < kept.size(); ++k)
    for (std::size_t w = 0; w < kept[k].words.size(); ++w) {
      const races::Marks& marks = memory[k].marks[w];
      const bool touched = marks.written.dispatch || marks.read[0].dispatch || marks.atomic[0].dispatch;
      if (!touched) kept[k].words[w] = 0;
    }
  return kept;
}

}  // namespace

void save(const Taken& taken, const std::string& file) {
  Writer out;
  out.text(taken.pass);
  out.text(taken.source);
  for (const Word n : taken.groups) out.number(n);
  out.number(taken.uniforms.size());
  for (const auto& [name, bits] : taken.uniforms) out.text(name), out.number(bits);
  out.number(taken.buffers.size());
  for (const Memory& memory : with_touched_words(taken)) out.text(memory.name), out.words(memory.words);
  out.number(taken.bound.size());
  for (const std::size_t index : taken.bound) out.number(index);

  uLongf size = compressBound(out.bytes().size());
  std::string packed(sizeof(std::size_t) + size, '\0');
  const std::size_t plain = out.bytes().size();
  std::memcpy(packed.data(), &plain, sizeof plain);
  compress2(reinterpret_cast<Bytef*>(packed.data() + sizeof plain), &size,
            reinterpret_cast<const Bytef*>(out.bytes().data()), plain, Z_BEST_COMPRESSION);
  std::ofstream(file, std::ios::binary).write(packed.data(), static_cast<std::streamsize>(sizeof plain + size));
}

Taken load(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string packed((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  std::size_t plain = 0;
  if (packed.size() <= sizeof plain) throw std::runtime_error("no recorded dispatch: " + file);
  std::memcpy(&plain, packed.data(), sizeof plain);
  std::string bytes(plain, '\0');
  uLongf size = plain;
  const int code =
      uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                 reinterpret_cast<const Bytef*>(packed.data() + sizeof plain), packed.size() - sizeof plain);
  if (code != Z_OK || size != plain) throw std::runtime_error("a damaged recorded dispatch: " + file);

  Reader in(bytes);
  Taken taken;
  taken.pass = in.text();
  taken.source = in.text();
  for (Word& n : taken.groups) n = static_cast<Word>(in.number());
  for (std::size_t left = in.number(); left > 0; --left) {
    const std::string name = in.text();
    taken.uniforms[name] = static_cast<Word>(in.number());
  }
  for (std::size_t left = in.number(); left > 0; --left) {
    const std::string name = in.text();
    taken.buffers.push_back({name, in.words(), {}});
  }
  for (std::size_t left = in.number(); left > 0; --left) taken.bound.push_back(in.number());
  return taken;
}

}  // namespace bin_scenes::meter
