#pragma once
#include <functional>
#include <gtest/gtest.h>
#include <map>

#include "test/unit/master/core/network/network_rig.hpp"

namespace takt {

class Boot : public testing::Test, public NetworkRig {
 protected:
  /// Boots node 5 with one plan. The device has the identity of a drive unless the test has changed
  /// `identity`.
  void boot(Steps steps, Time span = 5s) {
    add(5, std::move(steps.plan));
    for (const auto& [key, value] : identity) device().objects.try_emplace(key, value);
    if (prepare) prepare(device());
    start();
    run(span);
  }
  const BootFailure& failure() {
    const Event* event = find(EventKind::boot_failed);
    if (event == nullptr) {
      ADD_FAILURE() << "the boot did not fail";
      static const BootFailure none;
      return none;
    }
    return event->failure;
  }

  std::map<ObjectKey, FakeNode::Bytes> identity{
      {{0x1000, 0}, bytes({0x92, 0x01, 0x02, 0x00})},
      {{0x1018, 1}, bytes({0x5A, 0x01, 0x00, 0x00})},
      {{0x1018, 2}, bytes({0x01, 0x00, 0x00, 0x00})},
      {{0x1018, 3}, bytes({0x02, 0x00, 0x01, 0x00})},
      {{0x1018, 4}, bytes({0x2A, 0x00, 0x00, 0x00})},
      {{0x1800, 1}, bytes({0x85, 0x01, 0x00, 0x40})},
      {{0x1800, 2}, bytes({0xFF})},
      {{0x1A00, 0}, bytes({0x00})},
      {{0x1017, 0}, bytes({0x00, 0x00})},
  };
  std::function<void(FakeNode&)> prepare;
};

/// Steps that reconfigure TPDO1 of node 5 unless the PDO is already right.
inline Steps tpdo1() {
  Steps steps;
  steps.object(BootAction::compare, 'J', {0x1800, 1}, bytes({0x85, 0x01, 0x00, 0x40}))
      .object(BootAction::compare, 'J', {0x1A00, 0}, bytes({2}))
      .skip(9)
      .object(BootAction::disable_pdo, 'J', {0x1800, 1})
      .object(BootAction::write, 'J', {0x1A00, 0}, bytes({0}))
      .object(BootAction::write, 'J', {0x1A00, 1}, bytes({0x10, 0x00, 0x41, 0x60}))
      .object(BootAction::write, 'J', {0x1A00, 0}, bytes({2}))
      .object(BootAction::enable_pdo, 'J', {0x1800, 1}, bytes({0x85, 0x01, 0x00, 0x00}))
      .object(BootAction::verify, 'J', {0x1A00, 0}, bytes({2}));
  return steps;
}

}  // namespace takt
