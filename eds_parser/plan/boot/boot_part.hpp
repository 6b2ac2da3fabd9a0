#pragma once
#include <cstdint>
#include <string>

#include "eds_parser/plan/boot/boot_compiler.hpp"
#include "eds_parser/plan/boot/boot_steps.hpp"

namespace takt {

/// The data that all parts of a boot plan share: the node, its dictionary, and the list that takes
/// their steps.
struct BootPart {
  const NodeSpec& spec;
  const ObjectDictionary& dictionary;
  const BootContext& context;
  BootSteps& steps;
  NetworkReport& report;

  /// Reports that `key` of the network file needs an object that can't be written.
  void missing(SourcePos pos, const std::string& key, ObjectKey object) const;
  /// Returns false and warns if the limits of the device exclude `value`. Values that takt derives
  /// from the plan are not forced upon such a device.
  bool takes(ObjectKey key, std::int64_t value, SourcePos pos,
             const std::string& consequence) const;
};

}  // namespace takt
