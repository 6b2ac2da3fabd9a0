#include "eds_parser/plan/sdo_servers.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/specification/device_data.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

constexpr std::uint32_t extended_flag = 0x2000'0000;
constexpr std::uint16_t first_further = 0x1201;
constexpr std::uint16_t last_further = 0x127F;

bool is_relative(const SubObject& sub) {
  constexpr std::string_view formula = "$nodeid";
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  return !std::ranges::search(sub.default_text, formula, same).empty();
}

bool is_configured(const ObjectDictionary& dictionary, const SubObject& sub) {
  return dictionary.is_dcf && sub.parameter_value;
}

/// Returns the number that the file states, even if it is the COB-ID of another node. Returns
/// std::nullopt if there is no such entry or its value is no number.
std::optional<std::int64_t> number_of_file(const ObjectDictionary& dictionary, ObjectKey key) {
  const SubObject* sub = dictionary.find(key);
  if (sub == nullptr) return std::nullopt;
  return integer_of(is_configured(dictionary, *sub) ? sub->parameter_value : sub->default_value);
}

/// Converts the value of a COB-ID entry. Returns std::nullopt if the entry is switched off (bit
/// 31).
std::optional<CobId> cob_id_of(std::int64_t value) {
  const auto raw = static_cast<std::uint32_t>(value);
  if (value <= 0 || (raw & cob_id_off) != 0) return std::nullopt;
  const CobId id = CobId::of_object(raw);
  return id.id() == 0 ? std::nullopt : std::optional{id};
}

class SdoServers {
 public:
  explicit SdoServers(const NodeSource& node) : node_{node} {}

  std::vector<DeviceSdoServer> active() const {
    std::vector<DeviceSdoServer> servers;
    for (std::uint16_t index = first_further; index <= last_further; ++index) {
      if (const auto server = at(index)) servers.push_back(*server);
    }
    return servers;
  }

 private:
  std::optional<DeviceSdoServer> at(std::uint16_t index) const {
    const SdoSpec* own_request = written({index, 1});
    const SdoSpec* own_answer = written({index, 2});
    const auto request = cob_id({index, 1}, own_request);
    const auto answer = cob_id({index, 2}, own_answer);
    const bool configured = own_request != nullptr || own_answer != nullptr;
    if (!request || !answer) return configured ? std::nullopt : of_factory(index);
    const SdoSpec* own = own_request != nullptr ? own_request : own_answer;
    return DeviceSdoServer{.index = index,
                           .channel = {.request = *request, .answer = *answer},
                           .pos = own != nullptr ? own->pos : node_.spec->pos};
  }

  /// Returns the server that is on when the device is delivered, according to its device data.
  /// Returns std::nullopt if a DCF states the configuration of this server.
  std::optional<DeviceSdoServer> of_factory(std::uint16_t index) const {
    const SubObject* sub = node_.dictionary->find(ObjectKey{index, 1});
    const bool left_off = sub != nullptr && is_configured(*node_.dictionary, *sub);
    if (node_.data == nullptr || left_off) return std::nullopt;
    const auto& facts = node_.data->sdo_servers;
    const auto found = std::ranges::find(facts, index, &SdoServerFact::index);
    if (found == facts.end()) return std::nullopt;
    const auto id = [this](std::uint32_t base) { return CobId::base(base + node_.id.value()); };
    return DeviceSdoServer{.index = index,
                           .channel = {.request = id(found->request), .answer = id(found->answer)},
                           .pos = node_.spec->pos,
                           .doubt = node_.data->cite(found->fact)};
  }

  /// Returns the last write of the object. Entries of `configuration_file` come before those of
  /// `sdo`.
  const SdoSpec* written(ObjectKey key) const {
    const auto& list = node_.spec->sdo;
    const auto last = std::ranges::find(list.rbegin(), list.rend(), key, &SdoSpec::object);
    return last == list.rend() ? nullptr : &*last;
  }

  std::optional<CobId> cob_id(ObjectKey key, const SdoSpec* own) const {
    if (own == nullptr) return cob_id_of(cob_id_of_file(*node_.dictionary, key));
    return cob_id_of(number_of(own->value));
  }

