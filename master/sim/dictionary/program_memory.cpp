#include "master/sim/dictionary/program_memory.hpp"

#include "eds_parser/values/little_endian.hpp"

namespace takt::sim {
namespace {

constexpr Time clear_time = std::chrono::milliseconds{300};
constexpr Time write_time = std::chrono::milliseconds{200};
constexpr std::uint8_t flash_busy = 0x01;
constexpr std::uint8_t no_valid_program = 1u << 1;
constexpr std::size_t version_bytes = 4;

}  // namespace

bool ProgramMemory::has_program() const noexcept {
  if (!cleared_ && !loaded_) return true;  // factory program
  const Object* data = store_.find({0x1F50, 1});
  return loaded_ && data != nullptr && data->bytes.size() >= version_bytes;
}

Abort ProgramMemory::check_data() const noexcept {
  if (store_.number({0x1F51, 1}) != stop || !cleared_ || busy()) return Abort::device_state;
  return Abort::none;
}

Abort ProgramMemory::check_control(const Object& object, std::uint64_t raw) const noexcept {
  if (!is_control(object.key)) return Abort::none;
  if (busy()) return Abort::device_state;
  if (raw == stop) return Abort::none;
  if (raw == start) return has_program() ? Abort::none : Abort::device_state;
  if (raw == clear) return object.value == stop ? Abort::none : Abort::device_state;
  return Abort::value;
}

void ProgramMemory::data_written(Time now) noexcept {
  loaded_ = true;
  work(now, write_time);
}

void ProgramMemory::control_written(const Object& object, Time now) noexcept {
  if (!is_control(object.key) || object.value != clear) return;
  store_.find(object.key)->set(stop);
  if (Object* data = store_.find({0x1F50, 1})) data->bytes.clear();
  set_version(0);
  cleared_ = true;
  loaded_ = false;
  work(now, clear_time);
}

void ProgramMemory::work(Time now, Time duration) noexcept {
  busy_until_ = now + duration;
  set_flash(flash_busy);
}

void ProgramMemory::on_time(Time now) noexcept {
  if (now < busy_until_) return;
  busy_until_ = never;
  set_flash(loaded_ && !has_program() ? no_valid_program : std::uint8_t{0});
  if (!loaded_ || !has_program()) return;
  const std::span data{store_.find({0x1F50, 1})->bytes};
  set_version(static_cast<std::uint32_t>(from_little_endian(data.first(version_bytes))));
}

void ProgramMemory::set_flash(std::uint8_t status) noexcept {
  if (Object* flash = store_.find({0x1F57, 1})) flash->set(status);
}

/// Sets the version and its power-on value, so that the version survives a reset.
void ProgramMemory::set_version(std::uint32_t version) noexcept {
  Object* object = store_.find({0x1F56, 1});
  if (object == nullptr) return;
  object->set(version);
  object->power_on = version;
}

}  // namespace takt::sim
