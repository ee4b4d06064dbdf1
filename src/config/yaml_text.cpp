#include "config/yaml_text.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <istream>
#include <map>
#include <streambuf>
#include <vector>

namespace bin_scenes::config {

namespace {

constexpr std::size_t more_values = 100'000;  ///< that aliases may stand for, beside those written out

/// Hands the text over in pieces, and no further ones once nobody wants them.
class Pieces : public std::streambuf {
 public:
  explicit Pieces(const std::string& text) : text_(text) {}

 protected:
  int_type underflow() override {
    constexpr std::size_t piece = 1 << 16;
    if (at_ == text_.size() || cancelled()) return traits_type::eof();
    char* from = const_cast<char*>(text_.data()) + at_;  // a get area is never written to
    const std::size_t length = std::min(piece, text_.size() - at_);
    at_ += length;
    setg(from, from, from + length);
    return traits_type::to_int_type(*from);
  }

 private:
  const std::string& text_;
  std::size_t at_ = 0;
};

/// Counts the values of a document, those that an alias stands for each time anew.
class Census : public YAML::EventHandler {
 public:
  std::size_t values() const { return total_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t anchor) override { value(anchor); }
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t anchor, const std::string&) override {
    value(anchor);
  }
  void OnAlias(const YAML::Mark&, YAML::anchor_t anchor) override { total_ += sizes_[anchor]; }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(mark, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(mark, anchor);
  }
  void OnMapEnd() override { end(); }
  void OnAnchor(const YAML::Mark&, const std::string&) override {}

 private:
  struct Open {
    YAML::anchor_t anchor;
    std::size_t before;
  };

  void value(YAML::anchor_t anchor) {
    ++total_;
    if (anchor) sizes_[anchor] = 1;
  }
  void begin(const YAML::Mark&, YAML::anchor_t anchor) {
    open_.push_back({anchor, total_++});
    if (anchor) sizes_[anchor] = within_itself;  // until it ends: an alias in it stands for no end of values
  }
  void end() {
    const Open last = open_.back();
    open_.pop_back();
    if (last.anchor) sizes_[last.anchor] = total_ - last.before;
  }

  static constexpr std::size_t within_itself = std::size_t{1} << 40;
  std::size_t total_ = 0;
  std::map<YAML::anchor_t, std::size_t> sizes_;
  std::vector<Open> open_;
};

/// Reads the text once without keeping anything, so that what follows is known to end.
void check_document(const std::string& text, const std::string& file) {
  Pieces pieces(text);
  std::istream in(&pieces);
  YAML::Parser parser(in);
  Census census;
  if (!parser.HandleNextDocument(census)) return;
  if (census.values() > text.size() / 2 + more_values) {
    throw input_error(
        "the aliases of the file expand to more than " + std::to_string(text.size() / 2 + more_values) + " values",
        file, "write the values instead of aliases");
  }
  // The parser takes no token that starts no value, such as a comma, and would find a document before it for ever.
  Census behind;
  if (parser.HandleNextDocument(behind)) {
    throw input_error("the file continues after the end of the request", file,
                      "write one YAML document in each file; a surplus comma or bracket also ends a document");
  }
}

}  // namespace

YAML::Node load_yaml(const std::string& text, const std::string& file) {
  if (text.size() > longest_text) {
    throw input_error("has " + std::to_string(text.size() >> 20) + " MiB, more than the " +
                          std::to_string(longest_text >> 20) + " MiB that are allowed",
                      file, "divide the file");
  }
  try {
    check_document(text, file);
    stop_if_cancelled();
    Pieces pieces(text);
    std::istream in(&pieces);
    YAML::Node document = YAML::Load(in);
    stop_if_cancelled();
    return document;
  } catch (const YAML::Exception& error) {
    stop_if_cancelled();  // a text that was left off is no YAML
    throw input_error("not YAML: " + error.msg, file + ":" + std::to_string(error.mark.line + 1),
                      "check indentation, brackets and colons");
  }
}

}  // namespace bin_scenes::config
