#include "master/explain/boot_report.hpp"
#include "test/unit/master/core/node/boot_rig.hpp"

// If a device answers wrongly instead of keeping silent, the report names what it does.

namespace takt {
namespace {

using OddAnswers = Boot;

/// Makes steps that read the identity of node 5.
Steps identity_steps() {
  Steps steps;
  steps.object(BootAction::expect, 'C', {0x1000, 0}, bytes({0x92, 0x01, 0x02, 0x00}))
      .object(BootAction::expect, 'D', {0x1018, 1}, bytes({0x5A, 0x01, 0x00, 0x00}))
      .object(BootAction::expect, 'M', {0x1018, 2}, bytes({0x01, 0x00, 0x00, 0x00}))
      .object(BootAction::expect, 'N', {0x1018, 3}, bytes({0x02, 0x00, 0x01, 0x00}))
      .object(BootAction::expect, 'O', {0x1018, 4}, bytes({0x2A, 0x00, 0x00, 0x00}));
  return steps;
}

TEST_F(OddAnswers, LateOnesAreReportedWithTheirTimeAndTheKey) {
  prepare = [](FakeNode& node) {
    node.latency = 120ms;  // the time-out is 100 ms
    node.answers_in_turn = true;
  };
  boot(identity_steps(), 5s);
  EXPECT_EQ(failure().fault, SdoFault::timeout);
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  EXPECT_NE(text.find("the device answers after "), std::string::npos) << text;
  EXPECT_NE(text.find("raise `sdo_timeout_ms` of this node, which is 100 ms now"),
            std::string::npos)
      << text;
  EXPECT_EQ(count(EventKind::duplicate_node), 0);
}

TEST_F(OddAnswers, AnAnswerToTheSubIndexNextToItIsReportedAsThat) {
  prepare = [](FakeNode& node) {
    node.tamper = [](Frame& frame) {
      if (frame.data[1] == 0x18 && frame.data[3] == 1) frame.data[3] = 2;
    };
  };
  boot(identity_steps(), 5s);
  EXPECT_EQ(failure().letter, 'D');
  EXPECT_EQ(failure().fault, SdoFault::timeout);
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  EXPECT_NE(text.find("the device answers with 1018:02 where 1018:01 was requested"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("585  43 18 10 02"), std::string::npos) << "the frame is shown\n" << text;
  EXPECT_EQ(count(EventKind::duplicate_node), 0);
}

TEST_F(OddAnswers, AnswersToAnotherSubIndexAreNoSecondNodeHoweverMany) {
  prepare = [](FakeNode& node) {
    node.tamper = [&node](Frame& frame) {
      Frame more = frame;
      more.data[3] = static_cast<std::uint8_t>(more.data[3] + 0x10);
      for (int i = 0; i < 4; ++i) node.sending.push_back({10s + 1ms, more});
    };
  };
  boot(identity_steps(), 2s);
  EXPECT_EQ(count(EventKind::duplicate_node), 0);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(OddAnswers, AWrongCommandSpecifierIsAbortedAtOnce) {
  prepare = [](FakeNode& node) {
    node.tamper = [](Frame& frame) {
      if (frame.data[1] == 0x18) frame.data[0] = 0x60;  // as if it had been a download
    };
  };
  boot(identity_steps(), 90ms);  // less than one time-out
  EXPECT_EQ(failure().fault, SdoFault::aborted_by_master);
  EXPECT_EQ(failure().abort_code, 0x0504'0001U);
  EXPECT_TRUE(std::ranges::count(sent, tx({0x80, 0x18, 0x10, 0x01, 0x01, 0x00, 0x04, 0x05})));
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  EXPECT_NE(text.find("the answer has a command specifier that does not belong to the request"),
            std::string::npos)
      << text;
}

TEST_F(OddAnswers, SegmentsWithoutTheirBeginningAreAbortedAtOnce) {
  prepare = [](FakeNode& node) {
    node.tamper = [](Frame& frame) {
      if (frame.data[1] == 0x18) frame.data[0] = 0x00;
    };
  };
  boot(identity_steps(), 90ms);
  EXPECT_EQ(failure().abort_code, 0x0504'0001U);
}

TEST_F(OddAnswers, AToggleBitThatStandsStillIsTheCauseThatIsReported) {
  prepare = [](FakeNode& node) {
    node.objects[{0x1008, 0}] = bytes({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
    node.tamper = [](Frame& frame) {
      if ((frame.data[0] & 0xE0) == 0) frame.data[0] &= 0xEF;
    };
  };
  Steps steps;
  steps.object(BootAction::expect, 'J', {0x1008, 0},
               bytes({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  boot(std::move(steps), 5s);
  EXPECT_EQ(failure().fault, SdoFault::aborted_by_master);
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  EXPECT_NE(text.find("the master aborted with 0503 0000"), std::string::npos) << text;
  EXPECT_NE(text.find("the device does not alternate the toggle bit of its segments"),
            std::string::npos)
      << text;
}

TEST_F(OddAnswers, ALostAnswerBeforeASilentObjectIsNotTakenForSlowness) {
  prepare = [](FakeNode& node) {
    node.loses = [first = true](const Frame& frame) mutable {
      if (frame.data[1] != 0x18) return false;
      if (frame.data[3] == 4) return true;  // this object never answers
      return frame.data[3] == 2 && std::exchange(first, false);
    };
  };
  boot(identity_steps(), 5s);
  EXPECT_EQ(failure().fault, SdoFault::timeout);
  EXPECT_EQ(failure().letter, 'O');
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  EXPECT_EQ(text.find("raise `sdo_timeout_ms`"), std::string::npos) << text;
}

// The time-out is 100 ms. The last late answer comes 200 ms before the boot fails.
TEST_F(OddAnswers, SilenceAfterOneLateAnswerIsReportedAsSilence) {
  prepare = [](FakeNode& node) {
    node.heartbeats(10s, 20ms);
    node.tamper = [&node, answers = 0](Frame& frame) mutable {
      const bool late = frame.data[1] == 0x18 && frame.data[3] == 2 && answers++ < 2;
      node.latency = late ? 170ms : 1ms;
    };
    node.loses = [](const Frame& frame) { return frame.data[1] == 0x18 && frame.data[3] == 4; };
  };
  boot(identity_steps(), 5s);
  EXPECT_EQ(failure().fault, SdoFault::timeout);
  EXPECT_EQ(failure().letter, 'O');
  EXPECT_GE(failure().late, 170ms);
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  const auto silence = text.find("its SDO server does not answer");
  const auto late = text.find("Before that, the device has answered a request after 17");
  EXPECT_NE(late, std::string::npos) << text;
  EXPECT_LT(silence, late) << text;
  EXPECT_NE(text.find("raise `sdo_timeout_ms` of this node, too, which is 100 ms now"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("the device answers after"), std::string::npos) << text;
}

TEST_F(OddAnswers, AnEmptyFrameIsNoSilence) {
  prepare = [](FakeNode& node) {
    node.tamper = [](Frame& frame) {
      if (frame.data[1] != 0x18) return;
      frame.length = 0;
      frame.data = {};
    };
  };
  boot(identity_steps(), 5s);
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  EXPECT_NE(text.find("585  an empty frame, then nothing within 100 ms"), std::string::npos)
      << text;
  EXPECT_NE(text.find("the device answers with an empty frame instead of 8 bytes: its SDO server "
                      "is faulty"),
            std::string::npos)
      << text;
}

TEST_F(OddAnswers, FramesWithTooFewBytesAreNamed) {
  prepare = [](FakeNode& node) {
    node.tamper = [](Frame& frame) {
      if (frame.data[1] == 0x18) frame.length = 4;
    };
  };
  boot(identity_steps(), 5s);
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  EXPECT_NE(text.find("the device answers with 4 bytes instead of 8"), std::string::npos) << text;
  EXPECT_NE(text.find("585  43 18 10 01, then"), std::string::npos) << text;
  EXPECT_EQ(text.find("raise"), std::string::npos) << text;
}

TEST_F(OddAnswers, AnAnswerForObjectZeroIsNoSilence) {
  prepare = [](FakeNode& node) {
    node.tamper = [](Frame& frame) {
      if (frame.data[1] == 0x18) frame.data[1] = frame.data[2] = frame.data[3] = 0;
    };
  };
  boot(identity_steps(), 5s);
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  EXPECT_NE(text.find("the device answers with 0000:00 where 1018:01 was requested"),
            std::string::npos)
      << text;
}

/// Makes steps that read a value of 26 bytes.
Steps long_value_steps(BootAction action) {
  Steps steps;
  FakeNode::Bytes text(26, std::byte{'a'});
  if (action == BootAction::expect) text.back() = std::byte{'b'};
  steps.object(action, 'J', {0x2200, 0}, text);
  return steps;
}

TEST_F(OddAnswers, SegmentsThatComeLateAreReportedAsLate) {
  prepare = [](FakeNode& node) {
    node.objects[{0x2200, 0}] = FakeNode::Bytes(26, std::byte{'a'});
    node.tamper = [&node](Frame& frame) {  // the time-out is 100 ms
      node.latency = (frame.data[0] & 0xE0) == 0 ? 180ms : 1ms;
    };
  };
  boot(long_value_steps(BootAction::expect), 5s);
  const std::string text = describe(plan, *find(EventKind::boot_failed));
  EXPECT_NE(text.find("the device answers after 180 ms: raise `sdo_timeout_ms`"), std::string::npos)
      << text;
  EXPECT_EQ(text.find("toggle"), std::string::npos) << text;
}

TEST_F(OddAnswers, AnInitiateInAnswerToASegmentIsNoSilence) {
  for (const std::uint8_t command : {std::uint8_t{0x43}, std::uint8_t{0x60}}) {
    for (const BootAction action : {BootAction::expect, BootAction::write}) {
      NetworkRig rig;
      rig.add(5, long_value_steps(action).plan);
      rig.device().objects[{0x2200, 0}] = FakeNode::Bytes(26, std::byte{'a'});
      if (action == BootAction::write) rig.device().read_aborts[{0x2200, 0}] = 0x06010001;
      rig.device().tamper = [command](Frame& frame) {
        const bool segment = (frame.data[0] & 0xE0) == 0x00 || (frame.data[0] & 0xE0) == 0x20;
        if (segment) frame = rx({command});
      };
      rig.start();
      rig.run(90ms);  // less than one time-out
      const Event* event = rig.find(EventKind::boot_failed);
      ASSERT_NE(event, nullptr) << int{command};
      EXPECT_EQ(event->failure.fault, SdoFault::aborted_by_master);
      const std::string text = describe(rig.plan, *event);
      EXPECT_NE(text.find("the answer has a command specifier that does not belong"),
                std::string::npos)
          << text;
    }
  }
}

TEST_F(OddAnswers, AFrameThatCanRepeatsIsNoWrongAnswer) {
  prepare = [](FakeNode& node) {
    node.objects[{0x2000, 0}] = bytes({1});
    node.tamper = [&node](Frame& frame) { node.sending.push_back({node.busy_until, frame}); };
  };
  Steps steps;
  steps.object(BootAction::write, 'J', {0x2000, 0}, bytes({5}))
      .object(BootAction::verify, 'J', {0x2000, 0}, bytes({5}))
      .object(BootAction::write, 'J', {0x2000, 0}, bytes({6}));
  boot(std::move(steps), 3s);
  EXPECT_EQ(status().boot, BootState::ready);
}

}  // namespace
}  // namespace takt
