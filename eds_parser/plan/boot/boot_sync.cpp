#include "eds_parser/plan/boot/boot_sections.hpp"

namespace takt {
namespace {

class SyncSteps : BootPart {
 public:
  explicit SyncSteps(const BootPart& part) : BootPart{part} {}

  void append() {
    if (!context.sync) return;
    if (steps.writable({0x1005, 0})) {
      const std::string from = context.makes_sync ? "this node" : context.sync_source;
      steps
          .integer(BootAction::write_if_differs, {0x1005, 0}, context.sync_cob_id,
                   "SYNC comes from " + from + ", on " + hex(context.sync_cob_id, 3))
          .mask = context.makes_sync ? 0x3FFF'FFFF : 0x7FFF'FFFF;
    }
    sync_counter();
    if (steps.writable({0x1006, 0}) && takes({0x1006, 0}, context.sync_period_us, {}, "")) {
      steps.integer(BootAction::write_if_differs, {0x1006, 0}, context.sync_period_us,
                    "SYNC period " + std::to_string(context.sync_period_us) + " us");
    }
    make_sync();
    if (!context.sync_window_us.given) return;
    if (steps.writable({0x1007, 0})) {
      steps.integer(BootAction::write_if_differs, {0x1007, 0}, *context.sync_window_us,
                    "synchronous window " + std::to_string(*context.sync_window_us) + " us");
    }
  }

 private:
  /// Sets bit 30 last: it starts SYNC, and afterwards no other bit may change. CiA 301, 7.5.2.5.
  void make_sync() {
    if (!context.makes_sync) return;
    steps
        .integer(BootAction::write_if_differs, {0x1005, 0}, context.sync_cob_id | 0x4000'0000,
                 "this node makes SYNC from now on")
        .mask = 0x7FFF'FFFF;
  }

  /// 0x1019 may change only while 0x1006 is 0. CiA 301, 7.5.2.22.
  void sync_counter() {
    const ObjectKey key{0x1019, 0};
    if (!steps.writable(key)) {
      if (context.sync_overflow != 0 && !steps.has(key)) {
        report.warning(spec.pos, "sync-counter",
                       "node `" + spec.name + "` has no " + to_string(key) +
                           ": the device may report each SYNC with a counter as a length error");
      }
      return;
    }
    const std::string purpose = context.sync_overflow == 0
                                    ? "SYNC without counter"
                                    : "SYNC counter 1.." + std::to_string(context.sync_overflow);
    steps.integer(BootAction::compare, key, context.sync_overflow, purpose, 1);
    const std::size_t skip = steps.skip_if_same("SYNC counter needs no change");
    if (steps.writable({0x1006, 0})) {
      steps.integer(BootAction::write, {0x1006, 0}, 0, "period 0, so that 1019 may change");
    }
    steps.integer(BootAction::write, key, context.sync_overflow, purpose, 1);
    steps.land(skip);
  }
};

}  // namespace

void append_sync(const BootPart& part) { SyncSteps{part}.append(); }

/// The identifier may change only while bits 30 and 31 are 0. CiA 301, 7.5.2.15.
void append_time(const BootPart& part) {
  if (!part.spec.time_cob_id.given) return;
  const ObjectKey key{0x1012, 0};
  if (!part.steps.writable(key)) return part.missing(part.spec.time_cob_id.pos, "time_cob_id", key);
  const std::uint32_t value = *part.spec.time_cob_id;
  const std::uint32_t id = value & 0x3FFF'FFFF;
  const std::string text = "TIME on " + hex(id, 3);
  part.steps.integer(BootAction::write_if_differs, key, id, text, 4).mask = 0x3FFF'FFFF;
  const bool consumes = (value & 0x8000'0000) != 0;
  part.steps.integer(BootAction::write_if_differs, key, value,
                     text + (consumes ? ", consumed by the device" : ""), 4);
}

}  // namespace takt
