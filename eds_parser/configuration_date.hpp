#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "eds_parser/boot_steps.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"

namespace takt {

/// Lets a boot skip the configuration of a device that has it already: 0x1020 against 0x1F26 and
/// 0x1F27. The date is the network file's, else the DCF's; `auto` makes it from what is written.
/// CiA 302-2.
class ConfigurationDate {
 public:
  ConfigurationDate(const NodeSpec& node, const ObjectDictionary& dictionary, BootSteps& steps,
                    NetworkReport& report);

  /// Before the configuration.
  void skip_if_there();
  /// After it, before it is stored: the device gets the date.
  void enter();
  /// Behind all that is skipped.
  void land();
  /// Some boots skip the configuration.
  bool used() const noexcept { return used_; }

 private:
  void choose(const NodeSpec& node, const ObjectDictionary& dictionary, NetworkReport& report);
  void make_from_content();

  BootSteps& steps_;
  bool used_ = false;
  bool made_ = false;
  std::uint32_t date_ = 0;
  std::uint32_t time_ = 0;
  std::size_t first_ = 0;  ///< step that compares the date
  std::size_t skip_ = 0;
};

}  // namespace takt
