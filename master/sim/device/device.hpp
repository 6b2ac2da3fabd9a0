#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "eds_parser/table/device_table.hpp"
#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/device/device_faults.hpp"
#include "master/sim/device/routes.hpp"
#include "master/sim/dictionary/dictionary.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/dictionary/parameter_storage.hpp"
#include "master/sim/dictionary/program_memory.hpp"
#include "master/sim/model/model.hpp"
#include "master/sim/pdo/multiplexed_pdos.hpp"
#include "master/sim/pdo/rpdo.hpp"
#include "master/sim/pdo/tpdo.hpp"
#include "master/sim/random.hpp"
#include "master/sim/service/device_heartbeat.hpp"
#include "master/sim/service/device_sdo_server.hpp"
#include "master/sim/service/emcy_producer.hpp"
#include "master/sim/service/guarding.hpp"
#include "master/sim/service/lss_slave.hpp"
#include "master/sim/service/sync_consumer.hpp"
#include "master/sim/service/sync_producer.hpp"
#include "master/sim/service/time_consumer.hpp"
#include "master/sim/service/transmitter.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// NMT state of a device. The values from 4 on are the state values of the heartbeat. CiA 301,
/// 7.3.2.
enum class DeviceState : std::uint8_t {
  off = 1,
  initialising = 0,
  stopped = 4,
  operational = 5,
  preoperational = 127,
};

/// Times that a device needs for its work.
struct DeviceTimes {
  Time startup = std::chrono::milliseconds{50};  ///< time from power-on or reset to boot-up
  Time communication_reset = std::chrono::milliseconds{5};
  Time sdo = std::chrono::microseconds{200};      ///< time from the request to the answer
  Time pdo = std::chrono::microseconds{30};       ///< time from SYNC to the TPDO
  Time segment = std::chrono::microseconds{112};  ///< between upload block segments
};

/// A CANopen device built from its tables. The device takes frames and its local time and hands out
/// frames; it has no access to a bus or to a clock. The world calls on_time() at deadline() and
/// empties out() after each call.
class Device final : private Dictionary {
 public:
  Device(const DeviceTable& table, Random random, DeviceTimes times = {});
  ~Device() override;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  void power_on(Time now) noexcept;
  void power_off() noexcept;
  /// Returns false if the frame has changed neither the deadline nor out().
  bool on_frame(const Frame& frame, Time now) noexcept;
  void on_time(Time now) noexcept;
  Time deadline() const noexcept { return deadline_; }
  Transmitter& out() noexcept { return out_; }

  /// Visits the identifiers that the device receives. take_routes_changed() reports whether they
  /// have changed since its last call.
  template <class Visit>
  void visit_ids(Visit visit) const {
    for (const Route& route : routes_.all()) visit(route.id);
  }
  std::size_t most_ids() const noexcept { return routes_.capacity(); }
  bool take_routes_changed() noexcept { return std::exchange(routes_changed_, false); }

  /// Call this when objects were changed without a write by SDO.
  void look_at_records() noexcept {
    for (Tpdo& tpdo : tpdos_) tpdo.look_at_record();
    list_live_pdos();
  }

  void on_bus_off(Time now) noexcept;
  void on_bus_recovered(Time now) noexcept;
  /// Resets the device as its own watchdog would.
  void reset_node(Time now) noexcept;
  void fail(std::uint16_t emcy_code, Time now) noexcept;
  /// Call this when DeviceFaults::storm_period has changed.
  void start_storm(Time now) noexcept;

  /// Returns the node-ID from the network file.
  NodeId node() const noexcept { return node_; }
  /// Returns the present node-ID, which LSS may have changed. Returns std::nullopt if the device
  /// has no node-ID and therefore responds to LSS only.
  std::optional<NodeId> address() const noexcept;
  /// Returns the bit rate in kbit/s; 0 means the bit rate of the bus.
  unsigned bit_rate() const noexcept { return lss_ ? lss_->bit_rate() : 0; }
  DeviceState state() const noexcept { return state_; }
  ObjectStore& objects() noexcept { return store_; }
  const ObjectStore& objects() const noexcept { return store_; }
  DeviceFaults& faults() noexcept { return faults_; }
  /// Returns nullptr if the device does not support LSS.
  LssSlave* lss() noexcept { return lss_ ? &*lss_ : nullptr; }
  const TimeConsumer& time_of_day() const noexcept { return time_; }

