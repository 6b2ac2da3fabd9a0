#include <array>
#include <string>

#include "eds_parser/network_file/sections.hpp"

namespace takt {
namespace {

constexpr std::size_t most_timeouts = 256;

void read_channel(MapReader& outer, NodeSpec& node) {
  const YamlNode* map = outer.take("sdo_channel");
  if (map == nullptr) return;
  const std::size_t errors = outer.report().errors();
  MapReader reader{*map, "`sdo_channel` of " + outer.what(), outer.report()};
  Sourced<std::uint32_t> request;
  Sourced<std::uint32_t> answer;
  reader.integer("request", request, {0x581, 0x7FF});
  reader.integer("answer", answer, {0x581, 0x7FF});
  reader.finish();
  if (outer.report().errors() != errors) return;
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
  NetworkReport& report = outer.report();
  const std::size_t errors = report.errors();
  MapReader reader{item, "an entry of `sdo_timeouts` of " + outer.what(), report};
  Sourced<std::uint32_t> timeout;
  reader.integer("timeout_ms", timeout, {1, 600'000, " ms"});
  const bool has_sub = reader.take("sub_index") != nullptr;
  const auto key = read_object_key(reader, item.pos);
  reader.finish();
  if (report.errors() != errors) return;
  if (!key || !timeout.given) {
    report.error(item.pos, "missing-key",
                 "an entry of `sdo_timeouts` has the form `{index: 0x1F50, timeout_ms: 20000}`");
    return;
  }
  SdoObjectTimeout& entry = node.sdo_timeouts.emplace_back();
  entry.index = key->index;
  if (has_sub) entry.sub = key->sub;
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
