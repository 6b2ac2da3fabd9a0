#include "eds_parser/boot_error_control.hpp"

#include "eds_parser/integer_of.hpp"

namespace takt {
namespace {

class ErrorControl : BootPart {
 public:
  explicit ErrorControl(const BootPart& part) : BootPart{part} {}

  void append() {
    if (context.producer_ms != 0 && steps.writable({0x1017, 0})) {
      steps.integer(BootAction::write_if_differs, {0x1017, 0}, context.producer_ms,
                    "heartbeat every " + std::to_string(context.producer_ms) + " ms");
    } else if (spec.heartbeat_producer.given && *spec.heartbeat_producer == 0 &&
               steps.writable({0x1017, 0})) {
      steps.integer(BootAction::write_if_differs, {0x1017, 0}, 0, "no heartbeat");
    } else if (spec.heartbeat_producer.given && *spec.heartbeat_producer != 0 &&
               !steps.has({0x1017, 0})) {
      report.error(spec.heartbeat_producer.pos, "no-such-object",
                   "`heartbeat_producer` of node `" + spec.name + "` needs 1017:00, which " +
                       dictionary.file + " does not have");
    }
    watch_master();
    guarding();
    for (const SdoSpec& sdo : spec.error_behavior) {
      if (!steps.has(sdo.object)) {
        report.error(sdo.pos, "no-such-object",
                     "`error_behavior` of node `" + spec.name + "` needs " + to_string(sdo.object) +
                         ", which " + dictionary.file + " does not have");
        continue;
      }
      steps.integer(BootAction::write_if_differs, sdo.object, std::get<std::int64_t>(sdo.value),
                    "error behaviour", 1);
    }
  }

 private:
  /// 0x1016: an entry that already names the master, else the first one.
  void watch_master() {
    if (context.master_consumer_ms == 0 || !*spec.heartbeat_consumer) return;
    const Object* object = dictionary.find(std::uint16_t{0x1016});
    if (object == nullptr) return;
    ObjectKey key{0x1016, 1};
    for (const SubObject& sub : object->subs) {
      const auto value = integer_of(sub.value());
      if (sub.sub != 0 && value && ((*value >> 16) & 0x7F) == context.master_id.value()) {
        key.sub = sub.sub;
      }
    }
    if (!steps.writable(key)) return;
    const std::int64_t value =
        (std::int64_t{context.master_id.value()} << 16) | context.master_consumer_ms;
    if (!takes(key, value, spec.heartbeat_consumer.pos, "the device would not watch the master")) {
      return;
    }
    steps.integer(BootAction::write_if_differs, key, value,
                  "the device watches the master (node " +
                      std::to_string(context.master_id.value()) + ") for " +
                      std::to_string(context.master_consumer_ms) + " ms");
  }

  /// 0x100C and 0x100D, for the device's own life guarding.
  void guarding() {
    if (context.guard.period == Time{}) return;
    const auto ms = context.guard.period / std::chrono::milliseconds{1};
    if (steps.writable({0x100C, 0})) {
      steps.integer(BootAction::write_if_differs, {0x100C, 0}, ms,
                    "guard time " + std::to_string(ms) + " ms", 2);
    }
    if (!spec.life_time_factor.given || !steps.writable({0x100D, 0})) return;
    steps.integer(BootAction::write_if_differs, {0x100D, 0}, *spec.life_time_factor,
                  *spec.life_time_factor == 0
                      ? "no life guarding"
                      : "the device misses the master after " +
                            std::to_string(ms * *spec.life_time_factor) + " ms",
                  1);
  }
};

class Emergency : BootPart {
 public:
  explicit Emergency(const BootPart& part) : BootPart{part} {}

  void append() {
    const ObjectKey id{0x1014, 0};
    const auto wanted = emcy_cob_id();
    if (spec.emcy_cob_id.given && !steps.writable(id)) {
      missing(spec.emcy_cob_id.pos, "emcy_cob_id", id);
    } else if (wanted && steps.writable(id)) {
      const std::int64_t value = *wanted;
      const std::string text = "EMCY on " + hex(static_cast<std::uint32_t>(value), 3);
      steps.integer(BootAction::compare, id, value, text);
      const std::size_t skip = steps.skip_if_same("EMCY has its identifier");
      steps.integer(BootAction::disable_pdo, id, 0, "EMCY off").value.clear();
      steps.integer(BootAction::enable_pdo, id, value, text);
      steps.land(skip);
    }
    const ObjectKey inhibit{0x1015, 0};
    if (!spec.emcy_inhibit_time.given) return;
    if (!steps.writable(inhibit)) {
      return missing(spec.emcy_inhibit_time.pos, "emcy_inhibit_time", inhibit);
    }
    steps.integer(BootAction::write_if_differs, inhibit, *spec.emcy_inhibit_time,
                  "EMCY at most every " + std::to_string(*spec.emcy_inhibit_time) + " x 100 us", 2);
  }

 private:
  /// 0x1014 of the network file, else of a DCF.
  std::optional<std::int64_t> emcy_cob_id() const {
    if (spec.emcy_cob_id.given) return *spec.emcy_cob_id;
    const SubObject* sub = dictionary.find(ObjectKey{0x1014, 0});
    return dictionary.is_dcf && sub != nullptr ? integer_of(sub->parameter_value) : std::nullopt;
  }
};

}  // namespace

void append_error_control(const BootPart& part) { ErrorControl{part}.append(); }

void append_emergency(const BootPart& part) { Emergency{part}.append(); }

}  // namespace takt
