#include "master/sim/family/drv28_parameters.hpp"

#include <algorithm>

namespace takt::sim {
namespace {

constexpr std::uint16_t password_address = 0x0700;

}  // namespace

const Drv28Parameters::Parameter* Drv28Parameters::find(std::uint16_t address) const noexcept {
  const auto found = std::ranges::find(parameters_, address, &Parameter::address);
  return found == parameters_.end() ? nullptr : &*found;
}

/// Returns true if a password protects the parameters. A password of 0 protects nothing.
bool Drv28Parameters::locked() const noexcept {
  return find(password_address)->value != 0 && !unlocked_;
}

/// Returns true if another input terminal already has this function. Function 0 means no function
/// and may be repeated.
bool Drv28Parameters::is_taken(const Parameter& terminal, std::uint32_t value) const noexcept {
  return value != 0 && std::ranges::any_of(parameters_, [&](const Parameter& other) {
           return other.change == Change::terminal && &other != &terminal && other.value == value;
         });
}

Drv28Parameters::Answer Drv28Parameters::read(std::uint16_t address) const noexcept {
  const Parameter* parameter = find(address);
  if (parameter == nullptr) return {.error = Drv28Error::invalid_address};
  return {.value = parameter->change == Change::password ? 0 : parameter->value};
}

/// Sets the password if there is none. Otherwise the right password unlocks the parameters and a
/// wrong one locks them.
Drv28Parameters::Answer Drv28Parameters::enter_password(Parameter& password,
                                                        std::uint32_t value) noexcept {
  if (password.value == 0) {
    password.value = value;
    unlocked_ = false;
    return {.value = value};
  }
  unlocked_ = password.value == value;
  if (!unlocked_) return {.error = Drv28Error::wrong_password};
  return {.value = value};
}

Drv28Parameters::Answer Drv28Parameters::write(std::uint16_t address, std::uint32_t value,
                                               bool running) noexcept {
  auto* parameter = const_cast<Parameter*>(find(address));
  if (parameter == nullptr) return {.error = Drv28Error::invalid_address};
  if (parameter->change == Change::never) return {.error = Drv28Error::read_only};
  if (value > parameter->highest) return {.error = Drv28Error::invalid_value};
  if (parameter->change == Change::password) return enter_password(*parameter, value);
  if (locked()) return {.error = Drv28Error::locked};
  if (parameter->change == Change::stopped && running) {
    return {.error = Drv28Error::not_while_running};
  }
  if (parameter->change == Change::terminal && is_taken(*parameter, value)) {
    return {.error = Drv28Error::operation_failed};
  }
  parameter->value = value;
  return {.value = value};
}

}  // namespace takt::sim
