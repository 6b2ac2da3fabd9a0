#include "eds_parser/plan/boot/configuration_date.hpp"

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

constexpr ObjectKey date_object{0x1020, 1};
constexpr ObjectKey time_object{0x1020, 2};
constexpr std::uint32_t day_ms = 86'400'000;

std::uint32_t parameter(const ObjectDictionary& dictionary, ObjectKey key) {
  const SubObject* sub = dictionary.find(key);
  if (!dictionary.is_dcf || sub == nullptr) return 0;
  return static_cast<std::uint32_t>(integer_of(sub->parameter_value).value_or(0));
}

}  // namespace

ConfigurationDate::ConfigurationDate(const BootPart& part) : steps_{part.steps} {
  const NodeSpec& node = part.spec;
  if (node.configuration_date.given) {
    made_ = !node.configuration_date->has_value();
    date_ = node.configuration_date->value_or(1);
    time_ = made_ || *node.configuration_time == 0 ? 1 : *node.configuration_time;
  } else {
    date_ = parameter(part.dictionary, date_object);
    time_ = parameter(part.dictionary, time_object);
  }
  used_ = date_ != 0 && time_ != 0 && steps_.writable(date_object) && steps_.writable(time_object);
  if (used_ || !node.configuration_date.given) return;
  part.report.error(node.configuration_date.pos, "no-such-object", "`configuration_date` of node `",
                    node.name, "` needs 1020:01 and 1020:02, which ", part.dictionary.file,
                    " does not have or can't change");
}

void ConfigurationDate::skip_if_there() {
  if (!used_) return;
  first_ = steps_.size();
  steps_.integer(BootAction::compare, date_object, date_, "configuration date");
  steps_.integer(BootAction::compare, time_object, time_, "configuration time");
  skip_ = steps_.skip_if_same("the device has this configuration already");
}

/// Derives the date from the content, so that the same content always gives the same date.
void ConfigurationDate::make_from_content() {
  std::uint64_t hash = 0xCBF2'9CE4'8422'2325;  // FNV-1a, 64 bit
  const auto add = [&](std::uint64_t byte) { hash = (hash ^ (byte & 0xFF)) * 0x100'0000'01B3; };
  for (std::size_t i = skip_ + 1; i < steps_.size(); ++i) {
    const BootStep& step = steps_.steps()[i];
    add(static_cast<std::uint64_t>(step.action));
    add(step.object.index);
    add(step.object.index >> 8U);
    add(step.object.sub);
    for (const std::byte byte : step.value) add(std::to_integer<std::uint64_t>(byte));
  }
  date_ = 1 + static_cast<std::uint32_t>(hash % 0xFFFF);
  time_ = 1 + static_cast<std::uint32_t>((hash >> 16U) % (day_ms - 1));
  steps_.steps()[first_].value = little_endian(date_, 4);
  steps_.steps()[first_ + 1].value = little_endian(time_, 4);
}

void ConfigurationDate::enter() {
  if (!used_) return;
  if (made_) make_from_content();
  steps_.integer(BootAction::write, date_object, date_, "configuration date");
  steps_.integer(BootAction::write, time_object, time_, "configuration time");
}

void ConfigurationDate::land() {
  if (used_) steps_.land(skip_);
}

}  // namespace takt
