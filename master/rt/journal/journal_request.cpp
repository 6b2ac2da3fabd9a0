#include "master/rt/journal/journal_request.hpp"

#include <cstring>

namespace takt {
namespace {

constexpr std::size_t head_words = 4;
constexpr std::size_t most_transfer_bytes = 16 << 20;
constexpr std::size_t most_kept_bytes = 64 << 10;  // limit of the copy within one cycle

std::size_t words_for(std::size_t bytes) noexcept { return (bytes + 7) / 8; }

/// Returns the number of the transfer, from 1; 0 if there is none.
std::size_t number_of(const SdoTransfer* transfer, const SdoTransfers& transfers) noexcept {
  for (std::size_t i = 0; i < transfers.size(); ++i) {
    if (transfer == &transfers[i]) return i + 1;
  }
  return 0;
}

}  // namespace

void put_request(Journal& journal, const Request& request, const SdoTransfers& transfers) noexcept {
  const std::size_t number = number_of(request.transfer, transfers);
  const std::size_t length = number == 0 ? 0 : request.transfer->data.size();
  const bool download = request.kind == RequestKind::sdo_download;
  const std::size_t kept = number == 0 ? request.size : download ? length : 0;
  if (kept > most_kept_bytes) return journal.put(Mark::gap, std::uint64_t{0});
  const std::size_t count = head_words + words_for(kept);
  std::uint64_t* const room = journal.claim(Mark::request, count, count);
  if (room == nullptr) return;
  room[0] = request.id;
  room[1] =
      std::uint64_t{static_cast<std::uint8_t>(request.kind)} | std::uint64_t{request.node} << 8 |
      std::uint64_t{request.object.index} << 16 | std::uint64_t{request.object.sub} << 32 |
      std::uint64_t{static_cast<std::uint8_t>(request.command)} << 40 | std::uint64_t{number} << 48;
  room[2] = static_cast<std::uint64_t>(request.timeout.count());
  room[3] = std::uint64_t{request.size} | std::uint64_t{length} << 16;
  if (kept == 0) return;
  room[count - 1] = 0;
  const void* const from = number == 0 ? request.data.data() : request.transfer->data.data();
  std::memcpy(static_cast<void*>(room + head_words), from, kept);
}

bool get_request(std::span<const std::uint64_t> words, Request& request, SdoTransfers& transfers) {
  if (words.size() < head_words) return false;
  const auto byte = [&](unsigned shift) { return static_cast<std::uint8_t>(words[1] >> shift); };
  request = {};
  request.id = words[0];
  request.kind = static_cast<RequestKind>(byte(0));
  request.node = byte(8);
  request.object = {static_cast<std::uint16_t>(words[1] >> 16), byte(32)};
  request.command = static_cast<NmtCommand>(byte(40));
  request.timeout = Time{static_cast<std::int64_t>(words[2])};
  request.size = static_cast<std::uint16_t>(words[3]);
  const std::size_t number = byte(48);
  const std::size_t length = words[3] >> 16;
  const bool download = request.kind == RequestKind::sdo_download;
  if (request.kind > RequestKind::lss || number > transfers.size() ||
      length > most_transfer_bytes || request.size > request_bytes) {
    return false;
  }
  const std::size_t kept = number == 0 ? request.size : download ? length : 0;
  if (words.size() != head_words + words_for(kept)) return false;
  void* to = request.data.data();
  if (number != 0) {
    request.transfer = &transfers[number - 1];
    request.transfer->data.assign(length, std::byte{});
    to = request.transfer->data.data();
  }
  if (kept != 0) std::memcpy(to, words.data() + head_words, kept);
  return true;
}

}  // namespace takt
