#pragma once
#include <cstdint>
#include <type_traits>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/wire/nmt.hpp"

namespace takt {

/// Boot state of a node. A node is always in exactly one of these states.
enum class BootState : std::uint8_t {
  idle,  ///< The master does not boot the node (it is only watched, or the master only observes).
  booting,  ///< The boot plan is running.
  ready,    ///< The boot plan has succeeded; PDOs are exchanged.
  failed,   ///< The boot plan has failed. It runs again after a pause or with the next boot-up
            ///< message.
  lost,  ///< The node was ready and has become silent or has left OPERATIONAL. It is booted again.
};

/// Status of one node. It is trivially copyable because it is passed between threads.
struct NodeStatus {
  NmtState nmt = NmtState::unknown;
  BootState boot = BootState::idle;
  bool boot_tried = false;  ///< a boot has succeeded or failed since the network began
  /// Error status of CiA 302-2 of the newest boot: 'A'..'O', 0 means success.
  char boot_letter = 0;
  std::uint16_t boot_step = 0;  ///< step of the boot plan, counted from 0
  std::uint8_t error_register = 0;
  bool exchanging = false;      ///< the node exchanges PDOs, see NodeSession::exchanges_pdos()
  std::uint16_t last_emcy = 0;  ///< error code of the newest EMCY
  std::uint32_t emcy_count = 0;
  std::uint32_t boot_count = 0;      ///< number of successful boots
  std::uint32_t heartbeat_lost = 0;  ///< number of losses
  std::uint32_t bootups = 0;         ///< number of boot-up messages
  /// Number of requests and boots that the device has ended with an SDO abort.
  std::uint32_t sdo_aborts = 0;
  Time last_heartbeat{};  ///< monotonic clock; 0 means never

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(nmt, boot, boot_tried, boot_letter, boot_step, error_register, last_emcy, emcy_count,
          boot_count, heartbeat_lost, bootups, sdo_aborts, last_heartbeat);
  }
};
static_assert(std::is_trivially_copyable_v<NodeStatus>);

}  // namespace takt
