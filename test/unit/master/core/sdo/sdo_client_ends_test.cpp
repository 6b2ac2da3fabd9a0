// Each transfer of the SDO client ends at each of its frames: by the server, by the master, or by
// silence.
#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "master/core/sdo/sdo_client.hpp"
#include "test/unit/master/core/script.hpp"

namespace takt {
namespace {

/// The number of frames that the client sends, and the answers of the server; there may be several
/// of each.
struct Exchange {
  int sent = 1;
  std::vector<Frame> answers;
};

struct Transfer {
  std::string name;
  bool upload = true;
  std::size_t size = 0;  ///< size of a download
  SdoMode mode = SdoMode::plain;
  std::vector<Exchange> exchanges;
};

constexpr ObjectKey object{0x2010, 1};

std::vector<Transfer> transfers() {
  std::vector<Transfer> all;
  all.push_back({.name = "expedited upload",
                 .exchanges = {{.answers = {rx({0x43, 0x10, 0x20, 0x01, 1, 2, 3, 4})}}}});
  all.push_back({.name = "segmented upload",
                 .exchanges = {{.answers = {rx({0x41, 0x10, 0x20, 0x01, 0x09})}},
                               {.answers = {rx({0x00, 1, 2, 3, 4, 5, 6, 7})}},
                               {.answers = {rx({0x1B, 8, 9})}}}});
  all.push_back({.name = "expedited download",
                 .upload = false,
                 .size = 4,
                 .exchanges = {{.answers = {rx({0x60, 0x10, 0x20, 0x01})}}}});
  all.push_back({.name = "segmented download",
                 .upload = false,
                 .size = 20,
                 .exchanges = {{.answers = {rx({0x60, 0x10, 0x20, 0x01})}},
                               {.answers = {rx({0x20})}},
                               {.answers = {rx({0x30})}},
                               {.answers = {rx({0x20})}}}});
  all.push_back({.name = "block download",
                 .upload = false,
                 .size = 140,
                 .exchanges = {{.answers = {rx({0xA4, 0x10, 0x20, 0x01, 0x0A})}},
                               {.sent = 10, .answers = {rx({0xA2, 0x0A, 0x0A})}},
                               {.sent = 10, .answers = {rx({0xA2, 0x0A, 0x0A})}},
                               {.answers = {rx({0xA1})}}}});
  all.push_back({.name = "block upload",
                 .mode = SdoMode::block,
                 .exchanges = {{.answers = {rx({0xC2, 0x10, 0x20, 0x01, 0x09})}},
                               {.answers = {rx({0x01, 1, 2, 3, 4, 5, 6, 7}), rx({0x82, 8, 9})}},
                               {.answers = {rx({0xD5})}}}});
  return all;
}

class SdoClientEnds : public testing::TestWithParam<std::size_t> {
 protected:
  /// The point at which a transfer is ended, given by the number of frames of the client and of the
  /// server.
  struct Point {
    std::size_t exchange = 0;
    int sent = 0;
    std::size_t answers = 0;
  };

  void begin() {
    client = SdoClient{5_node};
    value_.assign(transfer.size, std::byte{0x55});
    if (transfer.upload) return client.upload(object, buffer_, 500ms, transfer.mode);
    client.download(object, value_, 500ms);
  }
  std::vector<Frame> sends() {
    Outbox out;
    client.on_time(now, out);
    return {out.frames().begin(), out.frames().end()};
  }
  /// Runs the transfer to a point. Returns false if the point is the end of the transfer.
  bool run_to(const Point& point) {
    begin();
    for (std::size_t i = 0; i <= point.exchange; ++i) {
      const Exchange& exchange = transfer.exchanges[i];
      const bool whole = i < point.exchange;
      for (int k = 0; k < (whole ? exchange.sent : point.sent); ++k) {
        EXPECT_EQ(sends().size(), 1U);
      }
      const std::size_t heard = whole ? exchange.answers.size() : point.answers;
      for (std::size_t k = 0; k < heard; ++k) client.on_frame(exchange.answers[k], now);
    }
    const auto result = client.take_result();
    EXPECT_TRUE(!result || result->fault == SdoFault::none);
    return !result;
  }
  std::vector<Point> points() const {
    std::vector<Point> all;
    for (std::size_t i = 0; i < transfer.exchanges.size(); ++i) {
      const Exchange& exchange = transfer.exchanges[i];
      for (int k = 0; k < exchange.sent; ++k) all.push_back({.exchange = i, .sent = k});
      for (std::size_t k = 0; k < exchange.answers.size(); ++k) {
        all.push_back({.exchange = i, .sent = exchange.sent, .answers = k});
      }
    }
    return all;
  }
  /// True if the client has sent all its frames for now.
  bool waits(const Point& point) const {
    return point.sent == transfer.exchanges[point.exchange].sent;
  }
  bool in_burst(const Point& point) const { return point.sent != 0 && !waits(point); }

