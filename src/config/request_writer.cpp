#include "bin_scenes/config/request_reader.hpp"
#include "config/values.hpp"

namespace bin_scenes {

namespace config {

namespace {

/// The visitor that writes a struct as indented YAML.
class KeyWriter {
 public:
  template <class Value>
  void field(const Key& key, Value& value) {
    if (key.written) text += start(key) + ": " + text_of(value) + "\n";
  }
  template <class Value>
  void field(const Key& key, std::optional<Value>& value) {
    if (value) field(key, *value);
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    if (!key.written) return;
    text += start(key) + ":\n";
    indent_ += 2;
    visit(*this, value);
    indent_ -= 2;
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>& values) {
    if (!key.written) return;
    text += start(key) + (values.empty() ? ": []\n" : ":\n");
    indent_ += 4;
    for (Struct& value : values) {
      first_of_item_ = true;
      visit(*this, value);
    }
    indent_ -= 4;
  }
  void bin_kind(Bin&, const BinKeys&) {}

  std::string text;

 private:
  std::string start(const Key& key) {
    std::string line(indent_, ' ');
    if (first_of_item_) line.replace(indent_ - 2, 1, "-");
    first_of_item_ = false;
    return line + key.name;
  }

  std::size_t indent_ = 0;
  bool first_of_item_ = false;
};

}  // namespace

}  // namespace config

std::string write_request(const Request& request) {
  Request copy = request;  // visitors take references to non-const fields, because one of them reads
  config::KeyWriter writer;
  visit(writer, copy);
  return writer.text;
}

}  // namespace bin_scenes
