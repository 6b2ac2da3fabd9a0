#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string_view>

#include "eds_parser/check/check.hpp"
#include "eds_parser/eds.hpp"
#include "eds_parser/print/dictionary.hpp"
#include "eds_parser/write/configured_values.hpp"
#include "eds_parser/write/dcf_writer.hpp"

namespace {

/// Gives the last objects a value: the DCF must have the objects that the file had.
void write_as_dcf(std::string_view text, const takt::EdsFile& file) {
  takt::DcfOptions options{.node = file.dictionary.node_id};
  for (auto object = file.dictionary.objects.rbegin();
       object != file.dictionary.objects.rend() && options.values.size() < 3; ++object) {
    if (object->subs.empty()) continue;
    const auto& sub = object->subs.back();
    if (sub.access == takt::Access::rw) options.values.push_back({{object->index, sub.sub}, "1"});
  }
  const auto dcf = takt::write_dcf(text, "fuzz.eds", options);
  if (takt::has_error(dcf.findings)) return;
  const auto again = takt::read_eds(dcf.text, "fuzz.dcf", options.node);
  if (again.dictionary.objects.size() != file.dictionary.objects.size()) __builtin_trap();
}

}  // namespace

/// Any bytes as an EDS, through everything that looks at one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
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
  takt::Report report{"fuzz.eds"};
  static_cast<void>(takt::configured_values(file.dictionary, report));
  if (file.readable) write_as_dcf(text, file);
  return 0;
}
