#include "eds_parser/plan/pdo/mapping_compiler.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "eds_parser/dictionary/object_names.hpp"

namespace takt {
namespace {

constexpr std::uint16_t first_real_object = 0x0020;

/// Returns a hint for a missing object: its sub-indices, or the nearest object with a mappable
/// entry.
std::string suggestion(const ObjectDictionary& dictionary, ObjectKey key) {
  if (const Object* object = dictionary.find(key.index)) {
    if (object->subs.empty()) return {};
    std::string subs;
    for (const SubObject& sub : object->subs) {
      if (subs.size() > 60) return "; " + hex(key.index) + " has " + subs + ", ...";
      subs += (subs.empty() ? "" : ", ") + to_string(ObjectKey{key.index, sub.sub}).substr(5);
    }
    return "; " + hex(key.index) + " " + object->name + " has sub-index " + subs;
  }
  if (const std::string slip = without_0x(dictionary, key.index); !slip.empty()) return slip;
  const Object* best = nullptr;
  for (const Object& object : dictionary.objects) {
    const bool mappable = std::ranges::any_of(object.subs, &SubObject::pdo_mappable);
    if (!mappable || std::abs(object.index - key.index) > 0x10) continue;
    if (best == nullptr || std::abs(object.index - key.index) < std::abs(best->index - key.index)) {
      best = &object;
    }
  }
  return best == nullptr ? std::string{}
                         : "; did you mean " + hex(best->index) + " " + best->name + "?";
}

class MappingCompiler {
 public:
  MappingCompiler(const NodeSource& node, const EffectivePdo& pdo, NetworkReport& report)
      : node_{node}, pdo_{pdo}, report_{report} {}

  std::optional<EffectiveEntry> entry(const MappingSpec& wanted) {
    EffectiveEntry out{.object = wanted.object, .pos = wanted.pos};
    if (wanted.object.index < first_real_object) return dummy(wanted, out);
    const SubObject* sub = node_.dictionary->find(wanted.object);
    if (sub == nullptr) {
      error(wanted, "no-such-object", "object ", wanted.object, " is not in ",
            node_.dictionary->file, suggestion(*node_.dictionary, wanted.object));
      return {};
    }
    out.type = sub->type;
    out.name = object_name(*node_.dictionary, wanted.object);
    if (!direction_fits(wanted, *sub) || !set_bits(wanted, *sub, out)) return {};
    return out;
  }

 private:
  template <class... Parts>
  void error(const MappingSpec& wanted, std::string_view rule, const Parts&... parts) {
    report_.error(wanted.pos, rule, pdo_.label(*node_.spec), ": ", parts...);
  }
  std::string named(const MappingSpec& wanted) const {
    return label(*node_.dictionary, wanted.object);
  }

  std::optional<EffectiveEntry> dummy(const MappingSpec& wanted, EffectiveEntry& out) {
    const auto type = static_cast<DataType>(wanted.object.index);
    const bool known = wanted.object.index < 8 && wanted.object.sub == 0 &&
                       node_.dictionary->dummy_usage[wanted.object.index];
    if (pdo_.is_tpdo || !known) {
      error(wanted, "dummy", "a dummy entry ", hex(wanted.object.index),
            pdo_.is_tpdo ? " has no place in a TPDO (gaps are for RPDOs only)"
                         : " is not among the [DummyUsage] of " + node_.dictionary->file);
      return {};
    }
    out.dummy = true;
    out.type = type;
    out.name = "gap";
    out.bits =
        static_cast<std::uint8_t>(wanted.bits.value_or(static_cast<std::uint8_t>(bit_width(type))));
    return out;
  }

  bool direction_fits(const MappingSpec& wanted, const SubObject& sub) {
    if (!sub.pdo_mappable) {
      error(wanted, "not-mappable", "object ", named(wanted),
            " is not PDO-mappable (PDOMapping=0 in ", node_.dictionary->file, ")",
            mappable_sibling(wanted.object));
      return false;
    }
    const Access access = sub.access;
    const bool reads = access != Access::wo && access != Access::rww;
    const bool writes = access == Access::wo || access == Access::rw || access == Access::rww;
    if (pdo_.is_tpdo ? reads : writes) return true;
    error(wanted, "wrong-direction", "object ", named(wanted),
          pdo_.is_tpdo ? " can only be written: it belongs in an RPDO (master to device)"
                       : " can only be read: it belongs in a TPDO (device to master)");
    return false;
  }

