#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/read/eds_objects.hpp"
#include "eds_parser/read/module_lists.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// The sections of a modular device: the objects of each module type, and the modules that are
/// plugged in. CiA 306, 6.
class ModuleSections {
 public:
  explicit ModuleSections(const IniFile& file) noexcept : file_{file} {}

  /// Adds a section [Mx...]. Only fixed objects, sub-index extensions and the lists of both are
  /// used; other sections of CiA 306 are ignored. Returns false if the section is not one of CiA
  /// 306.
  bool add(const SectionName& name, std::uint32_t section, Report& report);
  void set_supported(const IniSection& section) noexcept { lists_.set_supported(section); }
  void set_connected(const IniSection& section) noexcept { connected_ = &section; }

  /// Adds the objects of the connected modules to a dictionary, in physical order. Without
  /// [ConnectedModules], as in an EDS, no module is plugged in.
  void expand(ObjectDictionary& dictionary, ObjectReader& reader, Report& report);
  /// Returns true if a section of any module, connected or not, describes this object.
  bool describes(std::uint16_t index) const { return indices_.contains(index); }
  /// Checks the lists, and reads the sections of modules that are not connected for their findings
  /// only. Call this after expand().
  void check(const ObjectDictionary& dictionary, Report& report);

 private:
  using Part = ModulePart;

  struct ModuleSection {
    std::uint16_t module = 0;
    Part part = Part::fixed;
    ObjectSection object;

    auto order() const noexcept { return std::tuple{module, part, object.order}; }
  };

  /// The progress of filling the sub-indices of an extended object.
  struct Fill {
    std::uint16_t first_index = 0;
    std::uint16_t index = 0;
    unsigned sub = 0;
    unsigned bits_used = 0;
    unsigned described = 0;  ///< highest sub-index that `index` had before the extension
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
  const SubExtension& extension_of(const ModuleSection& section, ObjectReader& reader,
                                   Report& report);
  Object* find(std::uint16_t index, ObjectDictionary& dictionary);
  Fill& fill_of(std::uint16_t index, ObjectDictionary& dictionary);
  unsigned described_subs(std::uint16_t index, ObjectDictionary& dictionary);
  void report_overlap(const Fill& fill, ObjectDictionary& dictionary, Report& report);

  const IniFile& file_;
  const IniSection* connected_ = nullptr;
  std::vector<ModuleSection> sections_;
  std::set<std::uint16_t> indices_;                   ///< indices that `sections_` describe
  std::map<std::uint32_t, SubExtension> extensions_;  ///< by section number
  ModuleLists lists_;
  std::vector<Fill> fills_;               ///< in ascending order of first_index
  std::map<std::uint16_t, Object> made_;  ///< objects that the dictionary does not have yet
  ExpansionBudget budget_;
};

}  // namespace takt
