#pragma once
#include <cstdint>
#include <map>
#include <span>
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
  /// False: not one of CiA 306.
  bool add(const SectionName& name, std::uint32_t section, Report& report);
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
    unsigned described = 0;  ///< highest sub-index that `index` had before
  };

  struct Slot {
    std::uint32_t number = 0;
    IniEntry entry;
  };

  std::vector<Slot> slots(Report& report) const;
  std::vector<std::uint16_t> connected_types(Report& report) const;
  std::span<const ModuleSection> sections_of(std::uint16_t module, Part part) const;
  bool add_modules(ObjectDictionary& dictionary, ObjectReader& reader, Report& report);
  void add_fixed(std::uint16_t module, const ObjectDictionary& dictionary, ObjectReader& reader,
                 Report& report);
  bool extend(const ModuleSection& section, ObjectDictionary& dictionary, ObjectReader& reader,
              Report& report);
  Object* find(std::uint16_t index, ObjectDictionary& dictionary);
  Fill& fill_of(std::uint16_t index, ObjectDictionary& dictionary);
  unsigned described_subs(std::uint16_t index, ObjectDictionary& dictionary);
  void tell_overlap(const Fill& fill, ObjectDictionary& dictionary, Report& report);

  const IniFile& file_;
  const IniSection* connected_ = nullptr;
  std::vector<ModuleSection> sections_;
  std::vector<Fill> fills_;               ///< ascending first_index
  std::map<std::uint16_t, Object> made_;  ///< what the dictionary does not have yet
  ExpansionBudget budget_;
};

}  // namespace takt
