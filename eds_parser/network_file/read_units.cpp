#include "eds_parser/network_file/sections.hpp"

namespace takt {
namespace {

void read_unit_fields(MapReader& reader, UnitSpec& unit) {
  NetworkReport& report = reader.report();
  Sourced<double> offset;
  Sourced<std::int32_t> sign;
  Sourced<std::string> text;
  reader.number("scale", unit.scale);
  reader.number("offset", offset);
  reader.integer("sign", sign, {-1, 1});
  reader.text("unit", text);
  reader.finish();
  if (unit.scale.given && *unit.scale <= 0) {
    report.error(unit.scale.pos, "out-of-range",
                 "`scale` of " + reader.what() +
                     " has to be above 0 (SI units per count); `sign: -1` reverses the direction");
    unit.scale.value = 1;
  }
  if (sign.given && *sign == 0) {
    report.error(sign.pos, "out-of-range", "`sign` of " + reader.what() + " has to be 1 or -1");
  }
  unit.offset = *offset;
  unit.sign = sign.given && *sign < 0 ? -1 : 1;
  unit.unit = *text;
}

std::optional<UnitSpec> read_unit(const YamlNode& node, const std::string& what,
                                  NetworkReport& report) {
  MapReader reader{node, what, report};
  UnitSpec unit;
  unit.pos = node.pos;
  read_unit_fields(reader, unit);
  return unit;
}

}  // namespace

UnitsSpec read_units(const YamlNode& node, const std::string& owner, NetworkReport& report) {
  UnitsSpec units;
  const std::size_t errors = report.errors();
  MapReader reader{node, "`units` of " + owner, report};
  const auto quantity = [&](std::string_view key, std::optional<UnitSpec>& out) {
    if (const YamlNode* map = reader.take(key)) {
      out = read_unit(*map, "`" + std::string{key} + "` units of " + owner, report);
    }
  };
  quantity("position", units.position);
  quantity("velocity", units.velocity);
  quantity("acceleration", units.acceleration);
  quantity("torque", units.torque);
  if (const YamlNode* list = reader.take("objects")) {
    if (list->kind != YamlNode::Kind::sequence) {
      report.error(
          list->pos, "wrong-type",
          "`objects` has to be a list of `{index: 0x2000, sub_index: 1, scale: 0.1, unit: V}`");
    }
    for (const YamlNode* item : list->items) {
      MapReader entry{*item, "an entry of `units: objects` of " + owner, report};
      const auto key = read_object_key(entry, item->pos);
      UnitSpec unit;
      unit.pos = item->pos;
      read_unit_fields(entry, unit);
      if (key) units.objects.push_back({*key, unit});
    }
  }
  reader.finish();
  units.has_errors = report.errors() != errors;
  return units;
}

}  // namespace takt
