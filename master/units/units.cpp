#include "master/units/units.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace takt {
namespace {

constexpr double two_to_63 = 9223372036854775808.0;
constexpr double two_to_64 = 2 * two_to_63;

bool is_pattern(DataType type) noexcept { return is_real(type) || type == DataType::unsigned64; }

std::int64_t pattern_of(DataType type, double number) noexcept {
  if (type == DataType::real32) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(number));
  }
  if (type == DataType::real64) return std::bit_cast<std::int64_t>(number);
  if (number >= two_to_64) return -1;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(std::max(number, 0.0)));
}

}  // namespace

RawRange raw_range(DataType type, unsigned bits) noexcept {
  constexpr RawRange everything{std::numeric_limits<std::int64_t>::min(),
                                std::numeric_limits<std::int64_t>::max()};
  if (bits == 0 || bits >= 64) return everything;
  const std::int64_t span = std::int64_t{1} << (is_signed(type) ? bits - 1 : bits);
  return {is_signed(type) ? -span : 0, span - 1};
}

bool fits(DataType type, unsigned bits, std::int64_t raw) noexcept {
  const RawRange range = raw_range(type, bits);
  return raw >= range.low && raw <= range.high;
}

Units::Units(std::span<const ValueFormat> formats)
    : formats_{formats.begin(), formats.end()},
      scale_{static_cast<Eigen::Index>(formats.size())},
      offset_{static_cast<Eigen::Index>(formats.size())} {
  for (std::size_t i = 0; i < formats_.size(); ++i) {
    scale_[static_cast<Eigen::Index>(i)] = formats_[i].scale;
    offset_[static_cast<Eigen::Index>(i)] = formats_[i].offset;
    if (is_pattern(formats_[i].type)) patterns_.push_back(i);
  }
}

void Units::to_si(std::span<const std::int64_t> raw, Eigen::Ref<Eigen::ArrayXd> si) const {
  assert(raw.size() == size() && static_cast<std::size_t>(si.size()) == size());
  using RawArray = Eigen::Array<std::int64_t, Eigen::Dynamic, 1>;
  const Eigen::Map<const RawArray> values{raw.data(), static_cast<Eigen::Index>(raw.size())};
  si = values.cast<double>() * scale_ + offset_;
  for (const std::size_t i : patterns_) {
    const auto at = static_cast<Eigen::Index>(i);
    si[at] = number_of(formats_[i].type, raw[i]) * scale_[at] + offset_[at];
  }
}

std::int64_t Units::to_raw(std::size_t signal, double si) const {
  const ValueFormat& format = formats_[signal];
  const double number = (std::isnan(si) ? 0.0 - format.offset : si - format.offset) / format.scale;
  if (is_real(format.type)) return pattern_of(format.type, number);
  const double rounded = std::nearbyint(number);
  if (is_pattern(format.type)) return pattern_of(format.type, rounded);
  const RawRange range = raw_range(format.type, format.bits);
  if (rounded <= static_cast<double>(range.low)) return range.low;
  if (rounded >= static_cast<double>(range.high)) return range.high;
  return static_cast<std::int64_t>(rounded);
}

std::optional<std::int64_t> Units::raw_of(std::size_t signal, double si) const {
  const ValueFormat& format = formats_[signal];
  const double number = (si - format.offset) / format.scale;
  if (is_real(format.type)) {
    const double most = format.type == DataType::real32 ? std::numeric_limits<float>::max()
                                                        : std::numeric_limits<double>::max();
    if (!(std::abs(number) <= most)) return std::nullopt;
    return pattern_of(format.type, number);
  }
  const double rounded = std::nearbyint(number);
  const bool pattern = is_pattern(format.type);
  const double low = pattern ? 0.0 : -two_to_63;
  const double end = pattern ? two_to_64 : two_to_63;
  if (!(rounded >= low && rounded < end)) return std::nullopt;
  return pattern ? pattern_of(format.type, rounded) : static_cast<std::int64_t>(rounded);
}

}  // namespace takt
