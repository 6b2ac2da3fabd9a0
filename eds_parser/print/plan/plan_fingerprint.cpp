#include "eds_parser/print/plan/plan_fingerprint.hpp"

#include <cstdint>
#include <fmt/format.h>
#include <sstream>

#include "eds_parser/print/plan/print_plan.hpp"

namespace takt {

std::string plan_fingerprint(const BusPlan& plan) {
  BusPlan bare = plan;
  bare.name.clear();
  bare.interface.clear();
  std::ostringstream text;
  print_plan_json(text, bare, {});
  std::uint64_t hash = 0xCBF2'9CE4'8422'2325;  // FNV-1a
  for (const char letter : text.str()) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100'0000'01B3;
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace takt