  /// Returns the value as a number. Values of a concise DCF are little-endian bytes.
  static std::int64_t number_of(const decltype(SdoSpec::value)& value) {
    if (const auto* number = std::get_if<std::int64_t>(&value)) return *number;
    const auto* bytes = std::get_if<std::vector<std::byte>>(&value);
    const bool is_cob_id = bytes != nullptr && bytes->size() == 4;
    return is_cob_id ? static_cast<std::int64_t>(from_little_endian(*bytes)) : 0;
  }

  const NodeSource& node_;
};

/// The further SDO servers of a device file, and whether one of them has the wanted channel.
class ServersOfFile {
 public:
  ServersOfFile(const ObjectDictionary& dictionary, const SdoChannel& wanted) {
    for (std::uint16_t index = first_further; index <= last_further; ++index) {
      if (dictionary.find(ObjectKey{index, 1}) == nullptr) continue;
      const auto request = number_of_file(dictionary, {index, 1}).value_or(0);
      const auto answer = number_of_file(dictionary, {index, 2}).value_or(0);
      has_ = has_ || (cob_id_of(request) == wanted.request && cob_id_of(answer) == wanted.answer);
      if (first_ == 0) first_ = index;
      list_ += (list_.empty() ? "" : ", ") + hex(index, 4) + ": " + state(request, answer);
    }
  }

  bool has_wanted() const noexcept { return has_; }
  /// Returns the index of the first server; 0 means that there is none.
  std::uint16_t first() const noexcept { return first_; }
  const std::string& list() const noexcept { return list_; }

 private:
  static std::string state(std::int64_t request, std::int64_t answer) {
    const auto from_client = cob_id_of(request);
    const auto from_server = cob_id_of(answer);
    if (!from_client || !from_server) return "off";
    return to_string(*from_client) + " and " + to_string(*from_server);
  }

  bool has_ = false;
  std::uint16_t first_ = 0;
  std::string list_;
};

}  // namespace

std::int64_t cob_id_of_file(const ObjectDictionary& dictionary, ObjectKey key) {
  const SubObject* sub = dictionary.find(key);
  if (sub == nullptr) return 0;
  const std::int64_t id = number_of_file(dictionary, key).value_or(0);
  const bool meant =
      is_configured(dictionary, *sub) || is_relative(*sub) || (id & extended_flag) != 0;
  return meant ? id : 0;
}

std::vector<DeviceSdoServer> active_sdo_servers(const NodeSource& node) {
  return SdoServers{node}.active();
}

void check_sdo_channel(const NodeSource& node, NetworkReport& report) {
  const Sourced<SdoChannel>& wanted = node.spec->sdo_channel;
  if (!wanted.given || *wanted == default_sdo_channel(node.id)) return;
  const ServersOfFile servers{*node.dictionary, *wanted};
  const auto of_device_data = [&](const DeviceSdoServer& server) {
    return !server.doubt.empty() && server.channel == *wanted;
  };
  if (servers.has_wanted()) return;
  if (std::ranges::any_of(active_sdo_servers(node), of_device_data)) return;
  const std::string request = to_string(wanted->request);
  const std::string start = "`sdo_channel` of node `" + node.spec->name + "`: ";
  const std::string& file = node.dictionary->file;
  if (servers.first() == 0) {
    report.warning(wanted.pos, "no-sdo-server", start, file,
                   " has no SDO server besides the first (no 0x1201 to 0x127F), so the device may "
                   "not answer on ",
                   request,
                   "; leave `sdo_channel` out, or name a device file that contains such a server");
    return;
  }
  const std::string object = hex(servers.first(), 4);
  report.warning(wanted.pos, "no-sdo-server", start, "no SDO server of ", file, " is on ", request,
                 " and ", wanted->answer, " (", servers.list(),
                 "); correct `sdo_channel`, or leave it out and switch the server on by `sdo` (",
                 object, ":01 and 02) and store it in the device (`store_configuration`)");
}

}  // namespace takt
