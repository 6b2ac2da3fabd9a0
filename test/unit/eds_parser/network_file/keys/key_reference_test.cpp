#include "eds_parser/network_file/keys/key_reference.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/network_file/keys/read_network.hpp"

namespace takt {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::vector<KeySection> all_sections() {
  std::vector<KeySection> all = network_file_keys();
  for (KeySection& section : device_data_keys()) all.push_back(std::move(section));
  return all;
}

TEST(KeyReference, EachKeySaysWhatASchemaNeeds) {
  for (const KeySection& section : all_sections()) {
    for (const KeyText& key : section.keys) {
      const std::string what = section.name + ": " + std::string{key.name};
      const KeyType type = key.value.type;
      EXPECT_FALSE(key.name.empty()) << what;
      EXPECT_FALSE(key.meaning.empty()) << what;
      if (type == KeyType::foreign) continue;
      EXPECT_TRUE(key.required || !key.otherwise.empty()) << what << " has no default";
      EXPECT_EQ(key.meaning.back(), '.') << what;
      EXPECT_TRUE(type != KeyType::word || !key.value.words.empty()) << what;
      EXPECT_TRUE(type != KeyType::map || key.value.parts != nullptr) << what;
      EXPECT_TRUE(type != KeyType::integer || key.value.range.low < key.value.range.high) << what;
    }
  }
}

TEST(KeyReference, NoSectionHasAKeyTwice) {
  for (const KeySection& section : all_sections()) {
    std::vector<std::string_view> names;
    for (const KeyText& key : section.keys) names.push_back(key.name);
    std::ranges::sort(names);
    EXPECT_EQ(std::ranges::adjacent_find(names), names.end()) << section.name;
  }
}

TEST(KeyReference, PrintsRangeUnitDefaultAndOriginOfAKey) {
  EXPECT_THAT(key_reference(network_file_keys()),
              AllOf(HasSubstr("<!-- keys: master -->\n| key | value | default | meaning |\n"),
                    HasSubstr("| `boot_time` | 0..3600000 ms | 0 | "),
                    HasSubstr("| `sync_cob_id` *takt* | 0x001..0x7FF | 0x80 | "),
                    HasSubstr("| `on_sync_loss` *takt* | `hold`, `fallback`, `stop` | "),
                    HasSubstr("| `cob_id` | `auto` or 0..0xFFFFFFFF | from the EDS | "),
                    HasSubstr("| `namespace`, `remappings` | any | none | No effect: ")));
  EXPECT_THAT(key_reference(device_data_keys()),
              AllOf(HasSubstr("<!-- keys: entry -->\n"), Not(HasSubstr("*takt*")),
                    HasSubstr("| `match` | `none` or list | required | "),
                    HasSubstr("| `value` | -2147483648..4294967295 | required | ")));
}

TEST(KeyReference, AMessageHasTheRangeOfTheReference) {
  Findings findings;
  read_network("master: {sync_cob_id: 0x800}\nnodes: {a: {node_id: 1, dcf: a.eds}}\n", "net.yaml",
               findings);

  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(to_string(findings[0]),
            "net.yaml:1:23: error: `sync_cob_id`: `0x800` is outside 0x001..0x7FF [out-of-range]");
}

TEST(KeyReference, TheMeaningIsThatOfTheSection) {
  EXPECT_THAT(std::string{key_meaning("master", "node_id")}, HasSubstr("of the master"));
  EXPECT_EQ(key_meaning("arm", "node_id"), "The node id.");
  EXPECT_THAT(std::string{key_meaning("arm", "num_channels")}, HasSubstr("every mapped object"));
  EXPECT_EQ(key_meaning("arm", "gearbox_ratio"), "");
}

}  // namespace
}  // namespace takt
