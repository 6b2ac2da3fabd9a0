#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <takt/event_t.hpp>
#include <vector>

#include "apps/axis/axis_control.hpp"
#include "apps/axis/image_input.hpp"
#include "master/gateway/envelope.hpp"
#include "master/gateway/transport.hpp"

namespace takt {

struct AxisGroupOptions {
  std::string bus;                 ///< empty: the first bus that is heard
  std::string sender = "axes";     ///< one sender holds a node's outputs at a time
  std::int32_t stale_cycles = 5;   ///< an image older than this is stale
  std::int32_t time_to_live = 20;  ///< of the commands, in cycles; 0: as configured
};

/// What waiting for the next image came to.
enum class Input : std::uint8_t {
  fresh,      ///< the newest image is new
  nothing,    ///< no image yet, or none in this time
  stale,      ///< the newest image has become older than `stale_cycles`
  restarted,  ///< the daemon or its layout is another one; all axes shall be disabled
};

/// The axes of one bus over LCM. Takes only the newest image; commands carry the session and the
/// cycle that they were computed from. One thread.
class AxisGroup {
 public:
  AxisGroup(std::unique_ptr<Transport> lcm, AxisGroupOptions options);
  /// Releases what it commands.
  ~AxisGroup();
  AxisGroup(const AxisGroup&) = delete;
  AxisGroup& operator=(const AxisGroup&) = delete;

  /// Sends commands in envelopes from now on, where the daemon has `keys`.
  void sign_with(EnvelopeKey key);
  /// Waits for the next image, `longest` at most, and steps the axes with it.
  Input wait(std::chrono::nanoseconds longest);
  /// Of the commands from now on, in cycles; 0: as configured.
  void set_time_to_live(std::int32_t cycles) noexcept { options_.time_to_live = cycles; }
  /// Sends the set-points of all axes. False: LCM did not take them.
  bool send();
  /// Gives up the outputs that it commands: they take their fallback at once, without a warning,
  /// and another sender may have them. The next send() asks for them again. False: LCM did not take
  /// it.
  bool release();
  /// Loads a target position for each axis and sends them as one command: with synchronous RPDOs
  /// all become valid with one SYNC. Axes that are not in Operation enabled keep to their position.
  bool load_targets(const Eigen::Ref<const Eigen::VectorXd>& positions);

  AxisControl& axes() noexcept { return axes_; }
  const ImageInput& input() const noexcept { return input_; }
  const std::string& bus() const noexcept { return bus_; }  ///< empty: none heard yet
  std::chrono::nanoseconds period() const noexcept;         ///< of SYNC; 0: not known yet
  /// Age of the newest image by this machine's clock.
  std::chrono::nanoseconds age() const;
  /// What the daemon has told since the last call (boots, refused commands, faults), 256 at most.
  /// Once an `other_schema` of this library's own, where the daemon is of another takt.
  std::vector<event_t> take_events();

 private:
  using Clock = std::chrono::steady_clock;

  void serve();
  void take(std::string_view channel, std::span<const std::byte> data);
  void listen_to(std::string_view bus);
  void take_image(std::span<const std::byte> data);
  void take_layout(std::span<const std::byte> data);
  void tell_schema(std::int16_t schema);
  bool publish(command_t& command);
  bool is_stale() const;

  std::unique_ptr<Transport> lcm_;
  AxisGroupOptions options_;
  std::string bus_;
  std::string heard_;  // a bus whose layout came while none was chosen
  std::string image_channel_;
  std::string layout_channel_;
  std::string command_channel_;
  std::string secured_channel_;
  std::string event_channel_;
  ImageInput input_;
  AxisControl axes_;
  bool fresh_ = false;
  bool new_layout_ = false;
  bool told_stale_ = false;
  bool told_schema_ = false;
  bool commands_ = false;  // something was sent since the last release
  Clock::time_point arrival_{};
  std::int64_t instance_;
  std::optional<EnvelopeSeal> seal_;  // none: no key
  std::vector<event_t> events_;
  std::vector<std::byte> buffer_;
};

}  // namespace takt
