#pragma once
#include <cstdint>

#include "eds_parser/table/boot_plan.hpp"

namespace takt {

/// The way in which a boot runs the steps of its plan.
enum class BootCourse : std::uint8_t {
  configuring,          ///< The boot runs all steps.
  probing_silent_node,  ///< The node may be OPERATIONAL: until it gives a sign of life, the boot
                        ///< runs only steps that make it report its state.
  identifying,          ///< The last boot has found another device: this boot runs only the steps
                        ///< that identify the device.
  keeping_operational,  ///< The node was found OPERATIONAL and stays so: the boot runs only steps
                        ///< that do not change it. CiA 302-2, status L.
};

/// Returns true if a boot with this course leaves out the step. `written` states whether the boot
/// has written anything to the device.
bool skips(BootCourse course, const BootStep& step, bool written) noexcept;

/// Returns true if the step checks the identity of the device.
bool identifies_device(const BootStep& step) noexcept;

}  // namespace takt
