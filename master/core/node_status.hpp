#pragma once
#include <cstdint>
#include <type_traits>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/wire/nmt.hpp"

namespace takt {

/// Where a node stands in its boot. Every node is always in one of these.
enum class BootState : std::uint8_t {
  idle,     ///< nothing asked of it (watched only, or observe mode)
  booting,  ///< its plan is running
  ready,    ///< its plan has succeeded; its PDOs are exchanged
  failed,   ///< its plan has failed; tried again after a pause or with the next boot-up message
  lost,     ///< it was ready and has fallen silent, or out of OPERATIONAL; booted again
};

/// What is known of one node. Trivially copyable: it crosses threads.
struct NodeStatus {
  NmtState nmt = NmtState::unknown;
  BootState boot = BootState::idle;
  bool boot_tried = false;      ///< a boot has ended, well or not, since the network began
  char boot_letter = 0;         ///< status of CiA 302-2 of the newest boot: A..O, 0 = good
  std::uint16_t boot_step = 0;  ///< of the plan, counted from 0
  std::uint8_t error_register = 0;
  std::uint16_t last_emcy = 0;  ///< error code of the newest EMCY
  std::uint32_t emcy_count = 0;
  std::uint32_t boot_count = 0;      ///< boots that ended well
  std::uint32_t heartbeat_lost = 0;  ///< times
  std::uint32_t sdo_aborts = 0;
  Time last_heartbeat{};  ///< 0: never

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(nmt, boot, boot_tried, boot_letter, boot_step, error_register, last_emcy, emcy_count,
          boot_count, heartbeat_lost, sdo_aborts, last_heartbeat);
  }
};
static_assert(std::is_trivially_copyable_v<NodeStatus>);

}  // namespace takt
