#include "eds_parser/plan/boot/boot_compiler.hpp"

#include <algorithm>
#include <vector>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/boot/boot_sections.hpp"
#include "eds_parser/plan/boot/configuration_date.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

constexpr std::int64_t load_signature = 0x6461'6F6C;  // "load"
constexpr std::int64_t save_signature = 0x6576'6173;  // "save"
constexpr Time restore_timeout = std::chrono::seconds{5};
constexpr std::uint32_t default_boot_timeout_ms = 3000;
constexpr Time longest_bootup_wait = std::chrono::seconds{2};

class BootCompiler : BootPart {
 public:
  BootCompiler(const NodePdos& source, const BootContext& from, NetworkReport& to)
      : BootPart{source.node, *source.node.spec, *source.node.dictionary, from, steps_, to},
        pdos_{source},
        tweaks_{node.data == nullptr ? BootTweaks{} : node.data->boot},
        steps_{dictionary, from.node.sdo_timeout} {}

  BootPlan run() {
    reset();
    identity();
    append_program(*this);
    ConfigurationDate date{*this};
    date.skip_if_there();
    restore();
    append_error_control(*this);
    append_emergency(*this);
    append_time(*this);
    append_sync(*this);
    append_homing(*this);
    if (!tweaks_.values_after_pdos) append_values(*this);
    for (const EffectivePdo& pdo : pdos_.pdos) append_pdo(*this, pdo);
    if (tweaks_.values_after_pdos) append_values(*this);
    date.enter();
    store();
    date.land();
    if (date.used()) arm();
    limits();
    quick_stop_options();
    start();
    BootPlan plan = steps.take();
    judge_limits(pdos_, plan, report);
    return plan;
  }

 private:
  Time boot_timeout() const {
    return std::chrono::milliseconds{spec.boot_timeout_ms.value_or(default_boot_timeout_ms)};
  }

  void reset() {
    const ResetPolicy policy = spec.reset.value_or(tweaks_.reset.value_or(*spec.reset));
    std::size_t alive = 0;
    if (policy == ResetPolicy::keep_alive) alive = await_alive();
    if (policy != ResetPolicy::none) {
      steps.nmt(
          policy == ResetPolicy::node ? NmtCommand::reset_node : NmtCommand::reset_communication,
          policy == ResetPolicy::node ? "reset node" : "reset communication");
      await_bootup();
    }
    if (policy == ResetPolicy::keep_alive) steps.land(alive);
    probe();
  }

  /// Appends the step that finds out whether the node is OPERATIONAL; such a node is not reset. CiA
  /// 302-2 defines this as the keep-alive bit of 0x1F81. Returns the index of the step.
  std::size_t await_alive() {
    const bool guarded = context.node.heartbeat_timeout == Time{};
    const Time longest = guarded ? context.node.guard.life_time() : context.node.heartbeat_timeout;
    BootStep& step =
        steps.wait(BootAction::await_alive, std::max<Time>(longest, std::chrono::milliseconds{100}),
                   guarded ? 'F' : 'E', "no reset if the node is OPERATIONAL");
    step.guarded = guarded;
    return steps.size() - 1;
  }

  void await_bootup() {
    steps.wait(BootAction::await_bootup, std::min(longest_bootup_wait, boot_timeout()), 'B',
               "boot-up message; without it the master probes the node next");
    pause(tweaks_.pause_after_bootup_ms, "after the boot-up message");
  }

  void pause(std::uint32_t ms, const std::string& when) {
    if (ms == 0) return;
    steps.wait(BootAction::pause, std::chrono::milliseconds{ms}, 'J',
               "pause " + when + ", which " + node.data->name + " requires");
  }

  void probe() {
    BootStep& step = steps.bytes(BootAction::probe, {0x1000, 0}, {}, "the node answers SDO");
    step.letter = 'B';
    step.timeout = boot_timeout();
  }

  /// Returns the value of the network file, else of the device file. 0 means that the value is not
  /// checked. [DeviceInfo] is not used: its product number is wrong in one of 25 files.
  std::uint32_t expected(const Sourced<std::uint32_t>& wanted, ObjectKey key) const {
    return wanted.given ? *wanted : unsigned32_of(dictionary, key);
  }

  void expect(ObjectKey key, std::uint32_t value, char letter, const std::string& purpose) {
    if (value == 0) return;
    steps.integer(BootAction::expect, key, value, purpose).letter = letter;
  }

  void identity() {
    expect({0x1000, 0}, expected(spec.device_type, {0x1000, 0}), 'C', "device type");
    expect({0x1018, 1}, expected(spec.vendor_id, {0x1018, 1}), 'D', "vendor id");
    expect({0x1018, 2}, expected(spec.product_code, {0x1018, 2}), 'M', "product code");
    expect({0x1018, 3}, *spec.revision_number, 'N', "revision number");
    expect({0x1018, 4}, *spec.serial_number, 'O', "serial number");
    if (*spec.serial_number == 0 && steps.has({0x1018, 4})) {
      steps.bytes(BootAction::read_serial, {0x1018, 4}, {},
                  "serial number, to recognise the device later");
    }
    firmware();
  }

