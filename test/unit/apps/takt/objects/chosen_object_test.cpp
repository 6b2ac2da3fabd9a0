#include "apps/takt/objects/chosen_object.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/support/folder.hpp"

namespace takt {
namespace {

using testing::HasSubstr;

KnownDevice drive() { return device_of_eds(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds", {}); }

/// Returns the sentence of the Failure, or an empty text if the object was found.
std::string complaint(const KnownDevice& device, const std::string& word) {
  try {
    find_object(device, word);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code, exit_wrong_use);
    return failure.what();
  }
  return {};
}

TEST(ChosenObject, HasTheTypeOfTheDeviceFile) {
  const ChosenObject object = find_object(drive(), "statusword");

  EXPECT_EQ(object.key, (ObjectKey{0x6041, 0}));
  EXPECT_EQ(object.type, DataType::unsigned16);
  EXPECT_EQ(object.text(), "statusword (6041:00)");
}

TEST(ChosenObject, IsASignalOfTheLayoutWithoutADeviceFile) {
  const KnownDevice device{
      .name = "x",
      .signals = {{.name = "speed", .object = {0x2000, 3}, .type = DataType::integer16}}};

  EXPECT_EQ(find_object(device, "speed").key, (ObjectKey{0x2000, 3}));
  EXPECT_EQ(find_object(device, "speed").type, DataType::integer16);
  EXPECT_THAT(complaint(device, "sped"),
              HasSubstr("node 'x' has no object 'sped' (only the names of its signals"));
  EXPECT_THAT(complaint(device, "sped"), HasSubstr("--eds FILE"));
}

/// If only the second axis is mapped, the layout gives its statusword the plain name.
TEST(ChosenObject, IsAmbiguousIfLayoutAndDeviceFileDisagree) {
  KnownDevice device = drive();
  device.signals = {{.name = "statusword", .object = {0x6841, 0}}};

  EXPECT_THAT(complaint(device, "statusword"),
              HasSubstr("give the index of one of them: 6041:00 statusword, 6841:00"));
}

TEST(ChosenObject, IsAmbiguousIfSeveralEntriesHaveItsName) {
  EXPECT_THAT(complaint(drive(), "transmission_type"), HasSubstr("1400:02"));
  EXPECT_THAT(complaint(drive(), "highest_sub_index_supported"), HasSubstr(" more"));
}

TEST(ChosenObject, NumbersAreNoNames) {
  for (const char* const word : {"6041", "0x6041", "1018:1", "", ":", "10000:1", "-x", "DEAD"}) {
    EXPECT_FALSE(is_object_name(word)) << word;
  }
  for (const char* const word : {"statusword", "identity_object.vendor_id", "Target position"}) {
    EXPECT_TRUE(is_object_name(word)) << word;
  }
}

TEST(KnownDevice, OfANetworkFileHasItsSignalsAndPdos) {
  const KnownDevice device =
      device_of_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml", "elbow");

  EXPECT_EQ(device.name, "elbow");
  EXPECT_EQ(device.id->value(), 2);
  ASSERT_TRUE(device.dictionary);
  const auto target =
      std::ranges::find(device.signals, std::string{"target_position"}, &KnownSignal::name);
  ASSERT_NE(target, device.signals.end());
  EXPECT_EQ(target->pdo, "RPDO1");
  EXPECT_EQ(target->unit, "rad");
}

TEST(KnownDevice, OfANetworkFileWithoutTheNodeListsTheNodes) {
  try {
    device_of_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml", "elbw");
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("did you mean `elbow`?; the nodes are: 1 shoulder"));
  }
}

TEST(KnownDevice, OfAFileThatIsNoneIsAFailure) {
  const test::Folder folder;

  EXPECT_THROW(device_of_eds((folder / "none.eds").string(), {}), Failure);
  EXPECT_THROW(device_of_network((folder / "none.yaml").string(), "x"), Failure);
}

}  // namespace
}  // namespace takt
