#include "eds_parser/plan/boot/boot_steps.hpp"

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/table/device_table.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {

ObjectLimits::ObjectLimits(const SubObject& sub) noexcept
    : low{integer_of(sub.low_limit)}, high{integer_of(sub.high_limit)} {}

std::string ObjectLimits::text() const {
  return (low ? std::to_string(*low) : "") + ".." + (high ? std::to_string(*high) : "");
}

BootStep& BootSteps::add(BootAction action, std::string purpose) {
  BootStep& step = plan_.steps.emplace_back();
  step.action = action;
  step.timeout = sdo_timeout_;
  step.purpose = std::move(purpose);
  return step;
}

BootStep& BootSteps::nmt(NmtCommand command, std::string purpose) {
  BootStep& step = add(BootAction::nmt, std::move(purpose));
  step.command = command;
  step.letter = 'B';
  step.timeout = Time{};
  return step;
}

BootStep& BootSteps::wait(BootAction action, Time timeout, char letter, std::string purpose) {
  BootStep& step = add(action, std::move(purpose));
  step.timeout = timeout;
  step.letter = letter;
  return step;
}

BootStep& BootSteps::integer(BootAction action, ObjectKey object, std::int64_t value,
                             std::string purpose, unsigned bytes) {
  const SubObject* sub = dictionary_.find(object);
  const unsigned width = sub != nullptr ? byte_width(sub->type) : 0;
  return this->bytes(action, object, little_endian(value, width != 0 ? width : bytes),
                     std::move(purpose));
}

BootStep& BootSteps::bytes(BootAction action, ObjectKey object, std::vector<std::byte> value,
                           std::string purpose) {
  BootStep& step = add(action, std::move(purpose));
  step.object = object;
  step.value = std::move(value);
  step.eds_note = eds_note(object);
  return step;
}

std::size_t BootSteps::skip_if_same(std::string purpose) {
  add(BootAction::skip_if_same, std::move(purpose)).timeout = Time{};
  return plan_.steps.size() - 1;
}

void BootSteps::land(std::size_t skip) {
  plan_.steps[skip].target = static_cast<std::uint16_t>(plan_.steps.size());
}

bool BootSteps::writable(ObjectKey object) const noexcept {
  const SubObject* sub = dictionary_.find(object);
  return sub != nullptr && sub->is_writable();
}

bool BootSteps::readable(ObjectKey object) const noexcept {
  const SubObject* sub = dictionary_.find(object);
  return sub != nullptr && sub->access != Access::wo;
}

std::string BootSteps::eds_note(ObjectKey object) const {
  const SubObject* sub = dictionary_.find(object);
  if (sub == nullptr) return dictionary_.file + " does not have " + to_string(object);
  std::string note =
      concat(dictionary_.file, " line ", sub->pos.line, ": ", label(dictionary_, object), ", ",
             name(sub->type), ", ", access_name(sub->access));
  if (!sub->default_text.empty()) note += ", default " + sub->default_text;
  const ObjectLimits limits{*sub};
  if (limits.low || limits.high) note += ", limits " + limits.text();
  return note;
}

}  // namespace takt
