#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Faults of taktd, of the programs beside it and of their messages. Each fault lasts from
/// ProgramFault::at until ProgramFault::until; `time` is ProgramFault::time.
enum class ProgramFaultKind : std::uint8_t {
  stall_front,        ///< the front thread of taktd does not run; its bus thread runs on
  kill_master,        ///< taktd is killed; it starts again at the end, with a new session
  stall_application,  ///< the application does not run (SIGSTOP); its messages wait in its queue
  slow_application,   ///< the application needs an additional `time` for each image
  kill_application,   ///< the application is killed; it starts again at the end
  end_application,    ///< the application releases its outputs and ends; it starts again at the end
  second_sender,      ///< a second program with the same name commands the same axes
  slow_messages,      ///< every LCM message takes up to `time`
  replay,             ///< every `time`, commands older than 2 s are sent once more
  forge_command,      ///< every `time`, a command with a wrong cycle or a wrong session is sent
  forge_image,        ///< every `time`, an image of a future cycle is sent
  damage_messages,    ///< every `time`, a truncated message or random bytes are sent
};

/// One fault of the programs.
struct ProgramFault {
  ProgramFaultKind kind = ProgramFaultKind::stall_front;
  std::optional<std::size_t> application{};  ///< number from 0; empty means all applications
  Time at{};
  Time until = never;
  Time time = std::chrono::milliseconds{10};
};
using ProgramFaults = std::vector<ProgramFault>;

/// Returns the name of the kind in fault files, for example `kill_application`.
std::string_view name(ProgramFaultKind kind) noexcept;
std::optional<ProgramFaultKind> program_fault_kind(std::string_view name) noexcept;
/// Returns all names, in the order of the kinds.
std::vector<std::string_view> program_fault_names();
/// Returns true if the fault concerns an application, so that a fault file can choose one.
bool concerns_application(ProgramFaultKind kind) noexcept;

}  // namespace takt
