#include "apps/takt/simulate/entry_reader.hpp"

#include "apps/command_line/duration.hpp"

namespace takt {

SourcePos place_of(const YAML::Mark& mark) noexcept {
  if (mark.line < 0) return {};
  return {static_cast<std::uint32_t>(mark.line + 1), static_cast<std::uint32_t>(mark.column + 1)};
}

void EntryReader::error(const YAML::Mark& mark, std::string_view rule, std::string message) {
  findings_.push_back({.file = file_,
                       .pos = place_of(mark),
                       .severity = Severity::error,
                       .rule = rule,
                       .message = std::move(message)});
}

void EntryReader::refuse(const EntryItem& item, const std::string& wanted) {
  const std::string given =
      item.is_scalar ? "`" + item.text + "`" : "the value of `" + item.key + "`";
  error(item.mark, "fault-value", given + " is not " + wanted);
}

void EntryReader::read_time(Time& time, const EntryItem& item) {
  const auto parsed = parse_duration(item.text);
  const bool has_unit = item.text.find_first_not_of("0123456789.") != std::string::npos;
  if (!parsed || !has_unit) return refuse(item, "a time like 500ms, 2s or 100us");
  time = *parsed;
}

}  // namespace takt
