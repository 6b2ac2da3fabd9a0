#include "eds_parser/network_file/read_devices.hpp"

#include <array>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/network_file/map_reader.hpp"
#include "eds_parser/network_file/yaml_tree.hpp"

namespace takt {
namespace {

constexpr std::size_t max_items = 1024;

class DeviceReader {
 public:
  DeviceReader(const YamlNode& root, DeviceData& data, NetworkReport& report)
      : root_{root}, data_{data}, report_{report} {}

  void run() {
    MapReader reader{root_, "the device data", report_};
    data_.pos = root_.pos;
    data_.name = text(reader, "name");
    data_.manual = text(reader, "manual");
    identity(reader);
    section(reader, "node_ids", [&](MapReader& map) { node_ids(map); });
    section(reader, "heartbeat", [&](MapReader& map) { heartbeat(map); });
    list(reader, "sdo", [&](const YamlNode& item) { value(item); });
    list(reader, "sdo_timeouts", [&](const YamlNode& item) { timeout(item); });
    list(reader, "tpdo", [&](const YamlNode& item) { pdo(item, true); });
    list(reader, "rpdo", [&](const YamlNode& item) { pdo(item, false); });
    section(reader, "inhibit_time", [&](MapReader& map) { inhibit(map); });
    section(reader, "event_timer", [&](MapReader& map) { timer(map); });
    section(reader, "sync_producer", [&](MapReader& map) { sync(map); });
    list(reader, "objects", [&](const YamlNode& item) { object(item); });
    list(reader, "sdo_servers", [&](const YamlNode& item) { sdo_server(item); });
    section(reader, "boot", [&](MapReader& map) { boot(map); });
    data_.on_sync_loss = text(reader, "on_sync_loss");
    emcy(reader);
    reader.finish();
    if (data_.name.empty()) report_.error(root_.pos, "missing-key", "the entry lacks `name`");
  }

 private:
  std::string text(MapReader& reader, std::string_view key) {
    Sourced<std::string> value;
    reader.text(key, value);
    return *value;
  }

  template <class Read>
  void section(MapReader& reader, std::string_view key, Read read) {
    const YamlNode* node = reader.take(key);
    if (node == nullptr) return;
    MapReader map{*node, "`" + std::string{key} + "`", report_};
    read(map);
    map.finish();
  }

  template <class Read>
  void list(MapReader& reader, std::string_view key, Read read) {
    const YamlNode* node = reader.take(key);
    if (node == nullptr) return;
    if (node->kind != YamlNode::Kind::sequence || node->items.size() > max_items) {
      report_.error(node->pos, "wrong-type",
                    "`" + std::string{key} + "` has to be a list of at most 1024 entries");
      return;
    }
    for (const YamlNode* item : node->items) read(*item);
  }

  void need(MapReader& reader, std::string_view key) {
    if (reader.take(key) != nullptr) return;
    report_.error(reader.key_pos(key), "missing-key",
                  reader.what() + " lacks `" + std::string{key} + "`");
  }

  DeviceFact fact(MapReader& reader, SourcePos pos) { return {pos, text(reader, "reason")}; }

  /// Reads a number, or a range `[low, high]`.
  std::optional<NumberRange> range(const YamlNode& node, std::string_view key,
                                   IntegerRange limits) {
    if (node.kind != YamlNode::Kind::sequence) {
      const auto value = read_integer(node, key, limits, report_);
      if (!value) return {};
      return NumberRange{static_cast<std::uint32_t>(*value), static_cast<std::uint32_t>(*value)};
    }
    if (node.items.size() != 2) {
      report_.error(node.pos, "wrong-type",
                    "`" + std::string{key} + "` takes a number or `[lowest, highest]`");
      return {};
    }
    const auto low = read_integer(*node.items[0], key, limits, report_);
    const auto high = read_integer(*node.items[1], key, limits, report_);
    if (!low || !high) return {};
    if (*low > *high) {
      report_.error(node.pos, "out-of-range",
                    "`" + std::string{key} + "`: write the lower number first");
      return {};
    }
    return NumberRange{static_cast<std::uint32_t>(*low), static_cast<std::uint32_t>(*high)};
  }

