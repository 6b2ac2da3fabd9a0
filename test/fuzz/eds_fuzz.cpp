#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string_view>

#include "eds_parser/check/check.hpp"
#include "eds_parser/eds.hpp"
#include "eds_parser/print/dictionary.hpp"

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
  return 0;
}
