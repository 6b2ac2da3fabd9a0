#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/plan/pdo/mapping_compiler.hpp"
#include "eds_parser/table/boot_plan.hpp"

namespace takt {

/// The limits of an object in the device file.
struct ObjectLimits {
  explicit ObjectLimits(const SubObject& sub) noexcept;

  bool hold(std::int64_t value) const noexcept {
    return (!low || value >= *low) && (!high || value <= *high);
  }
  /// Returns the limits as `-10..10`, or `..10` if the low limit is missing.
  std::string text() const;

  std::optional<std::int64_t> low;
  std::optional<std::int64_t> high;
};

/// Appends steps to a boot plan. The class knows the dictionary, so that each step can describe
/// what it does.
class BootSteps {
 public:
  BootSteps(const ObjectDictionary& dictionary, Time sdo_timeout)
      : dictionary_{dictionary}, sdo_timeout_{sdo_timeout} {}

  BootStep& nmt(NmtCommand command, std::string purpose);
  BootStep& wait(BootAction action, Time timeout, char letter, std::string purpose);
  /// Appends a step on an object with an integer of the object's width, or of `bytes` bytes if the
  /// width is unknown.
  BootStep& integer(BootAction action, ObjectKey object, std::int64_t value, std::string purpose,
                    unsigned bytes = 4);
  BootStep& bytes(BootAction action, ObjectKey object, std::vector<std::byte> value,
                  std::string purpose);
  /// Appends a `skip_if_same` step and returns its index. land() sets its target.
  std::size_t skip_if_same(std::string purpose);
  /// Makes the next step to be appended the target of `skip`.
  void land(std::size_t skip);

  bool has(ObjectKey object) const noexcept { return dictionary_.find(object) != nullptr; }
  bool writable(ObjectKey object) const noexcept;
  bool readable(ObjectKey object) const noexcept;
  std::size_t size() const noexcept { return plan_.steps.size(); }
  std::vector<BootStep>& steps() noexcept { return plan_.steps; }
  BootPlan take() { return std::move(plan_); }

 private:
  BootStep& add(BootAction action, std::string purpose);
  std::string eds_note(ObjectKey object) const;

  const ObjectDictionary& dictionary_;
  Time sdo_timeout_;
  BootPlan plan_;
};

}  // namespace takt
