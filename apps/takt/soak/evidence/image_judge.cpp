#include "apps/takt/soak/evidence/image_judge.hpp"

#include <algorithm>

#include "master/wire/bytes.hpp"

namespace takt::soak {

std::uint64_t bits_of(const Frame& frame, unsigned offset, unsigned count) noexcept {
  const auto data = load_le<std::uint64_t>(std::span{frame.data});
  const std::uint64_t mask = count >= 64 ? ~0ULL : (1ULL << count) - 1;
  return data >> offset & mask;
}

bool is_lasting(const BusPlan& plan, const Signal& signal, std::uint64_t value) noexcept {
  constexpr std::uint64_t enabled = 0x0F;  // controlword: bits of "enable operation"
  if (plan.nodes[signal.node_index].cia402 && signal.object.index == 0x6040) {
    return (value & enabled) != enabled;
  }
  const std::uint64_t mask = mask_of(signal.bits);
  return signal.fallback == Fallback::hold ||
         value == (static_cast<std::uint64_t>(signal.fallback_value) & mask) ||
         value == (static_cast<std::uint64_t>(signal.safe_value.value_or(0)) & mask);
}

ImageJudge::ImageJudge(const BusPlan& plan, Verdict& verdict)
    : plan_{plan},
      verdict_{verdict},
      rows_(plan.pdos.tpdos.size()),
      last_(plan.layout.signals.size(), 0) {}

void ImageJudge::on_wire(const sim::WireFrame& wire) noexcept {
  ++frames_;
  const bool whole = wire.result == sim::WireResult::sent || wire.result == sim::WireResult::lost;
  if (!whole || wire.frame.rtr) return;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const PdoRow& pdo = plan_.pdos.tpdos[row];
    if (pdo.cob_id != wire.frame.id || wire.frame.length < pdo.length) continue;
    History& history = rows_[row];
    history.frames[++history.seen % depth] = wire.frame;
  }
}

bool ImageJudge::shows(const PdoRow& row, const Frame& frame,
                       const ImageView& image) const noexcept {
  for (const PdoField& field : plan_.pdos.fields_of(row)) {
    const std::uint64_t mask = mask_of(field.bits);
    const auto value = static_cast<std::uint64_t>(image.values[field.signal]);
    if ((value & mask) != bits_of(frame, field.bit_offset, field.bits)) return false;
    const bool negative = field.sign_extend && ((value >> (field.bits - 1)) & 1) != 0;
    if ((value & ~mask) != (negative ? ~mask : 0)) return false;
  }
  return true;
}

bool ImageJudge::unchanged(const PdoRow& row, const ImageView& image) const noexcept {
  return std::ranges::all_of(plan_.pdos.fields_of(row), [&](const PdoField& field) {
    return image.values[field.signal] == last_[field.signal];
  });
}

/// Finds the oldest frame that fits, because a newer one with the same values may not have been
/// read yet. Returns false if no frame fits.
bool ImageJudge::find(const PdoRow& row, History& history, const ImageView& image) const noexcept {
  const std::uint64_t oldest = history.seen >= depth ? history.seen - depth + 1 : 1;
  for (std::uint64_t i = std::max(oldest, history.matched + 1); i <= history.seen; ++i) {
    if (!shows(row, history.frames[i % depth], image)) continue;
    history.matched = i;
    return true;
  }
  return false;
}

void ImageJudge::judge(const ImageView& image) {
  if (image.cycle <= cycle_ || image.publish_time < published_) {
    verdict_.report_violation("cycle numbers rise", "cycle " + std::to_string(image.cycle) +
                                                        " after " + std::to_string(cycle_));
  }
  if (image.publish_time < image.sync_time) {
    verdict_.report_violation("an image is published after its SYNC",
                              "it was published before its SYNC");
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const PdoRow& row = plan_.pdos.tpdos[i];
    if (row.multiplexed() || unchanged(row, image) || find(row, rows_[i], image)) continue;
    verdict_.report_violation("no torn image", "TPDO" + std::to_string(row.number) + " of node " +
                                                   std::to_string(row.node.value()) +
                                                   " shows values that no single frame carried");
  }
  std::ranges::copy(image.values, last_.begin());
  cycle_ = image.cycle;
  published_ = image.publish_time;
  ++images_;
}

}  // namespace takt::soak
