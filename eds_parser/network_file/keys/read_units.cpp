#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

void read_scale(const KeyInput& in, UnitSpec& unit) {
  set(in, unit.scale);
  if (in.key.value.numbers.contains(*unit.scale)) return;
  in.error("out-of-range", in.what(),
           " has to be above 0 (SI units per count); `sign: -1` reverses the direction");
  unit.scale.value = 1;
}

void read_sign(const KeyInput& in, UnitSpec& unit) {
  set(in, unit.sign);
  if (unit.sign == 0) in.error("out-of-range", in.what(), " has to be 1 or -1");
}

constexpr Key<UnitSpec> unit_keys[] = {
    key<read_scale>("scale", number_above(0), "1", "SI units per count; above 0."),
    key<&UnitSpec::offset>("offset", "0", "The SI value of 0 counts."),
    key<read_sign>("sign", whole(-1, 1), "1", "-1 reverses the direction."),
    key<&UnitSpec::unit>("unit", "none", "The unit of the SI value, for example `rad`."),
};

constexpr Key<ObjectUnitSpec> object_unit_keys[] = {
    index_key<ObjectUnitSpec>(),
    sub_index_key<ObjectUnitSpec>(),
    group<&ObjectUnitSpec::unit, unit_keys>(),
};

constexpr Key<UnitsSpec> units_keys[] = {
    map_key<&UnitsSpec::position, unit_keys>("position", "counts", "For positions."),
    map_key<&UnitsSpec::velocity, unit_keys>("velocity", "counts", "For velocities."),
    map_key<&UnitsSpec::acceleration, unit_keys>("acceleration", "counts", "For accelerations."),
    map_key<&UnitsSpec::torque, unit_keys>("torque", "counts", "For torques."),
    list_key<&UnitsSpec::objects, object_unit_keys>("objects", "counts", "For single objects."),
};

}  // namespace

void read_units(const KeyInput& in, NodeSpec& node) {
  const std::size_t errors = in.report().errors();
  read_map(in.node, in.what(), units_keys, node.units, in.report());
  node.units.has_errors = in.report().errors() != errors;
}

KeyRows units_rows() { return rows_of<units_keys>(); }

}  // namespace takt