  /// Checks that the next transfer works even if frames of the old one come late.
  void works_again(const Point& point) {
    EXPECT_TRUE(client.idle());
    EXPECT_TRUE(sends().empty());
    std::array<std::byte, 4> small{};
    client.upload({0x1018, 1}, small, 500ms);
    EXPECT_EQ(sends(), std::vector{tx({0x40, 0x18, 0x10, 0x01})});
    const Exchange& late = transfer.exchanges[point.exchange];
    if (transfer.mode == SdoMode::plain && transfer.size <= 20) {
      for (std::size_t k = point.answers; k < late.answers.size(); ++k) {
        client.on_frame(late.answers[k], now);
      }
    }
    client.on_frame(rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00}), now);
    const auto result = client.take_result();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->fault, SdoFault::none);
    EXPECT_EQ(small[0], std::byte{0x5A});
  }
  std::string at(const Point& point) const {
    return transfer.name + ", exchange " + std::to_string(point.exchange) + ", " +
           std::to_string(point.sent) + " sent, " + std::to_string(point.answers) + " heard";
  }

  Transfer transfer = transfers()[GetParam()];
  Time now = 1s;
  SdoClient client{5_node};

 private:
  std::array<std::byte, 64> buffer_{};
  std::vector<std::byte> value_;
};

TEST_P(SdoClientEnds, ByAnAbortOfTheServerWhereverItMaySayOne) {
  for (const Point& point : points()) {
    if (!waits(point) && !in_burst(point)) continue;
    SCOPED_TRACE(at(point));
    ASSERT_TRUE(run_to(point));

    client.on_frame(rx({0x80, 0x10, 0x20, 0x01, 0x00, 0x00, 0x06, 0x06}), now);
    now += 20ms;  // refused segments may still be in transit
    EXPECT_TRUE(sends().empty());

    const auto result = client.take_result();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->fault, SdoFault::aborted_by_device);
    EXPECT_EQ(result->abort_code, 0x0606'0000U);
    works_again({.exchange = point.exchange, .sent = point.sent, .answers = 99});
  }
}

TEST_P(SdoClientEnds, ByTheMasterAtAnyTime) {
  const Frame abort = tx({0x80, 0x10, 0x20, 0x01, 0x00, 0x00, 0x00, 0x08});
  for (const Point& point : points()) {
    SCOPED_TRACE(at(point));
    ASSERT_TRUE(run_to(point));

    client.cancel();

    const auto result = client.take_result();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->fault, SdoFault::cancelled);
    const bool begun = point.exchange != 0 || point.sent != 0;
    EXPECT_EQ(sends(), begun ? std::vector{abort} : std::vector<Frame>{});
    works_again(point);
  }
}

TEST_P(SdoClientEnds, BySilenceWhereverItWaits) {
  const Frame abort = tx({0x80, 0x10, 0x20, 0x01, 0x00, 0x00, 0x04, 0x05});
  for (const Point& point : points()) {
    if (!waits(point)) continue;
    SCOPED_TRACE(at(point));
    ASSERT_TRUE(run_to(point));

    EXPECT_LE(client.deadline(), now + 500ms);
    now = client.deadline();
    std::vector<Frame> declared = sends();
    if (!declared.empty() &&
        declared[0].data[0] == 0xA2) {  // a block: received segments are confirmed
      EXPECT_EQ(client.deadline(), now + 500ms);
      now = client.deadline();
      declared = sends();
    }
    EXPECT_EQ(declared, std::vector{abort});
    const bool by_block = transfer.mode == SdoMode::block || transfer.size >= 128;
    if (by_block && point.exchange == 0 && point.answers == 0) {  // now by segments
      EXPECT_EQ(sends().size(), 1U);
      EXPECT_EQ(client.deadline(), now + 500ms);
      now = client.deadline();
      EXPECT_EQ(sends(), std::vector{abort});
    }

    const auto result = client.take_result();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->fault, SdoFault::timeout);
    works_again(point);
  }
}

INSTANTIATE_TEST_SUITE_P(Transfers, SdoClientEnds, testing::Range<std::size_t>(0, 6),
                         [](const auto& number) {
                           std::string name = transfers()[number.param].name;
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

}  // namespace
}  // namespace takt
