#include <algorithm>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/network_parts.hpp"

namespace takt {
namespace {

bool may_be_same(const LssPlan& a, const LssPlan& b) {
  for (std::size_t i = 0; i < a.address.size(); ++i) {
    if (((a.address[i] ^ b.address[i]) & a.known[i] & b.known[i]) != 0) return false;
  }
  return true;
}

/// Returns a number of the identity object (0x1018) from the network file, else from the device
/// file.
std::uint32_t identity(const Sourced<std::uint32_t>& wanted, const ObjectDictionary& dictionary,
                       std::uint8_t sub) {
  return wanted.given ? *wanted : unsigned32_of(dictionary, {0x1018, sub});
}

/// Returns the LSS address of a node. A number of 0 counts as unknown. The exception is a vendor ID
/// of 0 next to a known product code: such a device has no vendor ID.
LssPlan lss_plan(const NodeSpec& node, const ObjectDictionary& dictionary) {
  LssPlan lss{.address = {identity(node.vendor_id, dictionary, 1),
                          identity(node.product_code, dictionary, 2), *node.revision_number,
                          *node.serial_number},
              .store = *node.lss_store};
  std::ranges::transform(lss.address, lss.known.begin(),
                         [](std::uint32_t number) { return number != 0 ? ~std::uint32_t{0} : 0; });
  if (lss.known[1] != 0) lss.known[0] = ~std::uint32_t{0};
  return lss;
}

}  // namespace

std::optional<LssPlan> compile_lss(const NodeSpec& node, const ObjectDictionary& dictionary,
                                   std::span<const NodePlan> others, NetworkReport& report) {
  if (!*node.lss) return {};
  if (!*node.boot) {
    report.error(node.lss.pos, "lss", "node `", node.name,
                 "` is only watched (`boot: false`), so it can't get its id by LSS");
    return {};
  }
  const LssPlan lss = lss_plan(node, dictionary);
  if (lss.known[1] == 0) {
    report.error(node.lss.pos, "lss", "LSS finds node `", node.name, "` by its identity, and ",
                 dictionary.file,
                 " has no product code in 1018:02: write `vendor_id` and `product_code`, and "
                 "preferably `serial_number`");
  }
  for (const NodePlan& other : others) {
    if (!other.lss || !may_be_same(*other.lss, lss)) continue;
    report.warning(node.lss.pos, "lss", "LSS can't distinguish nodes `", other.name, "` and `",
                   node.name, "`: the device with the lower serial number becomes `", other.name,
                   "`; write `serial_number` to identify each device");
  }
  return lss;
}

}  // namespace takt
