#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/boot/boot_sections.hpp"

namespace takt {
namespace {

class ErrorControlSteps : BootPart {
 public:
  explicit ErrorControlSteps(const BootPart& part) : BootPart{part} {}

  void append() {
    const ObjectKey producer{0x1017, 0};
    const Sourced<std::uint16_t>& wanted = spec.heartbeat_producer;
    if (context.producer_ms != 0 && steps.writable(producer)) {
      steps.integer(BootAction::write_if_differs, producer, context.producer_ms,
                    concat("heartbeat every ", context.producer_ms, " ms"));
    } else if (wanted.given && *wanted == 0 && steps.writable(producer)) {
      steps.integer(BootAction::write_if_differs, producer, 0, "no heartbeat");
    } else if (wanted.given && *wanted != 0 && !steps.has(producer)) {
      report.error(wanted.pos, "no-such-object", "`heartbeat_producer` of node `", spec.name,
                   "` needs 1017:00, which ", dictionary.file, " does not have");
    }
    watch_master();
    guarding();
    for (const SdoSpec& sdo : spec.error_behavior) {
      if (!steps.has(sdo.object)) {
        report.error(sdo.pos, "no-such-object", "`error_behavior` of node `", spec.name, "` needs ",
                     sdo.object, ", which ", dictionary.file, " does not have");
        continue;
      }
      steps.integer(BootAction::write_if_differs, sdo.object, std::get<std::int64_t>(sdo.value),
                    "error behaviour", 1);
    }
  }

 private:
  void watch_master() {
    if (context.master_consumer_ms == 0 || !*spec.heartbeat_consumer) return;
    const Object* object = dictionary.find(std::uint16_t{0x1016});
    if (object == nullptr) return;
    const auto entry = entry_for_master(*object);
    if (!entry) {
      report.warning(spec.heartbeat_consumer.pos.line != 0 ? spec.heartbeat_consumer.pos : spec.pos,
                     "heartbeat-consumer", "node `", spec.name, "`: all entries of 0x1016 in ",
                     dictionary.file,
                     " watch other nodes, so the device will not watch the master");
      return;
    }
    const ObjectKey key{0x1016, *entry};
    if (!steps.writable(key)) return;
    const std::int64_t value =
        (std::int64_t{context.plan.master_id.value()} << 16) | context.master_consumer_ms;
    if (!takes(key, value, spec.heartbeat_consumer.pos, "the device would not watch the master")) {
      return;
    }
    steps.integer(BootAction::write_if_differs, key, value,
                  concat("the device watches the master (node ", context.plan.master_id.value(),
                         ") for ", context.master_consumer_ms, " ms"));
  }

  /// Selects the entry of 0x1016 for the master: the entry that already names the master, else the
  /// first entry that watches no node, else the first entry that neither the network file nor the
  /// DCF configures.
  std::optional<std::uint8_t> entry_for_master(const Object& object) const {
    std::optional<std::uint8_t> unused;
    std::optional<std::uint8_t> by_default;
    for (const SubObject& sub : object.subs) {
      if (sub.sub == 0) continue;
      const auto configured = configured_consumer(sub);
      const auto value = configured.value_or(integer_of(sub.default_value).value_or(0));
      const auto watched = (value >> 16) & 0xFF;
      if (watched == context.plan.master_id.value()) return sub.sub;
      const bool is_free = watched == 0 || watched > 127 || (value & 0xFFFF) == 0;
      if (is_free && !unused) unused = sub.sub;
      if (!configured && !by_default) by_default = sub.sub;
    }
    return unused ? unused : by_default;
  }

  /// Returns the value that the network file, else a DCF, gives to an entry of 0x1016.
  std::optional<std::int64_t> configured_consumer(const SubObject& sub) const {
    const std::int64_t* own = spec.written_integer({0x1016, sub.sub});
    if (own != nullptr) return *own;
    return dictionary.is_dcf ? integer_of(sub.parameter_value) : std::nullopt;
  }

  /// Writes 0x100C and 0x100D for the life guarding of the device.
  void guarding() {
    if (context.node.guard.period == Time{}) return;
    const auto ms = context.node.guard.period / std::chrono::milliseconds{1};
    if (steps.writable({0x100C, 0})) {
      steps.integer(BootAction::write_if_differs, {0x100C, 0}, ms,
                    "guard time " + std::to_string(ms) + " ms", 2);
    } else if (spec.guard_time.given) {
      report.note(spec.guard_time.pos, "guard-object", "the master guards node `", spec.name,
                  "`, but can't write the guard time: ", dictionary.file,
                  " has no writable 100C:00");
    }
    if (!spec.life_time_factor.given) return;
    if (!steps.writable({0x100D, 0})) return no_life_guarding();
    steps.integer(BootAction::write_if_differs, {0x100D, 0}, *spec.life_time_factor,
                  *spec.life_time_factor == 0
                      ? "no life guarding"
                      : "the device reports loss of the master after " +
                            std::to_string(ms * *spec.life_time_factor) + " ms",
                  1);
  }

  void no_life_guarding() const {
    const std::string lacks =
        "100D:00, which " + dictionary.file + " does not have as a writable object";
    if (*spec.life_time_factor == 0) {
      return report.note(spec.life_time_factor.pos, "guarding", "node `", spec.name,
                         "` does not need `life_time_factor: 0`: takt would write it to ", lacks);
    }
    report.warning(spec.life_time_factor.pos, "guard-object", "`life_time_factor` of node `",
                   spec.name, "` needs ", lacks, ": the device will not watch the master");
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
      const std::size_t skip = steps.skip_if_same("EMCY already has this COB-ID");
      if (has_off_bit()) steps.bytes(BootAction::disable_pdo, id, {}, "EMCY off");
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
  /// Returns false if the limits of 0x1014 forbid bit 31. On such a device, the EMCY identifier can
  /// be changed while EMCY is on.
  bool has_off_bit() const {
    const SubObject* sub = dictionary.find(ObjectKey{0x1014, 0});
    const auto high = sub == nullptr ? std::nullopt : integer_of(sub->high_limit);
    return !high || *high >= 0x8000'0000;
  }

  /// Returns 0x1014 of the network file, else of a DCF.
  std::optional<std::int64_t> emcy_cob_id() const {
    if (spec.emcy_cob_id.given) return *spec.emcy_cob_id;
    const SubObject* sub = dictionary.find(ObjectKey{0x1014, 0});
    return dictionary.is_dcf && sub != nullptr ? integer_of(sub->parameter_value) : std::nullopt;
  }
};

}  // namespace

void append_error_control(const BootPart& part) { ErrorControlSteps{part}.append(); }

void append_emergency(const BootPart& part) { Emergency{part}.append(); }

}  // namespace takt
