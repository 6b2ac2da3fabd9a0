#include "master/linux/can/can_error_frame.hpp"

#include <linux/can/error.h>

namespace takt {
namespace {

static_assert(state_error_classes ==
              (CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_TX_TIMEOUT));

constexpr unsigned passive_bits = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
constexpr unsigned state_bits =
    passive_bits | CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING | CAN_ERR_CRTL_ACTIVE;

}  // namespace

void apply_error_frame(const can_frame& frame, PortCondition& condition) noexcept {
  ++condition.error_frames;
  if ((frame.can_id & CAN_ERR_CRTL) != 0) {
    const unsigned what = frame.data[1];
    if ((what & state_bits) != 0) condition.error_passive = (what & passive_bits) != 0;
    if ((what & CAN_ERR_CRTL_RX_OVERFLOW) != 0) ++condition.receive_overruns;
    if ((what & state_bits) != 0) condition.bus_off = false;
  }
  // Drivers fill in the counters when the state changes; newer drivers announce them by
  // CAN_ERR_CNT.
  if ((frame.can_id & (CAN_ERR_CRTL | CAN_ERR_CNT)) != 0) {
    condition.tx_error_counter = frame.data[6];
    condition.rx_error_counter = frame.data[7];
  }
  if ((frame.can_id & CAN_ERR_BUSOFF) != 0) {
    condition.bus_off = true;
    condition.tx_error_counter = 255;
  }
  if ((frame.can_id & CAN_ERR_RESTARTED) != 0) {
    condition.bus_off = false;
    condition.error_passive = false;
    condition.tx_error_counter = 0;
    condition.rx_error_counter = 0;
  }
}

}  // namespace takt