  std::string mappable_sibling(ObjectKey key) const {
    const Object* object = node_.dictionary->find(key.index);
    for (const SubObject& sub : object->subs) {
      if (sub.pdo_mappable) {
        return "; mappable there: " + label(*node_.dictionary, {key.index, sub.sub});
      }
    }
    return {};
  }

  bool set_bits(const MappingSpec& wanted, const SubObject& sub, EffectiveEntry& out) {
    const unsigned width = bit_width(sub.type);
    const unsigned bits = wanted.bits ? *wanted.bits : width;
    if (bits == 0) {
      error(wanted, "no-width", "object ", named(wanted), " has no fixed width (", name(sub.type),
            "): write `bits:`");
      return false;
    }
    const bool boolean_byte = sub.type == DataType::boolean && bits == 8;
    if (width != 0 && bits != width && !boolean_byte) {
      error(wanted, "wrong-width", "object ", named(wanted), " is ", width, " bits wide, not ",
            bits);
      return false;
    }
    out.bits = static_cast<std::uint8_t>(bits);
    return true;
  }

  const NodeSource& node_;
  const EffectivePdo& pdo_;
  NetworkReport& report_;
};

void report_length(const NodeSource& node, const EffectivePdo& pdo, SourcePos pos, unsigned bits,
                   NetworkReport& report) {
  if (bits <= 64) return;
  report.error(pos, "too-long", pdo.label(*node.spec), " maps ", bits,
               " bits, a PDO holds 64: move ", bits - 64, " bits or more into another PDO");
}

}  // namespace

std::vector<EffectiveEntry> compile_mapping(const NodeSource& node, const EffectivePdo& pdo,
                                            const Sourced<std::vector<MappingSpec>>& wanted,
                                            NetworkReport& report) {
  std::vector<EffectiveEntry> entries;
  MappingCompiler compiler{node, pdo, report};
  unsigned bits = 0;
  for (const MappingSpec& spec : *wanted) {
    auto entry = compiler.entry(spec);
    if (!entry) continue;
    if (!entry->dummy &&
        std::ranges::find(entries, entry->object, &EffectiveEntry::object) != entries.end()) {
      report.warning(spec.pos, "mapped-twice", pdo.label(*node.spec), " maps ",
                     label(*node.dictionary, spec.object), " twice: ",
                     pdo.is_tpdo ? "the second one is a separate input" : "both get the same value",
                     "; is one of them meant for another object?");
    }
    entry->bit_offset = static_cast<std::uint8_t>(std::min(bits, 64U));
    bits += entry->bits;
    entries.push_back(std::move(*entry));
  }
  report_length(node, pdo, wanted.pos, bits, report);
  return entries;
}

std::vector<EffectiveEntry> mapping_of(const NodeSource& node, const PdoDescription& pdo,
                                       SourcePos pos) {
  std::vector<EffectiveEntry> entries;
  for (const MappedObject& mapped : pdo.mapping) {
    const SubObject* sub = node.dictionary->find(mapped.key);
    entries.push_back(
        {.object = mapped.key,
         .bits = mapped.bits,
         .bit_offset = static_cast<std::uint8_t>(std::min<unsigned>(mapped.bit_offset, 64)),
         .dummy = mapped.is_dummy(),
         .type = sub != nullptr ? sub->type : DataType::unknown,
         .name = mapped.is_dummy() ? "gap" : object_name(*node.dictionary, mapped.key),
         .pos = pos});
  }
  return entries;
}

std::string label(const ObjectDictionary& dictionary, ObjectKey key) {
  const std::string text = object_name(dictionary, key);
  return to_string(key) + (text.empty() ? "" : " " + text);
}

std::string without_0x(const ObjectDictionary& dictionary, std::uint16_t index) {
  const std::string digits = std::to_string(index);
  std::uint16_t meant = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), meant, 16);
  const Object* object = digits.size() == 4 ? dictionary.find(meant) : nullptr;
  if (object == nullptr) return {};
  return "; " + digits + " is " + hex(index) + ": did you mean " + hex(meant) + " " + object->name +
         "?";
}

}  // namespace takt
