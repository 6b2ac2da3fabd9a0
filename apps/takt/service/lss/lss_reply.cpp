#include "apps/takt/service/lss/lss_reply.hpp"

#include <fmt/format.h>

namespace takt {

std::expected<std::vector<LssResult>, std::string> lss_results(
    std::span<const std::byte> reply, std::span<const LssCommand> commands) {
  const auto refuse = [&](const char* why) {
    return std::unexpected{fmt::format("sent a reply of {} bytes to {} LSS services: {}",
                                       reply.size(), commands.size(), why)};
  };
  if (reply.size() % lss_result_bytes != 0) return refuse("its last result is incomplete");
  std::vector<LssResult> results;
  for (std::size_t at = 0; at < reply.size(); at += lss_result_bytes) {
    if (results.size() == commands.size()) return refuse("it has too many results");
    if (!results.empty() && results.back().outcome != LssOutcome::done) {
      return refuse("a result follows that of a service that failed");
    }
    const auto result = unpack_lss_result(reply.subspan(at).first<lss_result_bytes>());
    if (result.op != commands[results.size()].op) return refuse("a result is of another service");
    results.push_back(result);
  }
  const bool failed = !results.empty() && results.back().outcome != LssOutcome::done;
  if (results.size() < commands.size() && !failed) return refuse("it has too few results");
  return results;
}

}  // namespace takt
