/// The JSON schema of requests (draft 7), for editors and validators, from the table of their keys. What depends on
/// several keys at once is left to check().
#include "bin_scenes/config/request_reader.hpp"
#include "config/values.hpp"

#include <nlohmann/json.hpp>

namespace bin_scenes {

namespace config {

namespace {

using Json = nlohmann::ordered_json;

Json number(const char* type, const Range& range) {
  Json schema = {{"type", type}};
  if (std::isfinite(range.least)) schema[range.above ? "exclusiveMinimum" : "minimum"] = range.least;
  if (std::isfinite(range.most)) schema["maximum"] = range.most;
  return schema;
}

Json list_of(Json item, std::size_t least = 0, std::size_t most = 0) {
  Json schema = {{"type", "array"}, {"items", std::move(item)}};
  if (least > 0) schema["minItems"] = least;
  if (most > 0) schema["maxItems"] = most;
  return schema;
}

Json schema_of(bool, const Range&) {
  return {{"type", "boolean"}};
}
Json schema_of(int, const Range& range) {
  return number("integer", range);
}
Json schema_of(std::uint64_t, const Range& range) {
  return number("integer", std::isfinite(range.least) ? range : at_least(0.0, range.most));
}
Json schema_of(double, const Range& range) {
  return number("number", range);
}
Json schema_of(const std::string&, const Range&) {
  return {{"type", "string"}};
}
Json schema_of(const Word& word, const Range&) {
  return {{"enum", word.known}};
}
Json schema_of(const Vec3&, const Range& range) {
  return list_of(number("number", range), 3, 3);
}
Json schema_of(const Pose&, const Range&) {
  const auto numbers = [](std::size_t count) { return list_of(number("number", anything), count, count); };
  const Json map = {{"type", "object"},
                    {"properties", {{"position", numbers(3)}, {"orientation_xyzw", numbers(4)}}},
                    {"additionalProperties", false}};
  return {{"anyOf", {numbers(3), numbers(7), map}}};
}
Json schema_of(const Twist&, const Range& range) {
  return list_of(number("number", range), 6, 6);
}
template <std::size_t size>
Json schema_of(const std::array<double, size>&, const Range& range) {
  return list_of(number("number", range), size, size);
}
template <class Item>
Json schema_of(const std::vector<Item>&, const Range& range) {
  return list_of(schema_of(Item{}, range));
}
template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
Json schema_of(Enum value, const Range& range) {
  return schema_of(word_of(value), range);
}

/// The visitor that describes a map of keys.
class SchemaWriter {
 public:
  template <class Value>
  void field(const Key& key, Value& value) {
    Json& schema = add(key, schema_of(value, key.range));
    const std::string text = text_of(value);
    const Json parsed = Json::parse(text, nullptr, false);
    if (key.written && text != "\"\"" && text != "[]")
      schema["default"] = parsed.is_discarded() ? Json(text) : parsed;  // a word has no quotes
  }
  template <class Value>
  void field(const Key& key, std::optional<Value>&) {
    add(key, schema_of(Value{}, key.range));
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    Json schema = map_of(value);
    schema["type"] = {"object", "null"};
    add(key, std::move(schema));
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>&) {
    Struct item;
    Json items = map_of(item);
    if constexpr (std::is_same_v<Struct, Gripper>) items = {{"anyOf", {{{"type", "string"}}, items}}};  // a preset
    Json schema = list_of(std::move(items));
    if (!key.needed) schema["type"] = {"array", "null"};
    add(key, std::move(schema));
  }
  void bin_kind(Bin&, const BinKeys&) {}

  template <class Struct>
  static Json map_of(Struct& value) {
    SchemaWriter writer;
    visit(writer, value);
    Json schema = {{"type", "object"}, {"properties", writer.keys_}, {"additionalProperties", false}};
    if (!writer.needed_.empty()) schema["required"] = writer.needed_;
    return schema;
  }

 private:
  Json& add(const Key& key, Json schema) {
    schema["description"] = described(key);
    if (key.needed) needed_.push_back(key.name);
    return keys_[key.name] = std::move(schema);
  }

  Json keys_ = Json::object(), needed_ = Json::array();
};

}  // namespace

}  // namespace config

std::string request_json_schema() {
  Request defaults;
  config::Json schema = {{"title", "A request of bin_scenes"}};
  schema.update(config::SchemaWriter::map_of(defaults));
  return schema.dump(1) + "\n";
}

}  // namespace bin_scenes