 private:
  // The functions of Dictionary:
  Abort read(ObjectKey key, Time now, std::span<const std::byte>& data) noexcept override;
  Abort write(ObjectKey key, Time now, std::span<const std::byte> data) noexcept override;
  Abort width(ObjectKey key, std::size_t& bytes) const noexcept override;
  bool is_mute(ObjectKey key) const noexcept override;

  bool keep_until_sync(const Route& route, const Frame& frame, Time now) noexcept;
  [[gnu::noinline]] bool share(std::span<const Route> routes, const Frame& frame,
                               Time now) noexcept;
  void dispatch(const Route& route, const Frame& frame, Time now) noexcept;
  void on_request(const Route& route, Time now) noexcept;
  void ask(SdoServer& server, const Frame& frame, Time now) noexcept;
  void on_nmt(const Frame& frame, Time now) noexcept;
  void on_sync(const Frame& frame, Time now) noexcept;
  void make_sync(Time now) noexcept;
  void on_rpdo(Rpdo& rpdo, const Frame& frame, Time now) noexcept;
  void answer(std::uint16_t number, Time now) noexcept;
  void enter(DeviceState state, Time now) noexcept;
  void reset_communication(Time now) noexcept;
  void begin_reset(Time startup, Time now) noexcept;
  void boot(Time now) noexcept;
  void on_lss(const Frame& frame, Time now) noexcept;
  void take_address() noexcept;
  bool speaks_only_lss() const noexcept { return lss_ && lss_->node_id() == LssSlave::none; }
  void send_bootup(Time now) noexcept;
  void communication_error(Time now) noexcept;
  void start_pdos(Time now) noexcept;
  void run_tpdos(Time now) noexcept;
  void stop_pdos() noexcept;
  void list_pdos() noexcept;
  void list_live_pdos() noexcept;
  Abort check_write(const Object& object, std::uint64_t raw) const noexcept;
  Abort check_sdo_server(const Object& object, std::uint64_t raw) const noexcept;
  void written(const Object& object, Time now) noexcept;
  void forget_configuration_date(const Object& changed) noexcept;
  void pdo_written(ObjectKey key, Time now) noexcept;
  void build_routes() noexcept;
  void list_routes() noexcept;
  void route_sdo_servers() noexcept;
  void look_at_inputs(Time now) noexcept;
  void plan_tick() noexcept;
  void finish_call(Time now) noexcept;
  void finish_exchange(Time now) noexcept;
  bool communicates() const noexcept {
    return state_ == DeviceState::operational || state_ == DeviceState::preoperational;
  }

  NodeId node_;
  NodeId address_;
  DeviceTimes times_;
  Random delays_;
  std::uint8_t dummy_usage_;
  ObjectStore store_;
  Transmitter out_;
  DeviceFaults faults_;
  EmcyProducer emcy_;
  std::vector<SdoServer> sdo_;  ///< servers 0x1200, 0x1201 ...
  SyncConsumer sync_;
  SyncProducer sync_producer_;
  TimeConsumer time_;
  HeartbeatProducer heartbeat_;
  HeartbeatConsumer watch_;
  GuardingResponder guarding_;
  ParameterStorage storage_;
  ProgramMemory program_;
  std::optional<LssSlave> lss_;  ///< present with the quirk "lss" or "no_node_id"
  std::vector<Tpdo> tpdos_;
  std::vector<Rpdo> rpdos_;
  std::vector<Tpdo*> live_tpdos_;  ///< TPDOs that can be sent in OPERATIONAL, by number
  std::vector<Rpdo*> live_rpdos_;  ///< RPDOs that have an effect in OPERATIONAL, by number
  MultiplexedPdos multiplexed_;
  std::unique_ptr<Model> model_;
  Routes routes_;
  bool routes_changed_ = true;
  bool answers_rpdos_ = false;  ///< DeviceTraits::answers_255
  DeviceState state_ = DeviceState::off;
  Time boots_at_ = never;
  Time next_storm_ = never;
  Time last_look_{};
  Time tick_ = never;
  Time service_deadline_ = never;  ///< earliest deadline of all but SYNC, PDOs, EMCY and the model
  Time deadline_ = never;
  std::array<std::byte, 8> scratch_{};
};

}  // namespace takt::sim
