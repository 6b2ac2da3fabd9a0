#include "apps/takt/simulate/program/program_fault_actor.hpp"

#include <algorithm>

namespace takt {

ProgramFaultActor::ProgramFaultActor(Cast cast, const ProgramFaults& faults, const sim::Faults& bus)
    : cast_{cast} {
  for (const ProgramFault& fault : faults) {
    agenda_.add(fault.at, [this, fault] { begin(fault); });
    if (fault.until != never) agenda_.add(fault.until, [this, fault] { end(fault); });
  }
  for (const sim::Fault& fault : bus) {
    if (fault.kind != sim::FaultKind::stall_master) continue;
    agenda_.add(fault.at, [this, until = fault.until] { cast_.daemon.stall(until); });
  }
}

void ProgramFaultActor::each(const ProgramFault& fault, VirtualApplications& programs,
                             const std::function<void(VirtualApplication& one)>& act) const {
  for (std::size_t i = 0; i < programs.size(); ++i) {
    if (fault.application.value_or(i) == i) act(*programs[i]);
  }
}

void ProgramFaultActor::begin(const ProgramFault& fault) {
  using enum ProgramFaultKind;
  switch (fault.kind) {
    case stall_front:
      return cast_.daemon.stall(fault.until);
    case kill_master:
      daemon_dies_ = cast_.daemon.runs();
      restart_ = fault.until;
      return;
    case stall_application:
      return each(fault, cast_.applications, [&](auto& one) { one.stall(fault.until); });
    case slow_application:
      return each(fault, cast_.applications, [&](auto& one) { one.slow_down(fault.time); });
    case kill_application:
      return each(fault, cast_.applications, [](auto& one) { one.kill(); });
    case end_application:
      return each(fault, cast_.applications, [&](auto& one) {
        if (one.runs()) one.end(fault.at);
      });
    case second_sender:
      return each(fault, cast_.rivals, [](auto& one) {
        if (!one.runs()) one.start();
      });
    case slow_messages:
      return cast_.lcm.set_delay(fault.time);
    case replay:
    case forge_command:
    case forge_image:
    case damage_messages:
      return repeat(fault, fault.at);
  }
}

void ProgramFaultActor::repeat(const ProgramFault& fault, Time now) {
  if (now >= fault.until) return;
  if (fault.kind == ProgramFaultKind::replay) cast_.forger.replay(now);
  if (fault.kind == ProgramFaultKind::forge_command) cast_.forger.forge_command(now);
  if (fault.kind == ProgramFaultKind::forge_image) cast_.forger.forge_image(now);
  if (fault.kind == ProgramFaultKind::damage_messages) cast_.forger.send_random_bytes();
  const Time then = now + fault.time;
  agenda_.add(then, [this, fault, then] { repeat(fault, then); });
}

void ProgramFaultActor::end(const ProgramFault& fault) {
  using enum ProgramFaultKind;
  switch (fault.kind) {
    case kill_application:
    case end_application:
      return each(fault, cast_.applications, [](auto& one) {
        if (!one.runs()) one.start();
      });
    case slow_application:
      return each(fault, cast_.applications, [](auto& one) { one.slow_down({}); });
    case second_sender:
      return each(fault, cast_.rivals, [](auto& one) { one.kill(); });
    case slow_messages:
      return cast_.lcm.set_delay(VirtualLcm::usual_delay);
    case stall_front:
    case kill_master:
    case stall_application:
    case replay:
    case forge_command:
    case forge_image:
    case damage_messages:
      return;
  }
}

void ProgramFaultActor::daemon_died(Time now) {
  daemon_dies_ = false;
  if (restart_ != never) agenda_.add(std::max(now, restart_), [this] { cast_.daemon.start(); });
}

}  // namespace takt