  /// Reads the firmware version if rules of the device data depend on it.
  void firmware() {
    if (node.data == nullptr) return;
    const auto plan = firmware_plan(*node.data, node.firmware);
    if (!plan || !steps.has(plan->object)) return;
    steps.bytes(BootAction::read_firmware, plan->object, {},
                "firmware; until then takt assumes " + to_string(plan->assumed));
  }

  /// Arms the device to supervise the master and SYNC. The last ordered stop may have disarmed it.
  /// Therefore every boot compares these objects, regardless of the configuration date, and writes
  /// those that differ.
  void arm() {
    append_error_control(*this);
    append_sync(*this);
  }

  /// Returns true if `sub` is not 0 and the device has the object. If only the object is missing,
  /// reports an error.
  bool wants(const Sourced<std::uint8_t>& sub, std::string_view key, std::uint16_t index) {
    const ObjectKey object{index, *sub};
    if (*sub == 0 || steps.has(object)) return *sub != 0;
    report.error(sub.pos, "no-such-object", "`", key, "` of node `", spec.name, "` needs ", object,
                 ", which ", dictionary.file, " does not have");
    return false;
  }

  void restore() {
    const std::uint8_t sub = *spec.restore;
    if (!wants(spec.restore, "restore_configuration", 0x1011)) return;
    steps.integer(BootAction::write, {0x1011, sub}, load_signature, "restore defaults (\"load\")")
        .timeout = std::max(restore_timeout, context.node.sdo_timeout);
    steps.nmt(sub == 2 ? NmtCommand::reset_communication : NmtCommand::reset_node,
              "make the restored values effective");
    await_bootup();
    probe();
  }

  /// Stores the written parameters, if the network file asks for it. Nothing is stored if no
  /// parameter was written.
  void store() {
    if (!wants(spec.store, "store_configuration", 0x1010)) return;
    steps
        .integer(BootAction::write_if_changed, {0x1010, *spec.store}, save_signature,
                 "store parameters (\"save\")")
        .timeout = std::max(restore_timeout, context.node.sdo_timeout);
  }

  /// Reads each object that holds a limit once, even if the limit applies to several outputs.
  void limits() {
    std::vector<ObjectKey> read;
    const auto once = [&](ObjectKey object) {
      if (std::ranges::find(read, object) != read.end()) return;
      read.push_back(object);
      steps.bytes(BootAction::read_limit, object, {},
                  "limit of the drive, used if the network file sets none");
    };
    for (const DeviceLimit& limit : context.plan.limits.device) {
      if (limit.node_index != context.node_index) continue;
      once(limit.object);
      if (limit.bound == DeviceBound::range) once(upper_object(limit));
    }
  }

  /// Reads the quick stop option code of each axis, because only the device knows the present
  /// value. For a drive that coasts, the ordered stop detects standstill by a different rule.
  void quick_stop_options() {
    if (!context.node.cia402) return;
    for (unsigned axis = 0; axis < most_axes; ++axis) {
      const ObjectKey object = quick_stop_option(axis);
      const SubObject* const sub = dictionary.find(object);
      if (sub == nullptr || sub->access == Access::wo || bit_width(sub->type) != 16) continue;
      steps.bytes(BootAction::read_limit, object, {},
                  "quick stop option code, for the ordered stop");
    }
  }

  void start() {
    const bool watched = context.node.heartbeat_timeout != Time{};
    if (watched) {
      steps.wait(BootAction::await_heartbeat, context.node.heartbeat_timeout, 'K',
                 "first heartbeat");
    }
    const Time life_time = context.node.guard.life_time();
    if (life_time != Time{}) {
      steps.wait(BootAction::await_guarding, life_time, 'K', "first answer to guarding");
    }
    if (!*context.master.start_nodes || *context.master.start_all_nodes) return;
    pause(tweaks_.pause_before_start_ms, "before the start");
    steps.nmt(NmtCommand::start, "start");
    if (watched || life_time != Time{}) {
      const Time longest = std::max(context.node.heartbeat_timeout, life_time);
      steps.wait(BootAction::await_operational,
                 std::max<Time>(2 * longest, std::chrono::milliseconds{500}), 'K', "OPERATIONAL");
    }
  }

  const NodePdos& pdos_;
  BootTweaks tweaks_;
  BootSteps steps_;
};

}  // namespace

BootPlan compile_boot(const NodePdos& node, const BootContext& context, NetworkReport& report) {
  return BootCompiler{node, context, report}.run();
}

bool has_heartbeat_producer(const ObjectDictionary& dictionary) noexcept {
  const SubObject* sub = dictionary.find(ObjectKey{0x1017, 0});
  return sub != nullptr && sub->is_writable();
}

}  // namespace takt
