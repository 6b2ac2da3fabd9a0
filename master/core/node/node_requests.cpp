#include "master/core/node/node_requests.hpp"

#include <algorithm>
#include <span>

namespace takt {
namespace {

constexpr Time transfer_look = std::chrono::milliseconds{20};

}  // namespace

void NodeRequests::follow(SdoClient& client, NodeStatus& status, Time now) noexcept {
  if (!active()) return;
  if (active_->request.transfer != nullptr) {
    follow_transfer(*active_->request.transfer, client, now);
  }
  if (const auto result = client.take_result()) answer(*result, client, status);
}

/// Publishes the progress of a transfer, and cancels it if its sender asks for that.
void NodeRequests::follow_transfer(SdoTransfer& transfer, SdoClient& client, Time now) noexcept {
  transfer.done.store(static_cast<std::uint32_t>(client.progress()), std::memory_order_relaxed);
  transfer.announced.store(static_cast<std::uint32_t>(client.announced()),
                           std::memory_order_relaxed);
  if (transfer.cancel.load(std::memory_order_relaxed)) client.cancel();
  next_look_ = now + transfer_look;
}

void NodeRequests::answer(const SdoResult& result, const SdoClient& client,
                          NodeStatus& status) noexcept {
  if (result.fault == SdoFault::aborted_by_device) ++status.sdo_aborts;
  const bool upload = active_->request.kind == RequestKind::sdo_upload;
  SdoTransfer* const transfer = active_->request.transfer;
  if (transfer != nullptr) {
    transfer->done.store(static_cast<std::uint32_t>(result.size), std::memory_order_relaxed);
  }
  if (result.fault == SdoFault::timeout) {
    active_->silence = {.late = client.lateness(), .answered = client.answered()};
  }
  const bool carries = upload && transfer == nullptr && result.fault == SdoFault::none;
  table_->answer(*active_, result.fault, result.abort_code, carries ? result.size : 0);
  forget();
}

void NodeRequests::begin_next(SdoClient& client, Time now) noexcept {
  if (!client.idle() || !activate_next()) return;
  Request& request = active_->request;
  const Time timeout =
      request.timeout > Time{} ? request.timeout : plan_->sdo_timeout_of(request.object);
  SdoTransfer* const transfer = request.transfer;
  const bool upload = request.kind == RequestKind::sdo_upload;
  if (transfer != nullptr) {
    next_look_ = now + transfer_look;
    if (upload) return client.upload(request.object, transfer->data, timeout, SdoMode::block);
    return client.download(request.object, transfer->data, timeout);
  }
  if (upload) return client.upload(request.object, request.data, timeout);
  const std::size_t size = std::min<std::size_t>(request.size, request.data.size());
  client.download(request.object, std::span{request.data}.first(size), timeout);
}

/// Activates the next request. Requests that were cancelled while they waited are answered at
/// once.
bool NodeRequests::activate_next() noexcept {
  for (;;) {
    active_ = table_->next(plan_->id.value());
    if (!active()) return false;
    const SdoTransfer* const transfer = active_->request.transfer;
    if (transfer == nullptr || !transfer->cancel.load(std::memory_order_relaxed)) return true;
    table_->answer(*active_, SdoFault::cancelled);
  }
}

bool NodeRequests::withdraw(std::uint64_t id, SdoClient& client, NodeStatus& status) noexcept {
  if (!active() || active_->request.id != id || client.begun()) return false;
  client.cancel();
  if (const auto result = client.take_result()) answer(*result, client, status);
  return true;
}

void NodeRequests::cancel() noexcept {
  if (!active()) return;
  table_->answer(*active_, SdoFault::cancelled);
  forget();
}

void NodeRequests::forget() noexcept {
  active_ = nullptr;
  next_look_ = never;
}

}  // namespace takt
