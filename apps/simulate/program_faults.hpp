#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "eds_parser/table/time.hpp"

namespace takt {

/// What happens to taktd, to the programs beside it and to their messages. Each lasts from
/// ProgramFault::at until ProgramFault::until.
enum class ProgramFaultKind : std::uint8_t {
  stall_front,        ///< the front thread of taktd does not run; its bus thread does
  kill_master,        ///< taktd is killed; it starts again at the end, with another session
  stall_application,  ///< the application does not run (SIGSTOP); its messages wait in its queue
  slow_application,   ///< it needs `time` for each image
  kill_application,   ///< it is killed; it starts again at the end
  end_application,    ///< it releases its outputs and ends; it starts again at the end
  second_sender,      ///< another program of the same name wants the same axes
  slow_messages,      ///< all LCM messages take up to `time`
  replay,             ///< each `time`, commands that are older than 2 s are sent once more
  forge_command,      ///< each `time`, a command of no cycle, of the future or of another session
  forge_image,        ///< each `time`, an image of a cycle that has not come yet
  damage_messages,    ///< each `time`, a message that is cut off, or bytes without sense
};

/// One thing that happens to programs.
struct ProgramFault {
  ProgramFaultKind kind = ProgramFaultKind::stall_front;
  std::optional<std::size_t> application{};  ///< counted from 0; none: all of them
  Time at{};
  Time until = never;
  Time time = std::chrono::milliseconds{10};
};
using ProgramFaults = std::vector<ProgramFault>;

/// `kill_application`, as written in fault files.
std::string_view name(ProgramFaultKind kind) noexcept;
std::optional<ProgramFaultKind> program_fault_kind(std::string_view name) noexcept;
/// All names, in the order of the kinds.
std::vector<std::string_view> program_fault_names();
/// Whether it happens to an application, so that one can be chosen.
bool concerns_application(ProgramFaultKind kind) noexcept;

}  // namespace takt
