#include "apps/takt/service/lss/lss_selection.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace takt {
namespace {

constexpr std::array<const char*, 4> part_names{"vendor_id", "product_code", "revision_number",
                                                "serial_number"};

/// Returns the LSS address if the command line gives all four numbers.
std::optional<LssAddress> whole_address(const LssOptions& options) {
  LssAddress address{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto value = parse_unsigned(options.parts[i]);
    if (!value) return {};
    address[i] = *value;
  }
  return address;
}

}  // namespace

std::optional<LssRange> lss_range(const std::string& text) {
  if (text.empty()) return LssRange{0, 0xFFFF'FFFF};
  const std::size_t dash = text.find('-');
  const auto from = parse_unsigned(text.substr(0, dash));
  const auto to = dash == std::string::npos ? from : parse_unsigned(text.substr(dash + 1));
  if (!from || !to || *from > *to) return {};
  return LssRange{*from, *to};
}

std::string device_text(const LssAddress& address) {
  return fmt::format("vendor 0x{:08X}  product 0x{:08X}  revision 0x{:08X}  serial 0x{:08X}",
                     address[0], address[1], address[2], address[3]);
}

nlohmann::json device_json(const LssAddress& address) {
  nlohmann::json json;
  for (std::size_t i = 0; i < 4; ++i) json[part_names[i]] = address[i];
  return json;
}

LssCommand fast_scan(const LssOptions& options) {
  LssCommand scan{.op = LssOp::fast_scan};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto value = parse_unsigned(options.parts[i]);
    scan.numbers[i] = value.value_or(0);
    scan.numbers[4 + i] = value ? ~std::uint32_t{0} : 0;
  }
  return scan;
}

LssCommand selection(const LssOptions& options) {
  if (options.alone || options.all) return {.op = LssOp::switch_global, .a = 1};
  const auto address = whole_address(options);
  if (!address) return fast_scan(options);
  LssCommand select{.op = LssOp::switch_selective};
  std::ranges::copy(*address, select.numbers.begin());
  return select;
}

std::optional<LssAddress> device_of(const LssOptions& options, const LssResult& selected) {
  if (selected.op == LssOp::fast_scan) return selected.numbers;
  return options.alone || options.all ? std::nullopt : whole_address(options);
}

}  // namespace takt
