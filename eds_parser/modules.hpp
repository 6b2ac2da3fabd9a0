#pragma once
#include <cstdint>
#include <tuple>
#include <vector>

#include "eds_parser/eds_objects.hpp"
#include "eds_parser/ini.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/report.hpp"

namespace takt {

/// Sections of a modular device: what each module type brings, and which modules are plugged in.
/// CiA 306, 6.
class ModuleSections {
 public:
  explicit ModuleSections(const IniFile& file) noexcept : file_{file} {}

  /// A section [Mx...]; others than fixed objects and sub-index extensions are of no use here.
  void add(const SectionName& name, std::uint32_t section);
  void set_connected(const IniSection& section) noexcept { connected_ = &section; }

  /// Adds the objects of the connected modules to a dictionary, in physical order. Without
  /// [ConnectedModules] (in an EDS) nothing is plugged in.
  void expand(ObjectDictionary& dictionary, ObjectReader& reader, Report& report);

 private:
  enum class Part : std::uint8_t { fixed, extension };

  struct ModuleSection {
    std::uint16_t module = 0;
    Part part = Part::fixed;
    ObjectSection object;

    auto order() const noexcept { return std::tuple{module, part, object.order}; }
  };

  /// How far the sub-indices of an extended object are filled.
  struct Fill {
    std::uint16_t first_index = 0;
    std::uint16_t index = 0;
    unsigned sub = 0;
    unsigned bits_used = 0;
  };

  std::vector<std::uint16_t> connected_types(Report& report) const;
  std::span<const ModuleSection> sections_of(std::uint16_t module, Part part) const;
  void add_fixed(std::uint16_t module, ObjectDictionary& dictionary, ObjectReader& reader);
  bool extend(const ModuleSection& section, ObjectDictionary& dictionary, ObjectReader& reader);
  Fill& fill_of(std::uint16_t index);

  const IniFile& file_;
  const IniSection* connected_ = nullptr;
  std::vector<ModuleSection> sections_;
  std::vector<Fill> fills_;  ///< ascending first_index
  ExpansionBudget budget_;
};

}  // namespace takt
