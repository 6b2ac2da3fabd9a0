#pragma once
#include <chrono>

namespace takt::test {

/// How long a test waits for what has to happen. It ends a test that would hang; on a machine that
/// is very busy what is waited for comes late, but long before this.
inline constexpr std::chrono::seconds patience{180};

}  // namespace takt::test
