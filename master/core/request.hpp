#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Largest SDO value that a request or reply carries, in bytes.
inline constexpr std::size_t request_bytes = 1024;

/// The service that a request asks for.
enum class RequestKind : std::uint8_t {
  sdo_upload,
  sdo_download,
  nmt,
  pdo_poll,  ///< remote frame for TPDO `object.index` (1..512); the reply carries the bytes of the
             ///< TPDO
  pdo_exchange,  ///< sends RPDO `object.index` with `data`; the reply carries the bytes of the TPDO
                 ///< that answers
  lss,           ///< packed LssCommands in `data`; the reply carries the LssResults
};

/// A buffer for a value that is too long for a request. The front thread fills it (download) or
/// sets its length (upload), hands it over with a request and gets it back with the reply.
/// Meanwhile, the threads share only the atomic members.
struct SdoTransfer {
  std::vector<std::byte> data;
  /// Transferred bytes; at the end all bytes.
  std::atomic<std::uint32_t> done{0};
  /// Size of an upload that the device has announced; 0 means none.
  std::atomic<std::uint32_t> announced{0};
  /// Requests an early end; the transfer is then aborted on the bus.
  std::atomic<bool> cancel{false};
};

/// A service that the front thread requests from the bus thread. It is trivially copyable.
struct Request {
  std::uint64_t id = 0;  ///< chosen by the sender; the reply repeats it
  RequestKind kind = RequestKind::sdo_upload;
  std::uint8_t node = 0;  ///< node-ID; for NMT, 0 means all nodes
  ObjectKey object{};
  NmtCommand command = NmtCommand::start;
  Time timeout{};  ///< time-out of the SDO transfer; 0 means that of the node
  /// Used instead of `data` if not nullptr; it must live until the reply was taken.
  SdoTransfer* transfer = nullptr;
  /// Bytes of `data` that are used.
  std::uint16_t size = 0;
  std::array<std::byte, request_bytes> data{};
};
static_assert(std::is_trivially_copyable_v<Request>);

/// The frames that the SDO server of a node has sent although it did not answer a request in time.
struct SdoSilence {
  Time
      late{};  ///< longest time until the answer to a request that had timed out; 0 means none came
  std::optional<ObjectKey> answered{};  ///< object of an answer that did not fit the request
};

/// The answer to a request. Every request is answered exactly once.
struct Reply {
  std::uint64_t id = 0;
  SdoFault fault = SdoFault::none;
  std::uint32_t abort_code = 0;
  SdoSilence silence{};  ///< SdoFault::timeout only
  /// Bytes of `data` that are used.
  std::uint16_t size = 0;
  std::array<std::byte, request_bytes> data{};
};
static_assert(std::is_trivially_copyable_v<Reply>);

}  // namespace takt
