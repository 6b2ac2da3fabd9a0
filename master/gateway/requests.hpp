#pragma once
#include <cstdint>
#include <deque>
#include <expected>
#include <functional>
#include <optional>
#include <string>
#include <takt/reply_t.hpp>
#include <takt/request_t.hpp>
#include <unordered_map>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/request.hpp"

namespace takt {

struct RequestsOptions {
  std::int64_t session = 0;
  bool observe = false;
};

/// request_t -> Request, Reply -> reply_t: each request gets exactly one answer, a repeated one
/// (same sender and id) none. Front thread.
class Requests {
 public:
  /// `submit` hands a request to the bus thread; false: it has too many.
  Requests(const BusPlan& plan, RequestsOptions options,
           std::function<bool(const Request&)> submit);

  /// An answer that can be given at once (refused); none: it comes later, or never for a repeat.
  std::optional<reply_t> take(const request_t& message);
  /// The answer to whoever asked; none: nobody did.
  std::optional<reply_t> finish(const Reply& reply);

  std::size_t pending() const noexcept { return pending_.size(); }

 private:
  struct Asker {
    std::string sender;
    std::int64_t id = 0;
    RequestKind kind = RequestKind::sdo_upload;
    bool operator==(const Asker& other) const noexcept {
      return id == other.id && sender == other.sender;
    }
  };

  std::expected<Request, std::string> translate(const request_t& message) const;
  std::expected<Request, std::string> translate_nmt(const request_t& message) const;
  std::expected<Request, std::string> translate_sdo(const request_t& message) const;
  std::expected<Request, std::string> translate_pdo(const request_t& message) const;
  static std::expected<Request, std::string> translate_lss(const request_t& message);
  bool seen_before(const Asker& asker);
  reply_t reply_to(const Asker& asker) const;

  const BusPlan& plan_;
  RequestsOptions options_;
  std::function<bool(const Request&)> submit_;
  std::uint64_t next_id_ = 1;
  std::unordered_map<std::uint64_t, Asker> pending_;
  std::deque<Asker> recent_;
};

/// Why an LSS request failed, in words: of the last of its results.
std::string lss_fault_text(const Reply& reply);

/// Why an SDO transfer or a command failed, in words; empty where it did not.
std::string fault_text(SdoFault fault, std::uint32_t abort_code);

}  // namespace takt
