#include "eds_parser/plan/device/node_objects.hpp"

#include <algorithm>

#include "eds_parser/dictionary/integer_of.hpp"

namespace takt {

std::optional<std::int64_t> written_object(const NodeSource& node, ObjectKey object) {
  const auto& list = node.spec->sdo;
  const auto sdo = std::ranges::find(list.rbegin(), list.rend(), object, &SdoSpec::object);
  if (sdo != list.rend()) {
    return sdo->integer() == nullptr ? std::nullopt : std::optional{*sdo->integer()};
  }
  const SubObject* sub = node.dictionary->find(object);
  return sub == nullptr ? std::nullopt : integer_of(sub->parameter_value);
}

std::optional<std::int64_t> configured_object(const NodeSource& node, ObjectKey object) {
  if (const auto written = written_object(node, object)) return written;
  return integer_of(*node.dictionary, object);
}

}  // namespace takt
