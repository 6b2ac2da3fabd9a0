#include "apps/takt/od/od_reader.hpp"

#include "apps/command_line/failure.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

constexpr int is_refusal = 1;  // exit code after a transfer that the device or the daemon refused

}  // namespace

void OdReader::read(OdEntry& entry) {
  if (!entry.why_unread.empty()) return;
  if (silent()) {
    entry.error = "no answer";
    return;
  }
  try {
    entry.value = upload_(entry.key);
    silences_ = 0;
  } catch (const Failure& failure) {
    if (failure.code != is_refusal) throw;
    const bool answered = failure.abort_code != 0 && failure.abort_code != abort_code::timeout;
    silences_ = answered ? 0 : silences_ + 1;
    entry.error = answered ? std::string{abort_text(failure.abort_code)} : failure.what();
  }
}

}  // namespace takt
