#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/service/transmitter.hpp"

namespace takt::sim {

/// Bits of the error register 0x1001. CiA 301, 7.5.2.2.
enum class ErrorBit : std::uint8_t {
  generic = 0x01,
  current = 0x02,
  voltage = 0x04,
  temperature = 0x08,
  communication = 0x10,
  profile = 0x20,
  manufacturer = 0x80,
};

/// Reports the start and the end of errors: sends EMCY frames with the inhibit time 0x1015, and
/// keeps the error register 0x1001 and the history 0x1003. CiA 301, 7.2.7.
class EmcyProducer {
 public:
  using Detail = std::array<std::uint8_t, 5>;

  EmcyProducer(ObjectStore& store, NodeId node);
  /// Sets the node-ID that LSS has given to the device.
  void set_node(NodeId node) noexcept { node_ = node; }

  void reset() noexcept;
  /// Reports an error once, and again only after clear(). The first byte of the detail
  /// distinguishes errors with the same code, for example by the number of the PDO or of the silent
  /// node. At most 16 errors can be active; further ones are dropped.
  void raise(std::uint16_t code, ErrorBit bit, Detail detail = {}) noexcept;
  void clear(std::uint16_t code, std::uint8_t source = 0) noexcept {
    if (active_count_ != 0) clear_active(code, source);
  }
  /// Sends an EMCY and enters the error in the history, but not in the list of active errors.
  void announce(std::uint16_t code, Detail detail = {}) noexcept;
  /// Returns true if no error is active, and no message waits.
  bool quiet() const noexcept { return active_count_ == 0 && waiting_ == 0; }
  bool is_active(std::uint16_t code, std::uint8_t source = 0) const noexcept;

  /// Sends the waiting messages as far as the inhibit time allows.
  void on_time(Time now, bool may_send, Transmitter& out) noexcept {
    if (may_send && waiting_ != 0 && now >= allowed_from_) send_waiting(now, out);
  }
  Time deadline() const noexcept { return waiting_ == 0 ? never : allowed_from_; }

  Abort check_read(ObjectKey key) const noexcept;
  Abort check_write(const Object& object, std::uint64_t raw) const noexcept;
  void written(const Object& object) noexcept;

 private:
  struct Error {
    std::uint16_t code = 0;
    std::uint8_t source = 0;
    std::uint8_t bits = 0;
  };
  struct Message {
    std::uint16_t code = 0;
    std::uint8_t error_register = 0;
    Detail detail{};
  };

  void send_waiting(Time now, Transmitter& out) noexcept;
  void clear_active(std::uint16_t code, std::uint8_t source) noexcept;
  void push(std::uint16_t code, Detail detail) noexcept;
  void remember(std::uint16_t code) noexcept;
  std::uint8_t error_register() const noexcept;
  Frame encode(const Message& message) const noexcept;

  ObjectStore& store_;
  NodeId node_;
  Object* register_;
  Object* cob_;
  Object* inhibit_;
  std::array<Error, 16> active_{};
  std::size_t active_count_ = 0;
  std::array<Message, 16> queue_{};
  std::size_t waiting_ = 0;
  Time allowed_from_{};
};

}  // namespace takt::sim
