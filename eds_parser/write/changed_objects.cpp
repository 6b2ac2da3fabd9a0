#include "eds_parser/write/changed_objects.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace takt {
namespace {

bool same(const std::optional<Value>& old, const std::optional<Value>& now) {
  const auto* real = old ? std::get_if<double>(&*old) : nullptr;
  const auto* other = now ? std::get_if<double>(&*now) : nullptr;
  if (real == nullptr || other == nullptr) return old == now;
  const bool bits = std::bit_cast<std::uint64_t>(*real) == std::bit_cast<std::uint64_t>(*other);
  return bits || (std::isnan(*real) && std::isnan(*other));
}

bool same(const SubObject& old, const SubObject& now) {
  if (old.access != now.access || old.pdo_mappable != now.pdo_mappable) return false;
  if (old.type == DataType::unknown && now.type != DataType::unknown) {
    return old.default_text == now.default_text && old.parameter_text == now.parameter_text;
  }
  return old.type == now.type && same(old.default_value, now.default_value) &&
         same(old.parameter_value, now.parameter_value) && same(old.low_limit, now.low_limit) &&
         same(old.high_limit, now.high_limit);
}

}  // namespace

std::set<std::uint16_t> changed_objects(const ObjectDictionary& before,
                                        const ObjectDictionary& after) {
  std::set<std::uint16_t> changed;
  for (const Object& object : before.objects) {
    const Object* other = after.find(object.index);
    const auto stays = [&](const SubObject& sub) {
      const SubObject* now = after.find(ObjectKey{object.index, sub.sub});
      return now != nullptr && same(sub, *now);
    };
    const bool is_same =
        other != nullptr && other->type == object.type && std::ranges::all_of(object.subs, stays);
    if (!is_same) changed.insert(object.index);
  }
  return changed;
}

}  // namespace takt
