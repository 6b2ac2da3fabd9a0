#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "eds_parser/plan/boot/boot_steps.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

/// Lets a boot skip the configuration of a device that already has it: 0x1020 is compared with
/// 0x1F26 and 0x1F27. The date comes from the network file, else from the DCF. `auto` derives it
/// from the content that is written. CiA 302-2.
class ConfigurationDate {
 public:
  ConfigurationDate(const NodeSpec& node, const ObjectDictionary& dictionary, BootSteps& steps,
                    NetworkReport& report);

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
  void choose(const NodeSpec& node, const ObjectDictionary& dictionary, NetworkReport& report);
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
