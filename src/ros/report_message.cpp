/// The report's message is filled by a visitor of the table that scene.json is written from (scene/report_keys.hpp).
#include "scene/report_keys.hpp"

#include "bin_scenes/core/error.hpp"
#include "message_fields.hpp"
#include "scene_message.hpp"

#include <algorithm>
#include <map>

namespace bin_scenes {

namespace {

namespace msgs = bin_scenes_msgs;
using ros::message_traits::IsMessage;

// set(field, value): the value of a key as the field of a message holds it. False: the types do not correspond.
template <class Field, class Value>
bool set(Field& field, const Value& value) {
  if constexpr (std::is_same_v<Field, Value>)
    field = value;
  else if constexpr (std::is_arithmetic_v<Field> && std::is_arithmetic_v<Value>)
    field = static_cast<Field>(value);
  else
    return false;
  return true;
}
bool set(std::uint64_t& field, const Hexadecimal& value) {
  return set(field, value.value);
}
bool set(boost::array<std::int32_t, 2>& field, const std::array<int, 2>& value) {
  std::copy(value.begin(), value.end(), field.begin());
  return true;
}
template <class Item, class Value>
bool set(std::vector<Item>& field, const std::map<std::string, Value>& values) {
  if constexpr (std::is_same_v<Item, msgs::StageTime>)
    for (const auto& [name, ms] : values) field.emplace_back().stage = name, field.back().ms = static_cast<double>(ms);
  else if constexpr (std::is_same_v<Item, msgs::Counter>)
    for (const auto& [name, n] : values)
      field.emplace_back().name = name, field.back().value = static_cast<std::uint64_t>(n);
  else
    return false;
  return true;
}

/// The key a.b is the field b of the message a, or the field a_b.
template <class Message>
class MessageFiller {
 public:
  /// @param section  that the fields of the message belong to, such as "jam_"
  explicit MessageFiller(Message& message, std::string section = "")
      : message_(message), section_(std::move(section)) {}

  template <class Value>
  void field(const Key& key, Value& value) {
    need(key, with_field(key, [&](auto& field) { return set(field, value); }));
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    if (with_field(key, [&](auto& field) { return fill(field, value); })) return;
    MessageFiller flat(message_, section_ + key.name + "_");
    visit(flat, value);
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>& values) {
    need(key, with_field(key, [&](auto& field) { return fill_all(field, values); }));
  }
  /// Quantiles are a message of their own even where their keys are among others.
  void quantiles(Quantiles& q) {
    const auto fill_if = [&](const std::string&, auto& field) {
      if constexpr (std::is_same_v<std::decay_t<decltype(field)>, msgs::Quantiles>) fill(field, q);
    };
    for_each_field(message_, fill_if);
  }

 private:
  template <class Field, class Struct>
  static bool fill(Field& field, Struct& value) {
    if constexpr (IsMessage<Field>::value) {
      MessageFiller<Field> filler(field);
      visit(filler, value);
    }
    return IsMessage<Field>::value;
  }
  template <class Field, class Struct>
  static bool fill_all(Field&, std::vector<Struct>&) {
    return false;
  }
  template <class Item, class Struct>
  static bool fill_all(std::vector<Item>& field, std::vector<Struct>& values) {
    if constexpr (IsMessage<Item>::value)
      for (Struct& value : values) fill(field.emplace_back(), value);
    return IsMessage<Item>::value;
  }
  /// Returns act(field); false if the message has no field for the key.
  template <class Act>
  bool with_field(const Key& key, const Act& act) {
    static const std::map<std::string, std::string> others = {{"stages_ms", "stages"},
                                                              {"penetration_value", "penetration"},
                                                              {"penetration_pair", "pair"},
                                                              {"energy_gain_relative", "energy_gain"}};
    const std::string path = section_ + key.name;
    const auto other = others.find(path);
    bool done = false;
    const auto act_if = [&](const std::string& name, auto& field) {
      if (name == (other == others.end() ? path : other->second)) done = act(field);
    };
    for_each_field(message_, act_if);
    return done;
  }
  void need(const Key& key, bool done) const {
    if (!done) throw environment_error("the message has no field for the key", section_ + key.name, "");
  }

  Message& message_;
  std::string section_;
};

template <class Message>
void visit(MessageFiller<Message>& filler, Quantiles& q) {
  filler.quantiles(q);
}
void visit(MessageFiller<msgs::Quantiles>& filler, Quantiles& q) {
  bin_scenes::visit<MessageFiller<msgs::Quantiles>>(filler, q);
}

}  // namespace

msgs::SceneReport report_message(Report report) {
  msgs::SceneReport message;
  MessageFiller<msgs::SceneReport> filler(message);
  visit(filler, report);
  // What the file expresses by null and by leaving a section out.
  message.drift.measured = report.drift.measured;
  message.worst.penetration_known = report.worst.penetration.known;
  if (!report.worst.penetration.known) message.worst.penetration = message.worst.penetration_relative = 0.0;
  return message;
}

}  // namespace bin_scenes
