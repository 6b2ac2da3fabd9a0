#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <sstream>
#include <string_view>

#include "eds_parser/check/check.hpp"
#include "eds_parser/dictionary/concise_dcf.hpp"
#include "eds_parser/print/print_dictionary.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/write/configured_values.hpp"
#include "eds_parser/write/dcf_writer.hpp"
#include "eds_parser/write/eds_fix.hpp"

namespace {

void demand(bool holds) {
  if (!holds) __builtin_trap();
}

/// Real values are not compared, because a NaN equals nothing.
bool same(const std::optional<takt::Value>& a, const std::optional<takt::Value>& b) {
  return a == b || (a && b && std::holds_alternative<double>(*a));
}

bool is_set(const takt::DcfOptions& options, takt::ObjectKey key) {
  return std::ranges::find(options.values, key, &takt::DcfValue::object) != options.values.end();
}

/// Demands that `after` has each object of `before` with its values, except for the values that
/// were set.
void demand_objects(const takt::ObjectDictionary& before, const takt::ObjectDictionary& after,
                    const takt::DcfOptions& options = {}) {
  for (const auto& object : before.objects) {
    demand(after.find(object.index) != nullptr);
    for (const auto& sub : object.subs) {
      if (before.find({object.index, sub.sub}) != &sub) continue;
      const takt::ObjectKey key{object.index, sub.sub};
      const auto* now = after.find(key);
      demand(now != nullptr);
      demand(now->access == sub.access);
      if (sub.type == takt::DataType::unknown) continue;
      demand(now->type == sub.type && same(now->default_value, sub.default_value));
      demand(is_set(options, key) || same(now->parameter_value, sub.parameter_value));
    }
  }
}

/// Gives the last objects a value. The DCF must have these values and the other objects of the
/// file.
void write_as_dcf(std::string_view text, const takt::EdsFile& file) {
  takt::DcfOptions options{.node = file.dictionary.node_id,
                           .baudrate_kbit = 500,
                           .node_name = "axis",
                           .out_name = "fuzz.dcf",
                           .values = {}};
  for (auto object = file.dictionary.objects.rbegin();
       object != file.dictionary.objects.rend() && options.values.size() < 3; ++object) {
    if (object->subs.empty()) continue;
    const auto& sub = object->subs.back();
    if (sub.access == takt::Access::rw) options.values.push_back({{object->index, sub.sub}, "1"});
  }
  const auto dcf = takt::write_dcf(text, "fuzz.eds", options);
  demand(dcf.text.empty() == takt::has_error(dcf.findings));
  if (takt::has_error(dcf.findings)) return;
  const auto again = takt::read_eds(dcf.text, "fuzz.dcf", options.node);
  demand(again.dictionary.objects.size() == file.dictionary.objects.size());
  demand_objects(file.dictionary, again.dictionary, options);
  for (const auto& value : options.values) {
    demand(again.dictionary.find(value.object)->parameter_value.has_value());
  }
}

/// If no value is set, the written text must equal the text that was read. UTF-16 is an exception.
void write_unchanged(std::string_view text, const takt::EdsFile& file) {
  const auto& findings = file.findings;
  if (std::ranges::find(findings, "utf-16", &takt::Finding::rule) != findings.end()) return;
  demand(takt::write_dcf(text, "fuzz.dcf", {}).text == text);
}

/// The configured values must stay the same when they are encoded to bytes and decoded.
void write_concise(const takt::EdsFile& file) {
  takt::Report report{"fuzz.eds"};
  const auto entries = takt::configured_values(file.dictionary, report);
  const auto bytes = takt::encode_concise_dcf(entries);
  const auto again = takt::decode_concise_dcf(bytes);
  demand(again.has_value() && *again == entries);
}

/// Reads any bytes as a concise DCF. The entries, encoded again, must be the first bytes of the
/// input.
void read_concise(std::span<const std::byte> bytes) {
  const auto entries = takt::decode_concise_dcf(bytes);
  if (!entries || bytes.empty()) return;
  const auto again = takt::encode_concise_dcf(*entries);
  demand(again.size() <= bytes.size() && std::ranges::equal(again, bytes.first(again.size())));
}

/// A corrected file must have all objects that it had before, and a second correction must find
/// nothing.
void mend(std::string_view text, const takt::EdsFile& file) {
  const auto fixed = takt::fix_eds(text, "fuzz.eds");
  demand(fixed.readable == file.readable);
  if (!fixed.readable) return;
  const auto again = takt::read_eds(fixed.text, "fuzz.eds", file.dictionary.node_id);
  demand_objects(file.dictionary, again.dictionary);
  demand(takt::fix_eds(fixed.text, "fuzz.eds").text == fixed.text);
}

}  // namespace

/// Gives any bytes as an EDS to everything that reads or writes an EDS.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  read_concise(std::as_bytes(std::span{data, size}));
  const auto node = size % 2 == 0 ? takt::NodeId::from(5) : std::nullopt;
  const auto file = takt::read_eds(text, "fuzz.eds", node);
  const auto findings = takt::check(file.dictionary);
  for (const auto& object : file.dictionary.objects) {
    for (const auto& sub : object.subs) {
      if (sub.value()) static_cast<void>(takt::to_bytes(*sub.value(), sub.type));
    }
    if (object.subs.size() > 64) return 0;  // long compact lists only take time to print
  }
  std::ostringstream out;
  takt::print_json(out, file.dictionary, findings);
  takt::print_text(out, file.dictionary);
  write_concise(file);
  mend(text, file);
  if (!file.readable) return 0;
  write_unchanged(text, file);
  write_as_dcf(text, file);
  return 0;
}
