#include "master/explain/frame/error_frame_text.hpp"

#include <array>
#include <gtest/gtest.h>

#include "master/trace/candump_line.hpp"

namespace takt {
namespace {

/// Returns the text of an error frame in a line from `candump -L -e can0`.
std::string read(const char* text) {
  const auto line = parse_candump(text);
  if (!line || !line->error_frame) return "no error frame";
  return error_frame_text(line->frame.id.id(), line->frame.payload());
}

TEST(ErrorFrameText, ChangesOfTheControllersStateAreReported) {
  EXPECT_EQ(read("(1.0) can0 20000004#000C000000006000"),
            "receive errors reach the warning level, transmit errors reach the warning level; "
            "error counters: transmit 96, receive 0");
  EXPECT_EQ(read("(1.0) can0 20000204#0020000000008803"),
            "error-passive by transmit errors; error counters: transmit 136, receive 3");
  EXPECT_EQ(read("(1.0) can0 20000040#0000000000000000"),
            "BUS-OFF: the controller has left the bus");
  EXPECT_EQ(read("(1.0) can0 20000100#0000000000000000"), "the controller was restarted");
  EXPECT_EQ(read("(1.0) can0 20000004#0001000000000000"),
            "receive buffer overflow, frames lost; error counters: transmit 0, receive 0");
}

TEST(ErrorFrameText, ErrorsOfSingleFramesNameTheirPlace) {
  EXPECT_EQ(read("(1.0) can0 20000002#0B00000000000000"), "arbitration lost in bit 11");
  EXPECT_EQ(read("(1.0) can0 20000020#0000000000000000"),
            "no node acknowledged a frame (alone on the bus, or the wrong bit rate?)");
  EXPECT_EQ(read("(1.0) can0 20000088#00000408000000A0"),
            "protocol error: bit stuffing, in the CRC; bus error");
  EXPECT_EQ(read("(1.0) can0 20000008#0000800A00000000"),
            "protocol error: while sending, in the data");
}

TEST(ErrorFrameText, WhatIsCutShortOrUnknownIsNoHarm) {
  EXPECT_EQ(error_frame_text(0, {}), "error frame of the controller");
  EXPECT_EQ(error_frame_text(0x00000002, {}), "arbitration lost");
  EXPECT_EQ(error_frame_text(0x00000004, std::array<std::uint8_t, 1>{0x55}),
            "controller fault; error counters: transmit 0, receive 0");
}

TEST(ErrorFrameText, TheLineKeepsItsFlag) {
  EXPECT_EQ(to_string(*parse_candump("(1.0) can0 20000040#0000000000000000")),
            "(1.0)  can0  20000040   [8]  00 00 00 00 00 00 00 00");
}

}  // namespace
}  // namespace takt
