#pragma once
#include <vector>

#include "master/sim/model/model.hpp"

namespace takt::sim {

/// An I/O module: digital (0x6000, 0x6200) and analogue (0x6401, 0x6411) channels. Inputs change in
/// a pattern that depends on the seed, or repeat the outputs if the device has the quirk
/// "loopback". CiA 401.
class Io401 : public Model {
 public:
  Io401(ObjectStore& store, EmcyProducer& emcy, Random random, bool loopback);

  void reset(Time now) noexcept override;
  void advance(Time now) noexcept override;
  void outputs(Time now) noexcept override;
  /// Sets the outputs to their error values (0x6206 and 0x6207, 0x6443 and 0x6444).
  void connection_lost(Time now) noexcept override;
  Time next_change() const noexcept override { return loopback_ ? never : next_change_; }

 private:
  struct Channel {
    Object* input = nullptr;
    const Object* output = nullptr;
  };

  void change_an_input() noexcept;
  void repeat_outputs() noexcept;

  ObjectStore& store_;
  Random random_;
  bool loopback_;
  std::vector<Channel> digital_;
  std::vector<Channel> analogue_;
  Time next_change_ = never;
};

}  // namespace takt::sim
