#include "apps/takt/spy/message_types.hpp"

#include <takt/envelope_t.hpp>
#include <utility>

#include "master/lcm/messages.hpp"

namespace takt::spy {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Reads a line such as `int64_t values[num_values];  // raw`.
bool parse_member(std::string_view line, Member& member) {
  const std::size_t end = line.find(';');
  if (end == line.npos) return false;
  const std::size_t comment = line.find("//", end);
  if (comment != line.npos) member.comment = trimmed(line.substr(comment + 2));
  std::string_view text = trimmed(line.substr(0, end));
  const std::size_t blank = text.find_first_of(" \t");
  if (blank == text.npos) return false;
  member.type = text.substr(0, blank);
  text = trimmed(text.substr(blank));
  std::size_t bracket = text.find('[');
  member.name = trimmed(text.substr(0, bracket));
  while (bracket != text.npos) {
    const std::size_t closed = text.find(']', bracket);
    if (closed == text.npos) return false;
    member.dimensions.emplace_back(trimmed(text.substr(bracket + 1, closed - bracket - 1)));
    bracket = text.find('[', closed);
  }
  return !member.name.empty();
}

struct Fingerprint {
  std::uint64_t number;
  const char* type;
};

template <class... Types>
std::string_view name_of(std::uint64_t fingerprint) {
  const Fingerprint all[]{{static_cast<std::uint64_t>(Types::getHash()), Types::getTypeName()}...};
  for (const Fingerprint& one : all) {
    if (one.number == fingerprint) return one.type;
  }
  return {};
}

}  // namespace

MessageTypes parse_types(std::string_view text) {
  MessageTypes types;
  std::vector<Member>* members = nullptr;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text = end == text.npos ? std::string_view{} : text.substr(end + 1);
    if (line.starts_with("struct ")) {
      members = &types[std::string{trimmed(line.substr(7))}];
    } else if (line.starts_with('}')) {
      members = nullptr;
    } else if (members != nullptr && !line.starts_with("//")) {
      Member member;
      if (parse_member(line, member)) members->push_back(std::move(member));
    }
  }
  return types;
}

const MessageTypes& own_types() {
  static const MessageTypes types = parse_types(own_definitions);
  return types;
}

std::string_view own_type(std::uint64_t fingerprint) {
  return name_of<command_t, envelope_t, event_t, image_t, layout_t, motion_command_t, motion_gear_t,
                 motion_stream_t, motion_t, pdo_status_t, reply_t, request_t, speed_axes_t,
                 status_t, sync_status_t, timing_t, transfer_state_t, transfer_t>(fingerprint);
}

}  // namespace takt::spy
