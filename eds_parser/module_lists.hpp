#pragma once
#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "eds_parser/ini.hpp"
#include "eds_parser/report.hpp"

namespace takt {

/// What a module type brings: objects of its own, or sub-indices of objects of the device.
enum class ModulePart : std::uint8_t { fixed, extension };

/// [SupportedModules], [MxFixedObjects] and [MxSubExtends] against the sections that they count and
/// name. The sections are the truth; the lists only are judged. CiA 306, 6.
class ModuleLists {
 public:
  void set_supported(const IniSection& section) noexcept;
  void add_list(std::uint16_t module, ModulePart part, const IniSection& section);
  /// A section of an object, or of a part of one.
  void add_object(std::uint16_t module, ModulePart part, std::uint16_t index,
                  const IniSection& section);
  /// `described`: number of sections [MxModuleInfo].
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
    const IniSection* section = nullptr;  ///< the first of the object

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