  void take_range(MapReader& reader, std::string_view key, NumberRange& out, IntegerRange limits) {
    const YamlNode* node = reader.take(key);
    if (node == nullptr) return;
    if (const auto value = range(*node, key, limits)) out = *value;
  }

  std::optional<Firmware> firmware(MapReader& reader, std::string_view key) {
    Sourced<std::string> value;
    reader.text(key, value);
    if (!value.given) return {};
    const auto version = Firmware::parse(*value);
    if (!version) {
      report_.error(value.pos, "not-a-version",
                    "`" + std::string{key} + "` has to be a version like \"16.00.00\"");
    }
    return version;
  }

  void identity(MapReader& outer) {
    firmware_in_revision(outer);
    const YamlNode* node = outer.take("match");
    if (node == nullptr) {
      report_.error(
          root_.pos, "missing-key",
          "the entry lacks `match: {vendor_id: ..., product_code: ..., revision: ...}` "
          "or a list of them, or `match: none` if only `device:` of a node shall select the entry");
      return;
    }
    if (node->kind == YamlNode::Kind::scalar && node->text == "none") return;
    if (node->kind != YamlNode::Kind::sequence) return match(*node);
    if (node->items.empty() || node->items.size() > max_items) {
      report_.error(node->pos, "wrong-type",
                    "`match` has to be one identity, a list of identities, or `none`");
      return;
    }
    for (const YamlNode* item : node->items) match(*item);
  }

