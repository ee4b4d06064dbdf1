/// Formats by name and by content, and counts that a header promises against the size of the file.
#include "model_format.hpp"

#include "bin_scenes/core/error.hpp"

#include <iconv.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <vector>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

bool starts_with(const std::string& bytes, const std::string& text) {
  return bytes.compare(0, text.size(), text) == 0;
}

/// STL in binary: 80 bytes, a count, 50 bytes a triangle. Its length gives it away even where the header says "solid".
std::optional<std::uint32_t> binary_stl_count(const std::string& bytes) {
  if (bytes.size() < 84) return std::nullopt;
  std::uint32_t count;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}
bool is_binary_stl(const std::string& bytes) {
  const auto count = binary_stl_count(bytes);
  return count && bytes.size() == 84 + 50 * static_cast<std::size_t>(*count);
}

/// Lines of 80 characters, of which the 73rd names the section, and the first section is the start.
bool is_iges(const std::string& bytes) {
  return bytes.size() > 80 && bytes.find_first_of("\r\n") == 80 && bytes[72] == 'S' &&
         std::atoi(bytes.substr(73, 7).c_str()) == 1;
}

void check_counts_of_off(const std::string& bytes, const std::string& path) {
  std::uint64_t promised = 0;
  std::istringstream text(bytes.substr(0, 65536));
  std::string word;
  std::vector<std::string> words;
  while (words.size() < 3 && text >> word) {
    if (word[0] == '#') {
      std::getline(text, word);
    } else if (std::isdigit(static_cast<unsigned char>(word[0])) || word[0] == '-') {
      words.push_back(word);
    }
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(2, words.size()); ++i) {
    if (words[i][0] == '-') throw input_error("negative count in the header: " + words[i], path, "export it again");
    promised += std::min(std::strtoull(words[i].c_str(), nullptr, 10), 1ull << 60);
  }
  // assimp takes each from a line of its own, and aborts where there is none.
  const auto ends = [&](char end) { return std::count(bytes.begin(), bytes.end(), end); };
  const auto lines = static_cast<std::uint64_t>(1 + std::max(ends('\n'), ends('\r')));
  if (promised > lines) {
    throw input_error("the header promises " + words[0] + " vertices and " + (words.size() > 1 ? words[1] : "0") +
                          " faces, but the file has only " + std::to_string(lines) + " lines",
                      path, "the file is damaged or cut off: copy or export it again");
  }
}

void check_counts_of_ply(const std::string& bytes, const std::string& path) {
  std::uint64_t promised = 0;
  std::istringstream text(bytes.substr(0, 65536));
  std::string line;
  const std::string header = bytes.substr(0, 65536);
  if (header.find("\nend_header") == std::string::npos && header.find("\rend_header") == std::string::npos) {
    throw input_error("the file is cut off or damaged: its header has no end in its first 64 KiB", path,
                      "copy or export it again");  // assimp searches it for minutes
  }
  while (std::getline(text, line) && !starts_with(line, "end_header")) {
    std::istringstream words(line);
    std::string keyword, name;
    std::int64_t count = 0;
    if (!(words >> keyword >> name) || keyword != "element") continue;
    if (!(words >> count) || count < 0) {
      throw input_error("bad element count in the header: \"" + line + "\"", path, "export it again");
    }
    promised = std::max<std::uint64_t>(promised, static_cast<std::uint64_t>(count));
  }
  if (promised > bytes.size()) {
    throw input_error("the header promises " + std::to_string(promised) + " elements, but the file has only " +
                          std::to_string(bytes.size()) + " bytes",
                      path, "the file is damaged or cut off: copy or export it again");
  }
}

void check_counts_of_stl(const std::string& bytes, const std::string& path) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && bytes.compare(first, 5, "solid") == 0) return;
  const auto count = binary_stl_count(bytes);
  if (!count) {
    throw input_error("neither an ASCII STL (it does not begin with \"solid\") nor long enough for a binary one", path,
                      "export it again");
  }
  const std::size_t needed = 84 + 50 * static_cast<std::size_t>(*count);
  if (bytes.size() < needed) {
    throw input_error("the file is cut off: its header promises " + std::to_string(*count) + " triangles, " +
                          std::to_string(needed) + " bytes, but it has " + std::to_string(bytes.size()) + " bytes",
                      path, "copy or export it again");
  }
}

}  // namespace

std::string format_of_name(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  for (const char* known : {"STL", "OBJ", "PLY", "DAE", "OFF", "STEP", "IGES"}) {
    if (extension == std::string(".") + known) return known;
  }
  if (extension == ".STP") return "STEP";
  if (extension == ".IGS") return "IGES";
  return {};
}

std::string format_of_content(const std::string& bytes) {
  const std::string start = bytes.substr(0, 4096);
  if (is_binary_stl(bytes)) return "STL";
  if (starts_with(start, "ply\n") || starts_with(start, "ply\r")) return "PLY";
  if (start.find("<COLLADA") != std::string::npos) return "DAE";
  if (starts_with(start, "OFF\n") || starts_with(start, "OFF\r") || starts_with(start, "OFF ")) return "OFF";
  if (is_iges(bytes)) return "IGES";
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && start.compare(first, 12, "ISO-10303-21") == 0) return "STEP";
  if (first != std::string::npos && start.compare(first, 5, "solid") == 0 && start.find("facet") != std::string::npos) {
    return "STL";
  }
  return {};
}

std::optional<std::string> utf8_from_utf16(const std::string& bytes) {
  const bool little = starts_with(bytes, "\xff\xfe"), big = starts_with(bytes, "\xfe\xff");
  if (!little && !big) return std::nullopt;
  const iconv_t converter = iconv_open("UTF-8", little ? "UTF-16LE" : "UTF-16BE");
  if (converter == reinterpret_cast<iconv_t>(-1)) return std::nullopt;
  std::string source = bytes.substr(2), text(2 * bytes.size(), '\0');
  char *in = source.data(), *out = text.data();
  std::size_t in_left = source.size(), out_left = text.size();
  const std::size_t result = iconv(converter, &in, &in_left, &out, &out_left);
  iconv_close(converter);
  if (result == static_cast<std::size_t>(-1)) return std::nullopt;
  text.resize(text.size() - out_left);
  return text;
}

void check_promised_counts(const std::string& bytes, const std::string& format, const std::string& path) {
  if (format == "OFF") check_counts_of_off(bytes, path);
  if (format == "PLY") check_counts_of_ply(bytes, path);
  if (format == "STL") check_counts_of_stl(bytes, path);
}

}  // namespace bin_scenes
