#include <array>
#include <string>

#include "eds_parser/network_file/sections.hpp"

namespace takt {
namespace {

constexpr std::size_t most_timeouts = 256;

void read_channel(MapReader& outer, NodeSpec& node) {
  const YamlNode* map = outer.take("sdo_channel");
  if (map == nullptr) return;
  MapReader reader{*map, "`sdo_channel` of " + outer.what(), outer.report()};
  Sourced<std::uint32_t> request;
  Sourced<std::uint32_t> answer;
  reader.integer("request", request, {0x581, 0x7FF});
  reader.integer("answer", answer, {0x581, 0x7FF});
  reader.finish();
  if (!request.given || !answer.given || *request == *answer) {
    outer.report().error(
        map->pos, "missing-key",
        "`sdo_channel` of " + outer.what() +
            " needs two COB-IDs, as in `{request: 0x645, answer: 0x5C5}`: for the requests of the "
            "master and for the answers of the device (0x1201:01 and 02)");
    return;
  }
  node.sdo_channel = {{CobId::base(*request), CobId::base(*answer)}, map->pos, true};
}

void read_timeout(const YamlNode& item, MapReader& outer, NodeSpec& node) {
  MapReader reader{item, "`sdo_timeouts` of " + outer.what(), outer.report()};
  Sourced<std::uint16_t> index;
  Sourced<std::uint8_t> sub;
  Sourced<std::uint32_t> timeout;
  reader.integer("index", index);
  reader.integer("sub_index", sub);
  reader.integer("timeout_ms", timeout, {1, 600'000, " ms"});
  reader.finish();
  if (!index.given || !timeout.given) {
    outer.report().error(
        item.pos, "missing-key",
        "an entry of `sdo_timeouts` has the form `{index: 0x1F50, timeout_ms: 20000}`");
    return;
  }
  SdoObjectTimeout& entry = node.sdo_timeouts.emplace_back();
  entry.index = *index;
  if (sub.given) entry.sub = *sub;
  entry.timeout = std::chrono::milliseconds{*timeout};
}

}  // namespace

void read_sdo_access(MapReader& reader, NodeSpec& node) {
  if (const YamlNode* block = reader.take("sdo_block")) {
    constexpr std::array<std::string_view, 2> names{"auto", "never"};
    if (const auto choice = read_choice(*block, "sdo_block", names, reader.report())) {
      node.sdo_block = {static_cast<SdoBlockUse>(*choice), block->pos, true};
    }
  }
  read_channel(reader, node);
  const YamlNode* list = reader.take("sdo_timeouts");
  if (list == nullptr || list->kind == YamlNode::Kind::null) return;
  if (list->kind != YamlNode::Kind::sequence || list->items.size() > most_timeouts) {
    reader.report().error(
        list->pos, "wrong-type",
        "`sdo_timeouts` of " + reader.what() +
            " has to be a list of at most 256 `{index: 0x1F50, timeout_ms: 20000}`");
    return;
  }
  for (const YamlNode* item : list->items) read_timeout(*item, reader, node);
}

}  // namespace takt
