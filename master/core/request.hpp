#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Largest SDO value that a request or reply carries, in bytes.
inline constexpr std::size_t request_bytes = 1024;

enum class RequestKind : std::uint8_t {
  sdo_upload,
  sdo_download,
  nmt,
  pdo_poll,      ///< remote request for TPDO `object.index` (1..512); the reply has its bytes
  pdo_exchange,  ///< RPDO `object.index` with `data`; the reply has the bytes of the TPDO that
                 ///< answers
  lss,           ///< LssCommands in `data`, packed; the reply has the LssResults
};

/// A value that is too long for a request. The front thread fills it or gives it its length, hands
/// it over with a request and has it back with the reply; only `done` and `cancel` are shared.
struct SdoTransfer {
  std::vector<std::byte> data;
  std::atomic<std::uint32_t> done{0};       ///< bytes that are through; at the end all of them
  std::atomic<std::uint32_t> announced{0};  ///< of an upload, by the device; 0: it does not say
  std::atomic<bool> cancel{false};          ///< asks for an early end; it is aborted on the bus
};

/// A service asked of the bus thread by the front thread. Trivially copyable.
struct Request {
  std::uint64_t id = 0;  ///< repeated by the reply
  RequestKind kind = RequestKind::sdo_upload;
  std::uint8_t node = 0;  ///< NMT: 0 = all nodes
  ObjectKey object{};
  NmtCommand command = NmtCommand::start;
  Time timeout{};                   ///< of the SDO transfer; 0 = the node's own
  SdoTransfer* transfer = nullptr;  ///< instead of `data`; outlives the reply
  std::uint16_t size = 0;
  std::array<std::byte, request_bytes> data{};
};
static_assert(std::is_trivially_copyable_v<Request>);

/// Every request is answered exactly once.
struct Reply {
  std::uint64_t id = 0;
  SdoFault fault = SdoFault::none;
  std::uint32_t abort_code = 0;
  std::uint16_t size = 0;
  std::array<std::byte, request_bytes> data{};
};
static_assert(std::is_trivially_copyable_v<Reply>);

}  // namespace takt
