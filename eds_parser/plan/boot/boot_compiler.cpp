#include "eds_parser/plan/boot/boot_compiler.hpp"

#include <algorithm>
#include <vector>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/boot/boot_part.hpp"
#include "eds_parser/plan/boot/boot_sections.hpp"
#include "eds_parser/plan/boot/boot_steps.hpp"
#include "eds_parser/plan/boot/configuration_date.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

constexpr std::int64_t load_signature = 0x6461'6F6C;  // "load"
constexpr std::int64_t save_signature = 0x6576'6173;  // "save"
constexpr Time restore_timeout = std::chrono::seconds{5};
constexpr unsigned most_axes = 8;  // of a device, CiA 402-1
constexpr Time longest_bootup_wait = std::chrono::seconds{2};

class BootCompiler {
 public:
  BootCompiler(const NodePdos& node, const BootContext& context, NetworkReport& report)
      : node_{node},
        spec_{*node.node.spec},
        dictionary_{*node.node.dictionary},
        tweaks_{node.node.data == nullptr ? BootTweaks{} : node.node.data->boot},
        context_{context},
        report_{report},
        steps_{dictionary_, context.sdo_timeout},
        part_{spec_, dictionary_, context_, steps_, report_} {}

  BootPlan run() {
    reset();
    identity();
    append_program(spec_, steps_, report_);
    ConfigurationDate date{spec_, dictionary_, steps_, report_};
    date.skip_if_there();
    restore();
    append_error_control(part_);
    append_emergency(part_);
    append_time(part_);
    append_sync(part_);
    if (!tweaks_.values_after_pdos) append_values(node_.node, context_, steps_, report_);
    for (const EffectivePdo& pdo : node_.pdos) append_pdo(dictionary_, pdo, steps_);
    if (tweaks_.values_after_pdos) append_values(node_.node, context_, steps_, report_);
    date.enter();
    store();
    date.land();
    if (date.used()) arm();
    limits();
    quick_stop_options();
    start();
    BootPlan plan = steps_.take();
    judge_limits(node_, plan, report_);
    return plan;
  }

 private:
  void reset() {
    const ResetPolicy policy = spec_.reset.value_or(tweaks_.reset.value_or(*spec_.reset));
    std::size_t alive = 0;
    if (policy == ResetPolicy::keep_alive) alive = await_alive();
    if (policy != ResetPolicy::none) {
      steps_.nmt(
          policy == ResetPolicy::node ? NmtCommand::reset_node : NmtCommand::reset_communication,
          policy == ResetPolicy::node ? "reset node" : "reset communication");
      await_bootup();
    }
    if (policy == ResetPolicy::keep_alive) steps_.land(alive);
    probe();
  }

  /// CiA 302-2, keep-alive bit of 0x1F81: an OPERATIONAL node is not reset.
  std::size_t await_alive() {
    const bool guarded = context_.heartbeat_timeout == Time{};
    const Time longest = guarded ? context_.guard.life_time() : context_.heartbeat_timeout;
    BootStep& step = steps_.wait(BootAction::await_alive,
                                 std::max<Time>(longest, std::chrono::milliseconds{100}),
                                 guarded ? 'F' : 'E', "no reset if the node is OPERATIONAL");
    step.guarded = guarded;
    return steps_.size() - 1;
  }

  void await_bootup() {
    steps_.wait(BootAction::await_bootup, std::min(longest_bootup_wait, context_.boot_timeout), 'B',
                "boot-up message; without it the master probes the node next");
    pause(tweaks_.pause_after_bootup_ms, "after the boot-up message");
  }

  void pause(std::uint32_t ms, const std::string& when) {
    if (ms == 0) return;
    steps_.wait(BootAction::pause, std::chrono::milliseconds{ms}, 'J',
                "pause " + when + ", which " + node_.node.data->name + " requires");
  }

  void probe() {
    BootStep& step = steps_.integer(BootAction::probe, {0x1000, 0}, 0, "the node answers SDO");
    step.value.clear();
    step.letter = 'B';
    step.timeout = context_.boot_timeout;
  }

  /// Returns the value of the network file, else of the device file. 0 means that the value is not
  /// checked. [DeviceInfo] is not used: its product number is wrong in one of 25 files.
  std::uint32_t expected(const Sourced<std::uint32_t>& wanted, ObjectKey key) const {
    if (wanted.given) return *wanted;
    return static_cast<std::uint32_t>(integer_of(dictionary_, key).value_or(0));
  }

  void expect(ObjectKey key, std::uint32_t value, char letter, const std::string& purpose) {
    if (value == 0) return;
    steps_.integer(BootAction::expect, key, value, purpose).letter = letter;
  }

  void identity() {
    expect({0x1000, 0}, expected(spec_.device_type, {0x1000, 0}), 'C', "device type");
    expect({0x1018, 1}, expected(spec_.vendor_id, {0x1018, 1}), 'D', "vendor id");
    expect({0x1018, 2}, expected(spec_.product_code, {0x1018, 2}), 'M', "product code");
    expect({0x1018, 3}, *spec_.revision_number, 'N', "revision number");
    expect({0x1018, 4}, *spec_.serial_number, 'O', "serial number");
    if (*spec_.serial_number == 0 && steps_.has({0x1018, 4})) {
      steps_
          .integer(BootAction::read_serial, {0x1018, 4}, 0,
                   "serial number, to recognise the device later")
          .value.clear();
    }
    firmware();
  }

