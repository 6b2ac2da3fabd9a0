#include "eds_parser/ini/number.hpp"
#include "eds_parser/read/eds_objects.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

bool inverted(const Value& low, const Value& high) noexcept {
  if (low.index() != high.index() || std::holds_alternative<BoxedText>(low)) return false;
  return high < low;
}

/// Returns true if a negative limit is written without a sign.
bool is_pattern(const std::optional<Value>& limit, std::string_view text) noexcept {
  const auto* number = limit ? std::get_if<std::int64_t>(&*limit) : nullptr;
  if (number == nullptr || *number >= 0) return false;
  const auto written = parse_number(text);
  return written && !written->negative;
}

}  // namespace

/// Drops limits that exclude values, although the author of the file meant to allow these values.
/// CiA 306 does not say how the limit of a signed type is written. Vendors write bit patterns, and
/// numbers above the range of the type.
void ObjectReader::judge_limits(SubObject& sub, const ObjectFields& fields, ObjectKey key) {
  if (sub.low_limit && sub.high_limit && inverted(*sub.low_limit, *sub.high_limit)) {
    report_.warning(fields.pos(Keyword::low_limit), "limits-inverted", key, ": LowLimit ",
                    Quoted{fields.text(Keyword::low_limit)}, " is above HighLimit ",
                    Quoted{fields.text(Keyword::high_limit)}, " in ", sub.type,
                    "; both were left out");
    sub.low_limit.reset();
    sub.high_limit.reset();
    return;
  }
  const auto drop = [&](std::optional<Value>& limit, Keyword keyword, std::string_view what) {
    report_.warning(fields.pos(keyword), "limit-above-type", key, ": ", what, ' ',
                    Quoted{fields.text(keyword)}, " would be ", std::get<std::int64_t>(*limit),
                    " in ", sub.type, "; it was left out");
    limit.reset();
  };
  const bool low = is_pattern(sub.low_limit, fields.text(Keyword::low_limit));
  const bool high = is_pattern(sub.high_limit, fields.text(Keyword::high_limit));
  const bool one_value = low && high && sub.low_limit == sub.high_limit;
  if (one_value && (!sub.default_value || sub.default_value == sub.low_limit)) return;
  const bool holds_default = low && sub.default_value && !outside_limits(*sub.default_value, sub);
  if (high && !holds_default &&
      (!sub.low_limit || sub.low_limit == sub.high_limit ||
       sub.high_limit == Value{std::int64_t{-1}} ||
       !parse_number(fields.text(Keyword::high_limit))->hex)) {
    drop(sub.high_limit, Keyword::high_limit, "HighLimit");
  }
  const auto& value = sub.default_value;
  if (!value) return;
  if (high && sub.high_limit && inverted(*value, *sub.high_limit)) {
    drop(sub.high_limit, Keyword::high_limit, "HighLimit");
  }
  if (low && inverted(*sub.low_limit, *value)) {
    drop(sub.low_limit, Keyword::low_limit, "LowLimit");
  }
}

}  // namespace takt
