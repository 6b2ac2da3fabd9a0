#pragma once
#include <cstdint>

#include "eds_parser/table/boot_plan.hpp"

namespace takt {

/// What a boot does with the steps of its plan.
enum class BootCourse : std::uint8_t {
  configuring,          ///< It runs all steps.
  probing_silent_node,  ///< The node may be OPERATIONAL: it runs only steps that make the node
                        ///< report its state, until a sign of life comes.
  identifying,          ///< The last boot has found another device: it runs only the steps that
                        ///< identify the device.
  keeping_operational,  ///< The node was found OPERATIONAL and stays so: it runs only steps that do
                        ///< not change the node. CiA 302-2, status L.
};

/// Returns true if a boot on this course leaves out the step. `written` says that the boot has
/// written anything.
bool skips(BootCourse course, const BootStep& step, bool written) noexcept;

/// Returns true if the step checks whether the right device is there.
bool identifies_device(const BootStep& step) noexcept;

}  // namespace takt