  /// Reads the firmware if rules of the device data depend on it.
  void firmware() {
    if (node_.node.data == nullptr) return;
    const auto plan = firmware_plan(*node_.node.data, node_.node.firmware);
    if (!plan || !steps_.has(plan->object)) return;
    steps_
        .integer(BootAction::read_firmware, plan->object, 0,
                 "firmware; until then takt assumes " + to_string(plan->assumed))
        .value.clear();
  }

  /// Arms the supervision of the master by the device. The last ordered stop may have disarmed it.
  /// Therefore every boot checks it again, regardless of the configuration date, and writes what
  /// differs.
  void arm() {
    append_error_control(part_);
    append_sync(part_);
  }

  void restore() {
    const std::uint8_t sub = *spec_.restore;
    if (sub == 0) return;
    const ObjectKey key{0x1011, sub};
    if (!steps_.has(key)) {
      report_.error(spec_.restore.pos, "no-such-object",
                    "`restore_configuration` of node `" + spec_.name + "` needs " + to_string(key) +
                        ", which " + dictionary_.file + " does not have");
      return;
    }
    steps_.integer(BootAction::write, key, load_signature, "restore defaults (\"load\")").timeout =
        std::max(restore_timeout, context_.sdo_timeout);
    steps_.nmt(sub == 2 ? NmtCommand::reset_communication : NmtCommand::reset_node,
               "make the restored values effective");
    await_bootup();
    probe();
  }

  /// Stores the written parameters, if the network file asks for it. Nothing is stored if no
  /// parameter was written.
  void store() {
    const std::uint8_t sub = *spec_.store;
    if (sub == 0) return;
    const ObjectKey key{0x1010, sub};
    if (!steps_.has(key)) {
      report_.error(spec_.store.pos, "no-such-object",
                    "`store_configuration` of node `" + spec_.name + "` needs " + to_string(key) +
                        ", which " + dictionary_.file + " does not have");
      return;
    }
    steps_.integer(BootAction::write_if_changed, key, save_signature, "store parameters (\"save\")")
        .timeout = std::max(restore_timeout, context_.sdo_timeout);
  }

  /// Reads each object that holds a limit once, even if it bounds several outputs.
  void limits() {
    std::vector<ObjectKey> read;
    const auto once = [&](ObjectKey object) {
      if (std::ranges::find(read, object) != read.end()) return;
      read.push_back(object);
      steps_
          .integer(BootAction::read_limit, object, 0,
                   "limit of the drive, used if the network file sets none")
          .value.clear();
    };
    for (const DeviceLimit& limit : context_.limits) {
      if (limit.node_index != context_.node_index) continue;
      once(limit.object);
      if (limit.bound == DeviceBound::range) once(upper_object(limit));
    }
  }

  /// Reads the quick stop option code of each axis. The ordered stop judges a drive that coasts in
  /// another way, and only the device knows the value that is in force.
  void quick_stop_options() {
    if (!context_.cia402) return;
    for (unsigned axis = 0; axis < most_axes; ++axis) {
      const ObjectKey object = quick_stop_option(axis);
      const SubObject* const sub = dictionary_.find(object);
      if (sub == nullptr || sub->access == Access::wo || bit_width(sub->type) != 16) continue;
      steps_
          .integer(BootAction::read_limit, object, 0,
                   "quick stop option code, for the ordered stop")
          .value.clear();
    }
  }

  void start() {
    const bool watched = context_.heartbeat_timeout != Time{};
    if (watched) {
      steps_.wait(BootAction::await_heartbeat, context_.heartbeat_timeout, 'K', "first heartbeat");
    }
    const Time life_time = context_.guard.life_time();
    if (life_time != Time{}) {
      steps_.wait(BootAction::await_guarding, life_time, 'K', "first answer to guarding");
    }
    if (!context_.start_nodes || context_.start_all) return;
    pause(tweaks_.pause_before_start_ms, "before the start");
    steps_.nmt(NmtCommand::start, "start");
    if (watched || life_time != Time{}) {
      const Time longest = std::max(context_.heartbeat_timeout, life_time);
      steps_.wait(BootAction::await_operational,
                  std::max<Time>(2 * longest, std::chrono::milliseconds{500}), 'K', "OPERATIONAL");
    }
  }

  const NodePdos& node_;
  const NodeSpec& spec_;
  const ObjectDictionary& dictionary_;
  BootTweaks tweaks_;
  const BootContext& context_;
  NetworkReport& report_;
  BootSteps steps_;
  BootPart part_;
};

}  // namespace

BootPlan compile_boot(const NodePdos& node, const BootContext& context, NetworkReport& report) {
  return BootCompiler{node, context, report}.run();
}

bool has_heartbeat_producer(const ObjectDictionary& dictionary) noexcept {
  const SubObject* sub = dictionary.find(ObjectKey{0x1017, 0});
  return sub != nullptr && sub->access != Access::ro && sub->access != Access::constant;
}

}  // namespace takt
