#pragma once
#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "eds_parser/ini/ini.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// What a module type adds to the device: new objects, or sub-indices of objects that the device
/// has.
enum class ModulePart : std::uint8_t { fixed, extension };

/// Compares [SupportedModules], [MxFixedObjects] and [MxSubExtends] with the sections that they
/// count and name. The sections decide what exists; the lists are only checked. CiA 306, 6.
class ModuleLists {
 public:
  void set_supported(const IniSection& section) noexcept;
  void add_list(std::uint16_t module, ModulePart part, const IniSection& section);
  /// Adds a section of an object, or of a part of an object.
  void add_object(std::uint16_t module, ModulePart part, std::uint16_t index,
                  const IniSection& section);
  /// Reports the differences between the lists and the sections. `described` is the number of
  /// sections [MxModuleInfo].
  void check(const IniFile& file, std::size_t described, Report& report) const;

 private:
  struct List {
    std::uint16_t module = 0;
    ModulePart part = ModulePart::fixed;
    const IniSection* section = nullptr;
  };
  struct Object {
    std::uint16_t module = 0;
    ModulePart part = ModulePart::fixed;
    std::uint16_t index = 0;
    const IniSection* section = nullptr;  ///< first section of the object

    auto order() const noexcept { return std::tuple{module, part, index}; }
    bool operator<(const Object& other) const noexcept { return order() < other.order(); }
  };

  void check_supported(const IniFile& file, std::size_t described, Report& report) const;
  void check_list(const List& list, const IniEntries& entries, std::set<Object>& listed,
                  Report& report) const;

  const IniSection* supported_ = nullptr;
  std::vector<List> lists_;
  std::set<Object> objects_;
};

}  // namespace takt
