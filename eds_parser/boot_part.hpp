#pragma once
#include <cstdint>
#include <string>

#include "eds_parser/boot_compiler.hpp"
#include "eds_parser/boot_steps.hpp"

namespace takt {

/// What the parts of a boot plan have in common: whose they are, and where their steps go.
struct BootPart {
  const NodeSpec& spec;
  const ObjectDictionary& dictionary;
  const BootContext& context;
  BootSteps& steps;
  NetworkReport& report;

  /// Tells that `key` of the network file needs an object that can't be written.
  void missing(SourcePos pos, const std::string& key, ObjectKey object) const;
  /// Values that follow from the plan are not forced upon a device whose limits exclude them:
  /// false, and told.
  bool takes(ObjectKey key, std::int64_t value, SourcePos pos,
             const std::string& consequence) const;
};

}  // namespace takt
