#include "eds_parser/plan/boot/boot_sections.hpp"

namespace takt {
namespace {

class SyncSteps : BootPart {
 public:
  explicit SyncSteps(const BootPart& part) : BootPart{part} {}

  void append() {
    if (!context.plan.cycle.sync) return;
    const MasterSpec& master = context.master;
    const std::uint32_t period = *master.sync_period_us;
    if (steps.writable({0x1005, 0})) {
      const std::string from = context.makes_sync()               ? "this node"
                               : context.plan.cycle.sync_followed ? *master.sync_source
                                                                  : "the master";
      steps
          .integer(BootAction::write_if_differs, {0x1005, 0}, *master.sync_cob_id,
                   "SYNC comes from " + from + ", on " + hex(*master.sync_cob_id, 3))
          .mask = context.makes_sync() ? 0x3FFF'FFFF : 0x7FFF'FFFF;
    }
    sync_counter();
    if (steps.writable({0x1006, 0}) && takes({0x1006, 0}, period, {}, "")) {
      steps.integer(BootAction::write_if_differs, {0x1006, 0}, period,
                    concat("SYNC period ", period, " us"));
    }
    make_sync();
    if (master.sync_window_us.given && steps.writable({0x1007, 0})) {
      steps.integer(BootAction::write_if_differs, {0x1007, 0}, *master.sync_window_us,
                    concat("synchronous window ", *master.sync_window_us, " us"));
    }
  }

 private:
  /// Sets bit 30 last, because this bit starts SYNC and afterwards no other bit may change. CiA
  /// 301, 7.5.2.5.
  void make_sync() {
    if (!context.makes_sync()) return;
    steps
        .integer(BootAction::write_if_differs, {0x1005, 0},
                 *context.master.sync_cob_id | 0x4000'0000, "this node produces SYNC from now on")
        .mask = 0x7FFF'FFFF;
  }

  /// Writes 0x1019, which may change only while 0x1006 is 0. CiA 301, 7.5.2.22.
  void sync_counter() {
    const ObjectKey key{0x1019, 0};
    const std::uint8_t overflow = *context.master.sync_overflow;
    if (!steps.writable(key)) {
      if (overflow == 0 || steps.has(key)) return;
      return report.warning(spec.pos, "sync-counter", "node `", spec.name, "` has no ", key,
                            ": the device may report each SYNC with a counter as a length error");
    }
    const std::string purpose =
        overflow == 0 ? "SYNC without counter" : concat("SYNC counter 1..", overflow);
    steps.integer(BootAction::compare, key, overflow, purpose, 1);
    const std::size_t skip = steps.skip_if_same("SYNC counter needs no change");
    if (steps.writable({0x1006, 0})) {
      steps.integer(BootAction::write, {0x1006, 0}, 0, "period 0, so that 1019 may change");
    }
    steps.integer(BootAction::write, key, overflow, purpose, 1);
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
