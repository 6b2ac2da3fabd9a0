#include "eds_parser/specification/speed_axis_spec.hpp"

namespace takt {
namespace {

template <class T>
void take(std::optional<T>& value, const std::optional<T>& own) {
  if (own) value = own;
}

void take(WordPattern& pattern, const WordPattern& own) {
  if (own.is_known()) pattern = own;
}

void take(std::string& text, const std::string& own) {
  if (!own.empty()) text = own;
}

}  // namespace

std::string missing_part(const SpeedAxisSpec& axis) {
  if (!axis.control) return "`control`";
  if (!axis.status) return "`status`";
  if (!axis.set_speed) return "`set_speed`";
  if (!axis.commands.run) return "`run` of `commands`";
  if (!axis.commands.stop) return "`stop` of `commands`";
  return {};
}

SpeedAxisSpec merged(SpeedAxisSpec axis, const SpeedAxisSpec& own) {
  if (!own.is_stated()) return axis;
  axis.pos = own.pos;
  axis.enabled = own.enabled;
  take(axis.sequence, own.sequence);
  take(axis.fault_reset, own.fault_reset);
  take(axis.control, own.control);
  take(axis.status, own.status);
  take(axis.set_speed, own.set_speed);
  take(axis.actual_speed, own.actual_speed);
  for (const auto member :
       {&SpeedCommandsSpec::mask, &SpeedCommandsSpec::off, &SpeedCommandsSpec::stop,
        &SpeedCommandsSpec::run, &SpeedCommandsSpec::run_reverse, &SpeedCommandsSpec::quick_stop,
        &SpeedCommandsSpec::reset}) {
    take(axis.commands.*member, own.commands.*member);
  }
  for (const auto member :
       {&SpeedStates::ready, &SpeedStates::running, &SpeedStates::reverse, &SpeedStates::at_speed,
        &SpeedStates::standstill, &SpeedStates::fault}) {
    take(axis.states.*member, own.states.*member);
  }
  take(axis.ramps, own.ramps);
  take(axis.source, own.source);
  return axis;
}

SpeedAxisSpec velocity_mode_axis() {
  SpeedAxisSpec axis;
  axis.sequence = SpeedSequence::cia402;
  axis.control = ObjectKey{0x6040, 0};
  axis.status = ObjectKey{0x6041, 0};
  axis.set_speed = SpeedValueSpec{.object = {0x6042, 0}, .unit = "rpm"};
  axis.actual_speed = SpeedValueSpec{.object = {0x6044, 0}, .unit = "rpm"};
  // Bit 4 enables the ramp, bit 5 unlocks it, bit 6 gives it the set speed instead of 0.
  axis.commands.mask = 0x007F;
  axis.commands.off = 0x0000;
  axis.commands.stop = 0x003F;
  axis.commands.run = 0x007F;
  axis.commands.quick_stop = 0x0002;
  axis.states.running = {.mask = 0x006F, .values = {0x0027}};
  axis.states.ready = axis.states.running;
  axis.states.at_speed = {.mask = 0x0400, .values = {0x0400}};
  axis.states.fault = {.mask = 0x004F, .values = {0x0008, 0x000F}};
  axis.ramps = "6048 up, 6049 down, 604A quick stop";
  axis.source = "CiA 402-2, velocity mode";
  return axis;
}

}  // namespace takt
