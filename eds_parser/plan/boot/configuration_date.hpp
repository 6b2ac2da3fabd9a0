#pragma once
#include <cstddef>
#include <cstdint>

#include "eds_parser/plan/boot/boot_sections.hpp"

namespace takt {

/// Lets a boot skip the configuration of a device that is already configured: the boot compares
/// 0x1020 of the device with 0x1F26 and 0x1F27. The date comes from the network file, else from the
/// DCF. `auto` derives it from the content that is written. CiA 302-2.
class ConfigurationDate {
 public:
  explicit ConfigurationDate(const BootPart& part);

  /// Appends the comparison. Call this before the configuration steps.
  void skip_if_there();
  /// Appends the write of the date. Call this after the configuration steps and before the
  /// parameters are stored.
  void enter();
  /// Ends the skipped part. Call this after the last step that may be skipped.
  void land();
  /// Returns true if the boot can skip the configuration.
  bool used() const noexcept { return used_; }

 private:
  void make_from_content();

  BootSteps& steps_;
  bool used_ = false;
  bool made_ = false;
  std::uint32_t date_ = 0;
  std::uint32_t time_ = 0;
  std::size_t first_ = 0;  ///< index of the step that compares the date
  std::size_t skip_ = 0;
};

}  // namespace takt
