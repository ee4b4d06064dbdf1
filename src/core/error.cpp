#include "bin_scenes/core/error.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/formatted.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

/// Bytes of one character of UTF-8 at `at` that a terminal can show; 0: a control character, or no UTF-8.
std::size_t shown_bytes(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 && first < 0xf5 ? 4 : first >= 0xe0 && first < 0xf0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if (byte(at + i) < 0x80 || byte(at + i) > 0xbf) return 0;
  return first == 0xc2 && byte(at + 1) < 0xa0 ? 0 : length;  // U+0080 to U+009F are control characters too
}

std::string escaped(unsigned char byte) {
  if (byte == '\n') return "\\n";
  if (byte == '\t') return "\\t";
  return formatted("\\x%02x", byte);
}

/// The text from `from` on as a terminal can show it; of what is longer than `most` bytes the first ones, and not
/// whole.
struct Shown {
  std::string text;
  bool whole = true;
};
Shown shown(const std::string& text, std::size_t from, std::size_t most) {
  Shown line;
  while (from < text.size()) {
    const std::size_t length = shown_bytes(text, from);
    const std::string piece = length > 0 ? text.substr(from, length) : escaped(static_cast<unsigned char>(text[from]));
    if (line.text.size() + piece.size() > most) return {line.text, false};
    line.text += piece;
    from += std::max<std::size_t>(1, length);
  }
  return line;
}

/// One line of at most `most` bytes: what a file or a request put in is shown as text, without its centre if it is
/// long.
std::string line_of(const std::string& text, std::size_t most) {
  const Shown all = shown(text, 0, most);
  if (all.whole) return all.text;
  const std::string gap = " ... ";
  std::string end;
  for (std::size_t left = most / 3; end.empty() && left > 1; left /= 2) {  // what is escaped gets longer
    std::size_t from = text.size() - std::min(left, text.size());
    while (from < text.size() && (static_cast<unsigned char>(text[from]) & 0xc0) == 0x80) ++from;
    const Shown tail = shown(text, from, most / 3);
    if (tail.whole) end = tail.text;
  }
  return shown(text, 0, most - end.size() - gap.size()).text + gap + end;
}

bool what_is_one_line(const std::string& text) {
  return text.size() < 1024 && text.find('\n') == std::string::npos;
}

std::string sentence(const std::string& what, const std::string& where, const std::string& remedy) {
  std::string text = where.empty() ? "" : line_of(where, 280) + ": ";
  text += line_of(what, 400);
  if (!remedy.empty()) text += " (" + line_of(remedy, 280) + ")";
  return text;
}
}  // namespace

Error::Error(ErrorKind kind, const std::string& what, const std::string& where, const std::string& remedy)
    : std::runtime_error(sentence(what, where, remedy)), kind_(kind), problem_(what), where_(where), remedy_(remedy) {
  BIN_SCENES_ASSERT(!problem_.empty() && what_is_one_line(std::runtime_error::what()));
}

}  // namespace bin_scenes
