#pragma once
#include <array>
#include <cstdint>

namespace takt::sim {

/// Error codes of the parameter channel.
enum class Drv28Error : std::uint16_t {
  none = 0,
  invalid_command = 1,
  invalid_address = 2,
  invalid_value = 3,
  operation_failed = 4,
  wrong_password = 5,
  frame = 6,
  read_only = 7,
  not_while_running = 8,
  locked = 9,
};

/// The function codes (parameters) of the inverter; P15.13 has the address 0x0F0D. The set is only
/// large enough to show each error code.
class Drv28Parameters {
 public:
  struct Answer {
    Drv28Error error = Drv28Error::none;
    std::uint32_t value = 0;
  };

  void reset() noexcept { *this = Drv28Parameters{}; }
  Answer read(std::uint16_t address) const noexcept;
  Answer write(std::uint16_t address, std::uint32_t value, bool running) noexcept;

 private:
  enum class Change : std::uint8_t { free, stopped, never, terminal, password };
  struct Parameter {
    std::uint16_t address;
    Change change;
    std::uint32_t value;
    std::uint32_t highest;
  };

  const Parameter* find(std::uint16_t address) const noexcept;
  bool locked() const noexcept;
  bool is_taken(const Parameter& terminal, std::uint32_t value) const noexcept;
  Answer enter_password(Parameter& password, std::uint32_t value) noexcept;

  std::array<Parameter, 9> parameters_{{
      {0x0003, Change::stopped, 5000, 40000},  // P00.03 highest frequency, 0.01 Hz
      {0x000A, Change::free, 5000, 40000},     // P00.10 set frequency, 0.01 Hz
      {0x000B, Change::free, 200, 36000},      // P00.11 acceleration time, 0.1 s
      {0x0501, Change::terminal, 1, 63},       // P05.01 function of terminal 1
      {0x0502, Change::terminal, 4, 63},       // P05.02 function of terminal 2
      {0x0700, Change::password, 0, 65535},    // P07.00 password
      {0x0F0D, Change::free, 0, 65535},        // P15.13
      {0x1100, Change::never, 5000, 40000},    // P17.00 present set frequency, 0.01 Hz
      {0x1D00, Change::never, 0, 0},           // P29.00
  }};
  bool unlocked_ = true;
};

}  // namespace takt::sim
