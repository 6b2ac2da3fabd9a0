#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "eds_parser/report/source.hpp"

namespace takt {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Returns a list of what `make` returns for each item.
template <class Items, class Make>
Json list_of(const Items& items, Make make) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(make(item));
  return list;
}

inline Json json_of(const Finding& finding) {
  return {{"line", finding.pos.line},
          {"column", finding.pos.column},
          {"severity", name(finding.severity)},
          {"rule", finding.rule},
          {"message", finding.message}};
}

/// Prints a document in ASCII. Bytes that are not UTF-8, for example of a file name, are replaced.
/// Otherwise dump() would throw an exception.
inline void print_document(std::ostream& out, const Json& document) {
  out << document.dump(2, ' ', true, Json::error_handler_t::replace) << '\n';
}

}  // namespace takt
