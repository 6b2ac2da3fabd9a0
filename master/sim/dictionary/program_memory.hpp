#pragma once
#include <cstdint>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/object_store.hpp"

namespace takt::sim {

/// The program memory of a device and its download: data 0x1F50, control 0x1F51, version 0x1F56,
/// flash status 0x1F57. The first four bytes of a program are its version. CiA 302-3.
class ProgramMemory {
 public:
  explicit ProgramMemory(ObjectStore& store) : store_{store} {}

  /// Checks whether the write is allowed now. The order is: stop the program, clear it, load it,
  /// start it.
  Abort check_data() const noexcept;
  Abort check_control(const Object& object, std::uint64_t raw) const noexcept;
  void data_written(Time now) noexcept;
  void control_written(const Object& object, Time now) noexcept;

  /// Called when the flash memory has finished its work.
  void on_time(Time now) noexcept;
  Time deadline() const noexcept { return busy_until_; }

  static constexpr bool is_data(ObjectKey key) noexcept { return key == ObjectKey{0x1F50, 1}; }
  static constexpr bool is_control(ObjectKey key) noexcept { return key == ObjectKey{0x1F51, 1}; }

 private:
  enum Command : std::uint8_t { stop = 0, start = 1, clear = 3 };

  bool busy() const noexcept { return busy_until_ != never; }
  void set_flash(std::uint8_t status) noexcept;
  void set_version(std::uint32_t version) noexcept;
  void work(Time now, Time duration) noexcept;
  bool has_program() const noexcept;

  ObjectStore& store_;
  bool cleared_ = false;
  bool loaded_ = false;  ///< data was written since the last clear
  Time busy_until_ = never;
};

}  // namespace takt::sim
