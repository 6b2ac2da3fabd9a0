#include "eds_parser/values/little_endian.hpp"
#include "master/sim/device/device.hpp"
#include "master/sim/dictionary/cob_rules.hpp"

namespace takt::sim {
namespace {

constexpr bool between(std::uint16_t index, std::uint16_t first, std::uint16_t last) noexcept {
  return index >= first && index <= last;
}

}  // namespace

bool Device::is_mute(ObjectKey key) const noexcept { return faults_.is_mute(key); }

Abort Device::width(ObjectKey key, std::size_t& bytes) const noexcept {
  const Object* object = store_.find(key);
  if (object == nullptr) return store_.may_read(key);
  bytes = object->width;
  if (const Abort refused = faults_.on_write(key); refused != Abort::none) return refused;
  return object->writable() ? Abort::none : Abort::read_only;
}

Abort Device::read(ObjectKey key, Time now, std::span<const std::byte>& data) noexcept {
  if (const Abort refused = faults_.on_read(key); refused != Abort::none) return refused;
  Abort refused = store_.may_read(key);
  if (refused == Abort::none) refused = emcy_.check_read(key);
  if (refused != Abort::none) return refused;
  model_->advance(now);
  const Object& object = *store_.find(key);
  if (object.is_bytes()) {
    data = object.bytes;
    return Abort::none;
  }
  for (std::size_t i = 0; i < scratch_.size(); ++i)
    scratch_[i] = std::byte(object.value >> (8 * i));
  data = std::span{scratch_}.first(object.width);
  return Abort::none;
}

Abort Device::write(ObjectKey key, Time now, std::span<const std::byte> data) noexcept {
  if (const Abort refused = faults_.on_write(key); refused != Abort::none) return refused;
  const Abort refused = store_.may_write(key, data);
  if (refused != Abort::none) return refused;
  const bool late = state_ != DeviceState::preoperational && key.index < 0x2000;
  if (faults_.preop_only && late) return Abort::device_state;
  if (faults_.ignores_write(key)) return Abort::none;
  Object& object = *store_.find(key);
  if (object.is_bytes()) {
    const bool program = ProgramMemory::is_data(key);
    if (const Abort unfit = program ? program_.check_data() : Abort::none; unfit != Abort::none) {
      return unfit;
    }
    object.bytes.assign(data.begin(), data.end());
    if (program) program_.data_written(now);
    return Abort::none;
  }
  const std::uint64_t raw = from_little_endian(data);
  if (ParameterStorage::owns(key)) return storage_.execute(key, raw);
  model_->advance(now);
  const Abort unfit = check_write(object, raw);
  if (unfit != Abort::none) return unfit;
  const std::uint64_t before = object.value;
  object.set(raw);
  if (object.value != before) forget_configuration_date(object);
  written(object, now);
  return Abort::none;
}

Abort Device::check_write(const Object& object, std::uint64_t raw) const noexcept {
  const std::uint16_t index = object.key.index;
  if (index >= 0x2000) return model_->check_write(object, raw);
  const Abort unfit = model_->check_communication(object, raw);
  if (unfit != Abort::none) return unfit;
  if (between(index, 0x1600, 0x17FF) || between(index, 0x1A00, 0x1BFF)) {
    if (faults_.fixed_mapping) return Abort::read_only;
  }
  if (between(index, 0x1201, 0x127F)) return check_sdo_server(object, raw);
  for (const Rpdo& rpdo : rpdos_) {
    if (!rpdo.record().owns(object.key)) continue;
    return rpdo.record().check_write({PdoDirection::receive, dummy_usage_}, object, raw);
  }
  for (const Tpdo& tpdo : tpdos_) {
    if (!tpdo.record().owns(object.key)) continue;
    return tpdo.record().check_write({PdoDirection::transmit, dummy_usage_}, object, raw);
  }
  for (const Abort refused : {program_.check_control(object, raw), emcy_.check_write(object, raw),
                              watch_.check_write(object, raw), sync_.check_write(object, raw),
                              time_.check_write(object, raw)}) {
    if (refused != Abort::none) return refused;
  }
  return Abort::none;
}

/// The identifiers of an enabled server can't be changed. CiA 301, 7.5.2.33.
Abort Device::check_sdo_server(const Object& object, std::uint64_t raw) const noexcept {
  if (object.key.sub != 1 && object.key.sub != 2) return Abort::none;
  if (has_stray_bits(raw)) return Abort::value;
  const auto on = [this, &object](std::uint8_t sub) {
    return (store_.number({object.key.index, sub}, cob_invalid) & cob_invalid) == 0;
  };
  const bool stays_on = on(1) && on(2) && (raw & cob_invalid) == 0;
  return stays_on && raw != object.value ? Abort::value : Abort::none;
}

/// A change of the configuration sets its date and time to zero. CiA 301, 7.5.2.23.
void Device::forget_configuration_date(const Object& changed) noexcept {
  const std::uint16_t index = changed.key.index;
  const bool exempt = index == 0x1003 || index == 0x1020 || between(index, 0x1F50, 0x1F57);
  if (exempt || (index >= 0x2000 && changed.mappable)) return;
  for (const std::uint8_t sub : {std::uint8_t{1}, std::uint8_t{2}}) {
    if (Object* date = store_.find({0x1020, sub})) date->set(0);
  }
}

void Device::written(const Object& object, Time now) noexcept {
  const std::uint16_t index = object.key.index;
  if (index >= 0x2000) {
    model_->outputs(now);
    look_at_inputs(now);
    return;
  }
  if (index == 0x1017) heartbeat_.start(now);
  if (index == 0x1016) watch_.configure();
  if (index == 0x100C || index == 0x100D) guarding_.configure(now);
  program_.control_written(object, now);
  if (index == 0x1003) emcy_.written(object);
  if (index == 0x1006) sync_.reset();
  if (index == 0x1005 || index == 0x1006 || index == 0x1019) sync_producer_.start(now);
  if (between(index, 0x1400, 0x1BFF)) pdo_written(object.key, now);
  const bool listens = index == 0x1005 || index == 0x1012 || index == 0x1016;
  if (listens || index >= 0x1200) build_routes();
  model_->communication_written(object);
}

void Device::pdo_written(ObjectKey key, Time now) noexcept {
  for (Rpdo& rpdo : rpdos_) {
    if (rpdo.record().owns(key)) rpdo.reconfigure();
  }
  for (Tpdo& tpdo : tpdos_) {
    if (tpdo.record().owns(key)) tpdo.reconfigure(now);
  }
  if (state_ == DeviceState::operational) list_pdos();
}

}  // namespace takt::sim
