#include "master/gateway/emcy_log.hpp"

#include <algorithm>

#include "master/wire/bytes.hpp"

namespace takt {
namespace {

constexpr std::size_t record_bytes = 16;

}  // namespace

void EmcyLog::take(const Event& event, std::int64_t utime) {
  if (event.kind != EventKind::emcy) return;
  std::vector<EmcyRecord>& records = records_[event.node];
  if (records.size() == depth) records.erase(records.begin());
  records.push_back({.utime = utime, .bytes = event.bytes});
}

const std::vector<EmcyRecord>& EmcyLog::of(std::uint8_t node) const {
  static const std::vector<EmcyRecord> none;
  const auto found = records_.find(node);
  return found == records_.end() ? none : found->second;
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

}  // namespace takt
