#include "master/core/node/boot_course.hpp"

#include <algorithm>
#include <iterator>

namespace takt {
namespace {

bool reads_identity(const BootStep& step) noexcept {
  return step.action == BootAction::expect &&
         (step.object.index == 0x1000 || step.object.index == 0x1018);
}

/// Returns true if the step makes a node report its state, and does not disturb a node that is
/// OPERATIONAL.
bool makes_node_report(const BootStep& step) noexcept {
  const std::uint16_t index = step.object.index;
  switch (step.action) {
    case BootAction::probe:
    case BootAction::await_heartbeat:
    case BootAction::await_guarding:
      return true;
    case BootAction::write:
    case BootAction::write_if_differs:
      return index == 0x1017 || index == 0x100C || index == 0x100D;
    default:
      return reads_identity(step);
  }
}

/// Returns true if the step may change the node.
bool changes_node(BootAction action) noexcept {
  using enum BootAction;
  constexpr BootAction changing[] = {
      nmt,    await_bootup,     pause,       write,     write_if_changed,
      verify, download_program, disable_pdo, enable_pdo};
  return std::ranges::find(changing, action) != std::end(changing);
}

}  // namespace

bool identifies_device(const BootStep& step) noexcept {
  return step.action == BootAction::probe || reads_identity(step);
}

bool skips(BootCourse course, const BootStep& step, bool written) noexcept {
  if (course == BootCourse::probing_silent_node) return !makes_node_report(step);
  if (step.action == BootAction::write_if_changed && !written) return true;
  return course == BootCourse::keeping_operational && changes_node(step.action);
}

}  // namespace takt
