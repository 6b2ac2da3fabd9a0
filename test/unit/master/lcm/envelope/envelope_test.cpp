#include "master/lcm/envelope/envelope.hpp"

#include <chrono>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

namespace takt {
namespace {

using namespace std::chrono_literals;
using Octets = std::vector<std::byte>;

Octets of_hex(std::string_view hex) {
  Octets bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoi(std::string{hex.substr(i, 2)}, nullptr, 16)));
  }
  return bytes;
}

/// 00 01 02 .. 1F.
EnvelopeKey a_key(std::string name = "plant") {
  EnvelopeKey key{.name = std::move(name)};
  for (std::size_t i = 0; i < key.secret.size(); ++i) key.secret[i] = static_cast<std::uint8_t>(i);
  return key;
}

constexpr Time made = 1'700'000'000s;
const Octets message = of_hex("deadbeef");

// Computed in Python, with the code of lcm-gen -p for envelope_t:
//   sealed = e.encode()[:-32]
//   hashlib.blake2b(sealed, key=bytes(range(32)), digest_size=32).hexdigest()
const Octets vector = of_hex(
    "81d9ff8685364ec1"                    // fingerprint of envelope_t
    "00060a24181e4000"                    // utime 1700000000000000
    "0001"                                // schema
    "000000000000002a"                    // session 42
    "0000000000000007"                    // instance 7
    "0000000000000001"                    // counter 1
    "00000006706c616e7400"                // key "plant"
    "0000000d4c4946545f434f4d4d414e4400"  // channel "LIFT_COMMAND"
    "00000004deadbeef"                    // data
    "b7bac327a2ff3970f3a9c12351b654f84aa79b11eb25eeac2d476950b4326daa");

Octets copy(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

class EnvelopeTest : public testing::Test {
 protected:
  EnvelopeTest() { guard.set_keys({a_key()}); }
  Octets sealed(Time wall = made) { return copy(seal.seal("LIFT_COMMAND", message, 42, wall)); }
  EnvelopeFault fault(Bytes bytes, Time wall = made) {
    const auto opened = guard.open(bytes, wall);
    EXPECT_FALSE(opened);
    return opened ? EnvelopeFault::damaged : opened.error();
  }

  EnvelopeSeal seal{a_key(), 7};
  EnvelopeGuard guard{42};
};

TEST_F(EnvelopeTest, HasTheBytesAndTheMacThatPythonComputes) { EXPECT_EQ(sealed(), vector); }

TEST_F(EnvelopeTest, IsOpenedWithTheSameKey) {
  const auto opened = guard.open(vector, made);
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->channel, "LIFT_COMMAND");
  EXPECT_EQ(opened->data, (std::vector<std::uint8_t>{0xDE, 0xAD, 0xBE, 0xEF}));
}

TEST_F(EnvelopeTest, AnyBitThatIsChangedSpoilsIt) {
  for (std::size_t bit = 0; bit < 8 * vector.size(); ++bit) {
    Octets altered = vector;
    altered[bit / 8] ^= std::byte{1} << (bit % 8);
    EXPECT_FALSE(guard.open(altered, made)) << bit;
  }
  EXPECT_TRUE(guard.open(vector, made)) << "nothing of them was remembered";
}

TEST_F(EnvelopeTest, IsForgedWithAnotherSecretOfTheSameName) {
  EnvelopeKey other = a_key();
  other.secret[31] ^= 1;
  EnvelopeSeal forger{other, 7};
  EXPECT_EQ(fault(forger.seal("LIFT_COMMAND", message, 42, made)), EnvelopeFault::forged);
}

TEST_F(EnvelopeTest, IsRefusedForAnotherSessionKeyOrTime) {
  EXPECT_EQ(fault(copy(seal.seal("LIFT_COMMAND", message, 43, made))),
            EnvelopeFault::other_session);
  EnvelopeSeal stranger{a_key("stranger"), 7};
  EXPECT_EQ(fault(stranger.seal("LIFT_COMMAND", message, 42, made)), EnvelopeFault::unknown_key);
  EXPECT_EQ(fault(sealed(), made + 1001ms), EnvelopeFault::too_old);
  EXPECT_EQ(fault(sealed(), made - 1001ms), EnvelopeFault::from_the_future);
  EXPECT_TRUE(guard.open(sealed(), made + 999ms));
}

TEST_F(EnvelopeTest, ComesOnceAndInOrder) {
  const Octets first = sealed();
  const Octets second = sealed();
  const Octets third = sealed();
  EXPECT_TRUE(guard.open(first, made));
  EXPECT_EQ(fault(first), EnvelopeFault::repeated);
  EXPECT_TRUE(guard.open(third, made));
  EXPECT_EQ(fault(second), EnvelopeFault::repeated) << "it was overtaken";
}

TEST_F(EnvelopeTest, CountersBelongToAnInstanceAndAKey) {
  guard.set_keys({a_key(), a_key("other")});
  EnvelopeSeal same_program_again{a_key(), 8};
  EnvelopeSeal other_key{a_key("other"), 7};
  sealed();
  EXPECT_TRUE(guard.open(sealed(), made));
  EXPECT_TRUE(guard.open(copy(same_program_again.seal("LIFT_COMMAND", message, 42, made)), made));
  EXPECT_TRUE(guard.open(copy(other_key.seal("LIFT_COMMAND", message, 42, made)), made));
}

TEST_F(EnvelopeTest, SendersAreBoundedAndForgottenOnlyWhenAllOfThemIsTooOld) {
  std::vector<EnvelopeSeal> seals;
  for (std::size_t i = 0; i < EnvelopeGuard::most_senders; ++i) {
    seals.emplace_back(a_key(), static_cast<std::int64_t>(i));
    EXPECT_TRUE(guard.open(copy(seals[i].seal("LIFT_COMMAND", message, 42, made)), made));
  }
  EnvelopeSeal one_more{a_key(), 1000};
  EXPECT_EQ(fault(one_more.seal("LIFT_COMMAND", message, 42, made)),
            EnvelopeFault::too_many_senders);
  EXPECT_TRUE(guard.open(copy(one_more.seal("LIFT_COMMAND", message, 42, made + 2s)), made + 2s));
}

TEST_F(EnvelopeTest, AKeyThatWasTakenAwayOpensNothingMore) {
  EXPECT_TRUE(guard.open(sealed(), made));
  guard.set_keys({a_key("new")});
  EXPECT_EQ(fault(sealed()), EnvelopeFault::unknown_key);
}

TEST_F(EnvelopeTest, SurvivesEveryLengthOfItself) {
  for (std::size_t size = 0; size < vector.size(); ++size) {
    EXPECT_EQ(fault(Bytes{vector}.first(size)), EnvelopeFault::damaged);
  }
  EXPECT_EQ(fault(Octets(EnvelopeGuard::most_bytes + 1)), EnvelopeFault::damaged);
}

}  // namespace
}  // namespace takt
