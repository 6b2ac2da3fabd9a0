#include "master/sim/dictionary/parameter_storage.hpp"

namespace takt::sim {
namespace {

constexpr std::uint64_t save = 0x6576'6173;  // "save"
constexpr std::uint64_t load = 0x6461'6F6C;  // "load"

struct Range {
  std::uint16_t first = 0;
  std::uint16_t last = 0;
};

Range range_of(std::uint8_t sub) noexcept {
  switch (sub) {
    case 1:
      return {0x1000, 0x9FFF};
    case 2:
      return {0x1000, 0x1FFF};
    case 3:
      return {0x6000, 0x9FFF};
    default:
      return {0x2000, 0x5FFF};
  }
}

}  // namespace

Abort ParameterStorage::execute(ObjectKey key, std::uint64_t signature) noexcept {
  const bool storing = key.index == 0x1010;
  if (signature != (storing ? save : load)) return Abort::store;
  const Range range = range_of(key.sub);
  if (storing) {
    store_.save(range.first, range.last);
  } else {
    store_.restore(range.first, range.last);
  }
  return Abort::none;
}

}  // namespace takt::sim
