#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <sys/socket.h>

namespace takt {

/// Buffers for recvmmsg and sendmmsg of equal records, prepared once; each batch then takes one
/// system call. The object holds pointers into itself, so it cannot move.
template <class Record, std::size_t N, std::size_t ControlBytes>
class MessageBatch {
 public:
  MessageBatch() noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      vectors_[i] = {.iov_base = &records_[i], .iov_len = sizeof(Record)};
      headers_[i].msg_hdr.msg_iov = &vectors_[i];
      headers_[i].msg_hdr.msg_iovlen = 1;
      prepare(i);
    }
  }
  MessageBatch(const MessageBatch&) = delete;
  MessageBatch& operator=(const MessageBatch&) = delete;

  static constexpr std::size_t capacity = N;

  Record& record(std::size_t i) noexcept { return records_[i]; }
  msghdr& header(std::size_t i) noexcept { return headers_[i].msg_hdr; }
  std::size_t bytes(std::size_t i) const noexcept { return headers_[i].msg_len; }

  /// Takes at most `limit` messages without waiting. Returns -1 on failure, with the reason in
  /// errno.
  int receive(int fd, std::size_t limit) noexcept {
    const std::size_t count = std::min(limit, N);
    for (std::size_t i = 0; i < dirty_; ++i) prepare(i);
    const int got =
        recvmmsg(fd, headers_.data(), static_cast<unsigned>(count), MSG_DONTWAIT, nullptr);
    dirty_ = got > 0 ? static_cast<std::size_t>(got) : 1;
    return got;
  }

  /// Sends records [first, first + count) without waiting. Returns -1 on failure, with the reason
  /// in errno.
  int send(int fd, std::size_t first, std::size_t count) noexcept {
    return sendmmsg(fd, &headers_[first], static_cast<unsigned>(count),
                    MSG_DONTWAIT | MSG_NOSIGNAL);
  }

  /// Sends all items without waiting; `fill(record, item)` makes a record of an item. Returns the
  /// number of items that were sent. If not all were sent, the reason is in errno.
  template <class Item, class Fill>
  std::size_t send_all(int fd, std::span<const Item> items, Fill fill) noexcept {
    std::size_t sent = 0;
    while (sent < items.size()) {
      const std::size_t count = std::min(items.size() - sent, N);
      for (std::size_t i = 0; i < count; ++i) fill(records_[i], items[sent + i]);
      for (std::size_t done = 0; done < count;) {
        const int taken = send(fd, done, count - done);
        if (taken <= 0) return sent;
        done += static_cast<std::size_t>(taken);
        sent += static_cast<std::size_t>(taken);
      }
    }
    return sent;
  }

 private:
  void prepare(std::size_t i) noexcept {
    if constexpr (ControlBytes > 0) {
      headers_[i].msg_hdr.msg_control = controls_[i].data();
      headers_[i].msg_hdr.msg_controllen = ControlBytes;
    }
  }

  struct alignas(cmsghdr) Control : std::array<std::byte, std::max<std::size_t>(ControlBytes, 1)> {
  };
  std::array<Record, N> records_{};
  std::array<iovec, N> vectors_{};
  std::array<mmsghdr, N> headers_{};
  std::array<Control, ControlBytes == 0 ? 1 : N> controls_{};
  std::size_t dirty_ = 0;  // headers changed by the kernel since they were prepared
};

}  // namespace takt
