#include "master/sim/device/device.hpp"

namespace takt::sim {

void Device::start_pdos(Time now) noexcept {
  model_->advance(now);
  for (Rpdo& rpdo : rpdos_) rpdo.start();
  for (Tpdo& tpdo : tpdos_) tpdo.start(now);
  list_pdos();
  run_tpdos(now);
  if (!faults_.mute_pdo) multiplexed_.notice(now, out_);
}

void Device::list_pdos() noexcept {
  multiplexed_.clear();
  for (const Tpdo& tpdo : tpdos_) multiplexed_.add(tpdo.record());
  list_live_pdos();
}

/// Lists the PDOs that are in use. Most devices have many more PDOs than they use, and each SYNC
/// visits the listed ones.
void Device::list_live_pdos() noexcept {
  live_tpdos_.clear();
  live_rpdos_.clear();
  for (Tpdo& tpdo : tpdos_) {
    if (tpdo.live()) live_tpdos_.push_back(&tpdo);
  }
  for (Rpdo& rpdo : rpdos_) {
    if (rpdo.live()) live_rpdos_.push_back(&rpdo);
  }
}

void Device::run_tpdos(Time now) noexcept {
  const std::size_t before = out_.pending().size();
  for (Tpdo* const tpdo : live_tpdos_) {
    if (now < tpdo->deadline()) continue;
    model_->advance(now);
    tpdo->on_time(now, out_);
  }
  if (faults_.mute_pdo) out_.shrink(before);
}

void Device::stop_pdos() noexcept {
  for (Rpdo& rpdo : rpdos_) rpdo.stop();
  for (Tpdo& tpdo : tpdos_) tpdo.stop();
  live_tpdos_.clear();
  live_rpdos_.clear();
  multiplexed_.clear();
}

/// Samples the inputs first, then applies the data received since the last SYNC.
void Device::on_sync(const Frame& frame, Time now) noexcept {
  const std::uint8_t counter = sync_.on_sync(frame, now);
  model_->advance(now);
  last_look_ = now;
  if (state_ != DeviceState::operational) return;
  if (!faults_.mute_pdo) {
    for (Tpdo* const tpdo : live_tpdos_) {
      tpdo->on_sync(counter, now + times_.pdo, sync_.window_end(), out_);
    }
  }
  bool fresh = false;
  for (Rpdo* const rpdo : live_rpdos_) {
    if (!rpdo->waits()) continue;
    rpdo->apply();
    model_->received(rpdo->record().number(), now);
    fresh = true;
  }
  if (fresh) model_->outputs(now);
  model_->on_sync(now);
  if (fresh) look_at_inputs(now);
}

/// An RPDO that only waits for SYNC changes no deadline and sends nothing.
bool Device::keep_until_sync(const Route& route, const Frame& frame, Time now) noexcept {
  if (route.kind != RouteKind::rpdo || frame.rtr || answers_rpdos_) return false;
  return state_ == DeviceState::operational &&
         rpdos_[route.index].keep_until_sync(frame, now, sync_.window_end(), emcy_);
}

void Device::on_rpdo(Rpdo& rpdo, const Frame& frame, Time now) noexcept {
  if (state_ != DeviceState::operational) return;
  const std::uint16_t number = rpdo.record().number();
  if (rpdo.record().multiplex() != Multiplex::none) {
    if (!multiplexed_.on_frame(rpdo.record(), frame, emcy_)) return;
    look_at_records();
    model_->advance(now);
    model_->outputs(now);
    return look_at_inputs(now);
  }
  if (frame.length < rpdo.length() && model_->takes_short(number)) return answer(number, now);
  if (rpdo.on_frame(frame, now, sync_.window_end(), emcy_)) {
    model_->advance(now);
    rpdo.apply();
    model_->received(number, now);
    model_->outputs(now);
    look_at_inputs(now);
    answer(number, now);
  } else if (rpdo.waits()) {
    answer(number, now);
  }
}

void Device::answer(std::uint16_t number, Time now) noexcept {
  if (faults_.mute_pdo) return;
  for (Tpdo& tpdo : tpdos_) {
    if (tpdo.record().number() == number) tpdo.answer(now + times_.pdo, out_);
  }
}

/// A CAN controller does not receive its own frames, so the model decides whether the device reacts
/// to its own SYNC.
void Device::make_sync(Time now) noexcept {
  const auto frame = sync_producer_.on_time(now, model_->sync_transmit_id());
  if (!frame) return;
  out_.send(*frame, now);
  if (model_->obeys_own_sync()) on_sync(*frame, now);
}

void Device::look_at_inputs(Time now) noexcept {
  model_->advance(now);
  last_look_ = now;
  if (state_ != DeviceState::operational || faults_.mute_pdo) return;
  for (Tpdo* const tpdo : live_tpdos_) tpdo->notice(now, out_);
  multiplexed_.notice(now, out_);
}

}  // namespace takt::sim
