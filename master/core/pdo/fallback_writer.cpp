#include "master/core/pdo/fallback_writer.hpp"

#include <algorithm>

namespace takt {
namespace {

bool is_controlword(ObjectKey object) noexcept {
  return object.sub == 0 && object.index >= 0x6040 && object.index < 0xA000 &&
         (object.index - 0x6040) % 0x800 == 0;
}

}  // namespace

FallbackWriter::FallbackWriter(const BusPlan& plan) {
  for (const PdoRow& row : plan.pdos.rpdos) {
    if (!row.synchronous() || row.on_request) continue;
    for (const PdoField& field : plan.pdos.fields_of(row)) {
      const Signal& signal = plan.layout.signals[field.signal];
      if (signal.fallback != Fallback::value) continue;
      values_.push_back({.signal = field.signal,
                         .node = signal.node.value(),
                         .node_index = signal.node_index,
                         .bytes = static_cast<std::uint8_t>((signal.bits + 7) / 8),
                         .object = signal.object,
                         .value = signal.fallback_value});
    }
  }
  std::ranges::stable_partition(values_,
                                [](const Value& value) { return is_controlword(value.object); });
  next_ = values_.size();
}

void FallbackWriter::begin(const PdoOutputs& outputs) noexcept {
  outputs_ = &outputs;
  next_ = 0;
  skip_uncommanded();
}

void FallbackWriter::skip_uncommanded() noexcept {
  while (waits() && !outputs_->fallen(values_[next_].signal)) ++next_;
}

const Request& FallbackWriter::request() noexcept {
  const Value& value = values_[next_];
  request_.id = request_id;
  request_.kind = RequestKind::sdo_download;
  request_.node = value.node;
  request_.object = value.object;
  request_.size = value.bytes;
  for (std::size_t i = 0; i < value.bytes; ++i) {
    request_.data[i] = static_cast<std::byte>(value.value >> (8 * i) & 0xFF);
  }
  return request_;
}

void FallbackWriter::submitted() noexcept {
  ++next_;
  skip_uncommanded();
}

}  // namespace takt
