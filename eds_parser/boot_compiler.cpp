#include "eds_parser/boot_compiler.hpp"

#include <algorithm>
#include <set>

#include "eds_parser/boot_pdos.hpp"
#include "eds_parser/boot_program.hpp"
#include "eds_parser/boot_steps.hpp"
#include "eds_parser/boot_values.hpp"
#include "eds_parser/configuration_date.hpp"
#include "eds_parser/device_data.hpp"

namespace takt {
namespace {

constexpr std::int64_t load_signature = 0x6461'6F6C;  // "load"
constexpr std::int64_t save_signature = 0x6576'6173;  // "save"
constexpr Time restore_timeout = std::chrono::seconds{5};
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
        steps_{dictionary_, context.sdo_timeout} {}

  BootPlan run() {
    reset();
    identity();
    append_program(spec_, steps_, report_);
    ConfigurationDate date{spec_, dictionary_, steps_, report_};
    date.skip_if_there();
    restore();
    heartbeat();
    emergency();
    sync();
    if (!tweaks_.values_after_pdos) append_values(node_.node, context_, steps_, report_);
    for (const EffectivePdo& pdo : node_.pdos) append_pdo(dictionary_, pdo, steps_);
    if (tweaks_.values_after_pdos) append_values(node_.node, context_, steps_, report_);
    date.enter();
    store();
    date.land();
    start();
    return steps_.take();
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

  /// CiA 302-2, keep-alive bit of 0x1F81: an OPERATIONAL node is left alone.
  std::size_t await_alive() {
    const bool guarded = context_.heartbeat_timeout == Time{};
    const Time longest = guarded ? context_.guard.life_time() : context_.heartbeat_timeout;
    BootStep& step = steps_.wait(BootAction::await_alive,
                                 std::max<Time>(longest, std::chrono::milliseconds{100}),
                                 guarded ? 'F' : 'E', "is it OPERATIONAL? Then it is left so");
    step.guarded = guarded;
    return steps_.size() - 1;
  }

  void await_bootup() {
    steps_.wait(BootAction::await_bootup, std::min(longest_bootup_wait, context_.boot_timeout), 'B',
                "boot-up message; a node that sends none is probed next");
    pause(tweaks_.pause_after_bootup_ms, "after the boot-up message");
  }

  void pause(std::uint32_t ms, const std::string& when) {
    if (ms == 0) return;
    steps_.wait(BootAction::pause, std::chrono::milliseconds{ms}, 'J',
                "pause " + when + ", as " + node_.node.data->name + " needs it");
  }

  void probe() {
    BootStep& step = steps_.integer(BootAction::probe, {0x1000, 0}, 0, "the node answers SDO");
    step.value.clear();
    step.letter = 'B';
    step.timeout = context_.boot_timeout;
  }

  /// The value of the network file, else of the device file; 0 is not checked. [DeviceInfo] is not
  /// believed: its product number is wrong in one of 25 files.
  std::uint32_t expected(const Sourced<std::uint32_t>& wanted, ObjectKey key) const {
    if (wanted.given) return *wanted;
    const SubObject* sub = dictionary_.find(key);
    if (sub == nullptr || !sub->value()) return 0;
    return static_cast<std::uint32_t>(as_integer(*sub->value()).value_or(0));
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
      steps_.integer(BootAction::read_serial, {0x1018, 4}, 0, "serial number, to know it again")
          .value.clear();
    }
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

  /// What was written is kept, as the network file asks; nothing is stored where nothing was
  /// written.
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

  /// 0x1014 of the network file, else of a DCF.
  std::optional<std::int64_t> emcy_cob_id() const {
    if (spec_.emcy_cob_id.given) return *spec_.emcy_cob_id;
    const SubObject* sub = dictionary_.find(ObjectKey{0x1014, 0});
    if (!dictionary_.is_dcf || sub == nullptr || !sub->parameter_value) return std::nullopt;
    return as_integer(*sub->parameter_value);
  }

  void emergency() {
    const ObjectKey id{0x1014, 0};
    const auto wanted = emcy_cob_id();
    if (spec_.emcy_cob_id.given && !steps_.writable(id)) {
      missing(spec_.emcy_cob_id.pos, "emcy_cob_id", id);
    } else if (wanted && steps_.writable(id)) {
      const std::int64_t value = *wanted;
      const std::string text = "EMCY on " + hex(static_cast<std::uint32_t>(value), 3);
      steps_.integer(BootAction::compare, id, value, text);
      const std::size_t skip = steps_.skip_if_same("EMCY has its identifier");
      steps_.integer(BootAction::disable_pdo, id, 0, "EMCY off").value.clear();
      steps_.integer(BootAction::enable_pdo, id, value, text);
      steps_.land(skip);
    }
    const ObjectKey inhibit{0x1015, 0};
    if (!spec_.emcy_inhibit_time.given) return;
    if (!steps_.writable(inhibit)) {
      return missing(spec_.emcy_inhibit_time.pos, "emcy_inhibit_time", inhibit);
    }
    steps_.integer(BootAction::write_if_differs, inhibit, *spec_.emcy_inhibit_time,
                   "EMCY at most every " + std::to_string(*spec_.emcy_inhibit_time) + " x 100 us",
                   2);
  }

  void missing(SourcePos pos, const std::string& key, ObjectKey object) {
    report_.error(pos, "no-such-object",
                  "`" + key + "` of node `" + spec_.name + "` needs " + to_string(object) +
                      ", which " + dictionary_.file + " does not have or can't change");
  }

  void heartbeat() {
    if (context_.producer_ms != 0 && steps_.writable({0x1017, 0})) {
      steps_.integer(BootAction::write_if_differs, {0x1017, 0}, context_.producer_ms,
                     "heartbeat every " + std::to_string(context_.producer_ms) + " ms");
    } else if (spec_.heartbeat_producer.given && *spec_.heartbeat_producer == 0 &&
               steps_.writable({0x1017, 0})) {
      steps_.integer(BootAction::write_if_differs, {0x1017, 0}, 0, "no heartbeat");
    } else if (spec_.heartbeat_producer.given && *spec_.heartbeat_producer != 0 &&
               !steps_.has({0x1017, 0})) {
      report_.error(spec_.heartbeat_producer.pos, "no-such-object",
                    "`heartbeat_producer` of node `" + spec_.name + "` needs 1017:00, which " +
                        dictionary_.file + " does not have");
    }
    watch_master();
    guarding();
    for (const SdoSpec& sdo : spec_.error_behavior) {
      if (!steps_.has(sdo.object)) {
        report_.error(sdo.pos, "no-such-object",
                      "`error_behavior` of node `" + spec_.name + "` needs " +
                          to_string(sdo.object) + ", which " + dictionary_.file + " does not have");
        continue;
      }
      steps_.integer(BootAction::write_if_differs, sdo.object, std::get<std::int64_t>(sdo.value),
                     "error behaviour", 1);
    }
  }

  /// Values that follow from the plan are not forced upon a device whose limits exclude them.
  bool takes(ObjectKey key, std::int64_t value, SourcePos pos, const std::string& consequence) {
    const SubObject* sub = dictionary_.find(key);
    const auto low = sub->low_limit ? as_integer(*sub->low_limit) : std::nullopt;
    const auto high = sub->high_limit ? as_integer(*sub->high_limit) : std::nullopt;
    if ((!low || value >= *low) && (!high || value <= *high)) return true;
    report_.warning(pos == SourcePos{} ? spec_.pos : pos, "limits",
                    "node `" + spec_.name + "`: " + label(dictionary_, key) + " = " +
                        std::to_string(value) + " is outside the limits " +
                        (low ? std::to_string(*low) : "") + ".." +
                        (high ? std::to_string(*high) : "") + " of " + dictionary_.file +
                        "; it is not written" + (consequence.empty() ? "" : ", ") + consequence);
    return false;
  }

  /// 0x1016: an entry that already names the master, else the first one.
  void watch_master() {
    if (context_.master_consumer_ms == 0 || !*spec_.heartbeat_consumer) return;
    const Object* object = dictionary_.find(std::uint16_t{0x1016});
    if (object == nullptr) return;
    ObjectKey key{0x1016, 1};
    for (const SubObject& sub : object->subs) {
      const auto value = sub.value() ? as_integer(*sub.value()) : std::nullopt;
      if (sub.sub != 0 && value && ((*value >> 16) & 0x7F) == context_.master_id.value()) {
        key.sub = sub.sub;
      }
    }
    if (!steps_.writable(key)) return;
    const std::int64_t value =
        (std::int64_t{context_.master_id.value()} << 16) | context_.master_consumer_ms;
    if (!takes(key, value, spec_.heartbeat_consumer.pos, "the device would not watch the master")) {
      return;
    }
    steps_.integer(BootAction::write_if_differs, key, value,
                   "the device watches the master (node " +
                       std::to_string(context_.master_id.value()) + ") for " +
                       std::to_string(context_.master_consumer_ms) + " ms");
  }

  /// 0x100C and 0x100D, for the device's own life guarding.
  void guarding() {
    if (context_.guard.period == Time{}) return;
    const auto ms = context_.guard.period / std::chrono::milliseconds{1};
    if (steps_.writable({0x100C, 0})) {
      steps_.integer(BootAction::write_if_differs, {0x100C, 0}, ms,
                     "guard time " + std::to_string(ms) + " ms", 2);
    }
    if (!spec_.life_time_factor.given || !steps_.writable({0x100D, 0})) return;
    steps_.integer(BootAction::write_if_differs, {0x100D, 0}, *spec_.life_time_factor,
                   *spec_.life_time_factor == 0
                       ? "no life guarding"
                       : "the device misses the master after " +
                             std::to_string(ms * *spec_.life_time_factor) + " ms",
                   1);
  }

  void sync() {
    if (!context_.sync) return;
    if (steps_.writable({0x1005, 0})) {
      steps_
          .integer(BootAction::write_if_differs, {0x1005, 0}, context_.sync_cob_id,
                   "SYNC comes from the master, on " + hex(context_.sync_cob_id, 3))
          .mask = 0x7FFF'FFFF;
    }
    sync_counter();
    if (steps_.writable({0x1006, 0}) && takes({0x1006, 0}, context_.sync_period_us, {}, "")) {
      steps_.integer(BootAction::write_if_differs, {0x1006, 0}, context_.sync_period_us,
                     "SYNC period " + std::to_string(context_.sync_period_us) + " us");
    }
    if (!context_.sync_window_us.given) return;
    if (steps_.writable({0x1007, 0})) {
      steps_.integer(BootAction::write_if_differs, {0x1007, 0}, *context_.sync_window_us,
                     "synchronous window " + std::to_string(*context_.sync_window_us) + " us");
    }
  }

  /// 0x1019 may change only while 0x1006 is 0. CiA 301, 7.5.2.22.
  void sync_counter() {
    const ObjectKey key{0x1019, 0};
    if (!steps_.writable(key)) {
      if (context_.sync_overflow != 0 && !steps_.has(key)) {
        report_.warning(spec_.pos, "sync-counter",
                        "node `" + spec_.name + "` has no " + to_string(key) +
                            ": it may report each SYNC with a counter as a length error");
      }
      return;
    }
    const std::string purpose = context_.sync_overflow == 0
                                    ? "SYNC without counter"
                                    : "SYNC counter 1.." + std::to_string(context_.sync_overflow);
    steps_.integer(BootAction::compare, key, context_.sync_overflow, purpose, 1);
    const std::size_t skip = steps_.skip_if_same("SYNC counter is right");
    if (steps_.writable({0x1006, 0})) {
      steps_.integer(BootAction::write, {0x1006, 0}, 0, "period 0, so that 1019 may change");
    }
    steps_.integer(BootAction::write, key, context_.sync_overflow, purpose, 1);
    steps_.land(skip);
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