  void match(const YamlNode& node) {
    constexpr IntegerRange any{0, 0xFFFF'FFFF};
    MapReader reader{node, "`match`", report_};
    DeviceMatch out;
    Sourced<std::uint32_t> vendor;
    reader.integer("vendor_id", vendor, {1, 0xFFFF'FFFF});
    take_range(reader, "product_code", out.product, any);
    take_range(reader, "revision", out.revision, any);
    reader.finish();
    if (!vendor.given) report_.error(node.pos, "missing-key", "`match` lacks `vendor_id`");
    out.vendor = *vendor;
    data_.matches.push_back(out);
  }

  void firmware_in_revision(MapReader& outer) {
    Sourced<bool> is_firmware;
    outer.boolean("revision_is_firmware", is_firmware);
    data_.revision_is_firmware = *is_firmware;
  }

  void node_ids(MapReader& reader) {
    take_range(reader, "range", data_.node_ids.ids, {1, 127});
    need(reader, "range");
    data_.node_ids.fact = fact(reader, reader.key_pos("range"));
  }

  void heartbeat(MapReader& reader) {
    need(reader, "multiple_of_ms");
    Sourced<std::uint16_t> multiple;
    reader.integer("multiple_of_ms", multiple, {1, 1000, " ms"});
    data_.heartbeat = {.fact = fact(reader, reader.key_pos("multiple_of_ms")),
                       .multiple_of_ms = multiple.value_or(1)};
  }

  void value(const YamlNode& item) {
    MapReader reader{item, "`sdo`", report_};
    need(reader, "index");
    need(reader, "value");
    Sourced<std::uint16_t> index;
    Sourced<std::uint8_t> sub;
    Sourced<std::int64_t> number;
    reader.integer("index", index, {0x1000, 0xFFFF});
    reader.integer("sub_index", sub);
    reader.integer("value", number, {-0x8000'0000LL, 0xFFFF'FFFFLL});
    ValueEdit edit{.fact = fact(reader, item.pos), .object = {*index, *sub}, .value = *number};
    reader.finish();
    if (is_pdo_parameter(*index)) {
      report_.error(
          index.pos, "wrong-object",
          "`sdo` is not for PDO parameters (0x1400..0x1BFF); write rules of `tpdo` and `rpdo`");
      return;
    }
    data_.values.push_back(std::move(edit));
  }

  void timeout(const YamlNode& item) {
    MapReader reader{item, "`sdo_timeouts`", report_};
    need(reader, "index");
    need(reader, "timeout_ms");
    Sourced<std::uint16_t> index;
    Sourced<std::uint8_t> sub;
    Sourced<std::uint32_t> ms;
    reader.integer("index", index, {0x1000, 0xFFFF});
    reader.integer("sub_index", sub);
    reader.integer("timeout_ms", ms, {1, 600'000, " ms"});
    TimeoutEdit edit{.fact = fact(reader, item.pos), .timeout = {.index = *index}};
    reader.finish();
    if (sub.given) edit.timeout.sub = *sub;
    edit.timeout.timeout = std::chrono::milliseconds{*ms};
    data_.timeouts.push_back(std::move(edit));
  }

  void pdo(const YamlNode& item, bool is_tpdo) {
    MapReader reader{item, is_tpdo ? "`tpdo`" : "`rpdo`", report_};
    PdoRule rule{.fact = {}, .is_tpdo = is_tpdo, .types = {}, .answers = {}};
    take_range(reader, "numbers", rule.numbers, {1, 512});
    if (const YamlNode* types = reader.take("transmission")) read_types(*types, rule.types);
    if (const YamlNode* types = reader.take("answers_rpdo")) read_types(*types, rule.answers);
    Sourced<bool> without_timer;
    reader.boolean("without_timer", without_timer);
    rule.without_timer = *without_timer;
    Sourced<bool> without_rtr;
    reader.boolean("without_rtr", without_rtr);
    rule.without_rtr = *without_rtr;
    Sourced<bool> no_more_entries;
    reader.boolean("no_more_entries", no_more_entries);
    rule.no_more_entries = *no_more_entries;
    Sourced<bool> no_gaps;
    reader.boolean("no_gaps", no_gaps);
    rule.no_gaps = *no_gaps;
    if (const YamlNode* function = reader.take("function")) {
      constexpr std::array<std::string_view, 2> names{"process_data", "parameter_channel"};
      if (const auto choice = read_choice(*function, "function", names, report_)) {
        rule.function = static_cast<PdoFunction>(*choice);
      }
    }
    rule.fact = fact(reader, item.pos);
    reader.finish();
    data_.pdos.push_back(std::move(rule));
  }

  void read_types(const YamlNode& node, std::vector<NumberRange>& out) {
    if (node.kind != YamlNode::Kind::sequence || node.items.empty() || node.items.size() > 256) {
      report_.error(
          node.pos, "wrong-type",
          "transmission types have to be a list of numbers and ranges: [[1, 240], 254, 255]");
      return;
    }
    for (const YamlNode* item : node.items) {
      if (const auto types = range(*item, "transmission", {0, 255})) out.push_back(*types);
    }
  }

  void inhibit(MapReader& reader) {
    Sourced<std::uint32_t> unit, least, factory;
    reader.integer("unit_us", unit, {1, 1'000'000, " us"});
    reader.integer("least", least, {0, 65535});
    reader.integer("default", factory, {0, 65535});
    data_.inhibit = {.fact = fact(reader, reader.key_pos("unit_us")),
                     .unit_us = unit.value_or(100),
                     .least = *least,
                     .factory = *factory};
  }

  void timer(MapReader& reader) {
    if (const YamlNode* meaning = reader.take("meaning")) {
      constexpr std::array<std::string_view, 3> names{"restarts", "additional", "alone"};
      if (const auto choice = read_choice(*meaning, "meaning", names, report_)) {
        data_.timer.meaning = static_cast<TimerMeaning>(*choice);
      }
    }
    data_.timer.fact = fact(reader, reader.key_pos("meaning"));
  }

  void sync(MapReader& reader) {
    data_.sync.own_tpdos_from = firmware(reader, "own_tpdos_from");
    Sourced<std::uint16_t> tx_identifier;
    reader.integer("tx_identifier", tx_identifier, {0x1000, 0xFFFF});
    data_.sync.tx_identifier = *tx_identifier;
    data_.sync.fact = fact(reader, reader.key_pos("own_tpdos_from"));
  }

  void object(const YamlNode& item) {
    MapReader reader{item, "`objects`", report_};
    ObjectEdit edit{.fact = {}, .object = {}, .access = {}, .from = {}, .below = {}};
    Sourced<std::uint16_t> index;
    Sourced<std::uint8_t> sub;
    Sourced<bool> missing;
    reader.integer("index", index, {0x1000, 0xFFFF});
    reader.integer("sub_index", sub);
    reader.boolean("missing", missing);
    if (const YamlNode* access = reader.take("access")) {
      constexpr std::array<std::string_view, 6> names{"ro", "wo", "rw", "rwr", "rww", "const"};
      if (const auto choice = read_choice(*access, "access", names, report_)) {
        edit.access = static_cast<Access>(*choice);
      }
    }
    edit.from = firmware(reader, "firmware_from");
    edit.below = firmware(reader, "firmware_below");
    edit.fact = fact(reader, item.pos);
    reader.finish();
    edit.object = {*index, *sub};
    edit.whole = !sub.given;
    if (!index.given || *missing == edit.access.has_value()) {
      report_.error(
          item.pos, "missing-key",
          "an entry of `objects` needs an `index`, and either `missing: true` or `access`");
      return;
    }
    data_.objects.push_back(std::move(edit));
  }

  void sdo_server(const YamlNode& item) {
    MapReader reader{item, "`sdo_servers`", report_};
    for (const std::string_view key : {"index", "request", "answer"}) need(reader, key);
    Sourced<std::uint16_t> index, request, answer;
    reader.integer("index", index, {0x1201, 0x127F});
    reader.integer("request", request, {0x180, 0x77F});
    reader.integer("answer", answer, {0x180, 0x77F});
    data_.sdo_servers.push_back(
        {.fact = fact(reader, item.pos), .index = *index, .request = *request, .answer = *answer});
    reader.finish();
  }

  void boot(MapReader& reader) {
    BootTweaks& boot = data_.boot;
    if (const YamlNode* reset = reader.take("reset")) {
      constexpr std::array<std::string_view, 3> names{"communication", "node", "none"};
      if (const auto choice = read_choice(*reset, "reset", names, report_)) {
        boot.reset = static_cast<ResetPolicy>(*choice);
      }
    }
    Sourced<bool> later;
    Sourced<std::uint32_t> after_bootup, before_start;
    reader.boolean("values_after_pdos", later);
    reader.integer("pause_after_bootup_ms", after_bootup, {0, 60'000, " ms"});
    reader.integer("pause_before_start_ms", before_start, {0, 60'000, " ms"});
    boot.values_after_pdos = *later;
    boot.pause_after_bootup_ms = *after_bootup;
    boot.pause_before_start_ms = *before_start;
    boot.fact = fact(reader, root_.pos);
  }

  void emcy(MapReader& reader) {
    const YamlNode* node = reader.take("emcy");
    if (node == nullptr) return;
    if (node->kind != YamlNode::Kind::map || node->pairs.size() > max_items) {
      report_.error(node->pos, "wrong-type", "`emcy` has to be a map of error codes to texts");
      return;
    }
    for (const YamlPair& pair : node->pairs) {
      YamlNode code;
      code.kind = YamlNode::Kind::scalar;
      code.text = pair.key;
      code.pos = pair.key_pos;
      const auto number = read_integer(code, "emcy", {1, 0xFFFF}, report_);
      auto meaning = read_text(*pair.value, "emcy", report_);
      if (number && meaning) {
        data_.emcy.push_back({static_cast<std::uint16_t>(*number), std::move(*meaning)});
      }
    }
  }

  const YamlNode& root_;
  DeviceData& data_;
  NetworkReport& report_;
};

}  // namespace

std::optional<DeviceData> read_device_data(std::string_view text, const std::string& file,
                                           Findings& findings) {
  Findings own;
  const YamlTree tree = YamlTree::parse(text, file, own);
  DeviceData data;
  data.file = file;
  data.id = std::filesystem::path{file}.stem().string();
  if (tree.root() != nullptr) {
    NetworkReport report{file, own};
    DeviceReader{*tree.root(), data, report}.run();
  }
  const bool usable = tree.root() != nullptr && !has_error(own);
  findings.insert(findings.end(), own.begin(), own.end());
  if (!usable) return {};
  return data;
}

}  // namespace takt
