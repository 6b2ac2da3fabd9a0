#include "master/gateway/notice/emcy_log.hpp"

#include <algorithm>

#include "eds_parser/values/number_in.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

constexpr std::size_t record_bytes = 16;

}  // namespace

void EmcyLog::take(const Event& event, std::int64_t utime) {
  if (event.kind != EventKind::emcy || event.detail == 1) return;
  auto& [records, codes] = nodes_[event.node];
  if (records.size() == depth) records.erase(records.begin());
  records.push_back({.utime = utime, .bytes = event.bytes});
  if (records.back().code() == 0) return;
  codes.push_front(records.back().code());
  if (codes.size() > most_codes) codes.pop_back();
}

const EmcyLog::NodeLog& EmcyLog::node_log(std::uint8_t node) const {
  static const NodeLog none;
  const auto found = nodes_.find(node);
  return found == nodes_.end() ? none : found->second;
}

std::vector<std::uint8_t> pack(std::span<const EmcyRecord> records) {
  std::vector<std::uint8_t> bytes(records.size() * record_bytes);
  std::span<std::uint8_t> left{bytes};
  for (const EmcyRecord& record : records) {
    store_le(left, static_cast<std::uint64_t>(record.utime));
    std::ranges::copy(record.bytes, left.begin() + 8);
    left = left.subspan(record_bytes);
  }
  return bytes;
}

std::vector<EmcyRecord> unpack_emcys(std::span<const std::uint8_t> bytes) {
  std::vector<EmcyRecord> records;
  for (; bytes.size() >= record_bytes; bytes = bytes.subspan(record_bytes)) {
    EmcyRecord record{.utime = static_cast<std::int64_t>(load_le<std::uint64_t>(bytes))};
    std::ranges::copy(bytes.subspan(8, 8), record.bytes.begin());
    records.push_back(record);
  }
  return records;
}

std::string pack_texts(std::span<const EmcyRecord> records, std::span<const EmcyText> texts) {
  std::string lines;
  for (const EmcyText& text : texts) {
    if (std::ranges::find(records, text.code, &EmcyRecord::code) == records.end()) continue;
    lines += hex(text.code) + ' ' + text.text + '\n';
  }
  return lines;
}

std::map<std::uint16_t, std::string> unpack_texts(std::string_view lines) {
  constexpr std::size_t digits = 4;
  constexpr std::size_t code_width = digits + 3;  // "0x1000 "
  std::map<std::uint16_t, std::string> texts;
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    lines.remove_prefix(std::min(lines.size(), line.size() + 1));
    if (line.size() <= code_width || !line.starts_with("0x")) continue;
    const auto code = number_in<std::uint16_t>(line.substr(2, digits), 16);
    if (code) texts[*code] = line.substr(code_width);
  }
  return texts;
}

}  // namespace takt
