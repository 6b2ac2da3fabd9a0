#include <gtest/gtest.h>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

/// True for the findings about 0x640 and 0x5C0 plus node-ID, which are as in the manual of the
/// Lenze.
bool is_second_channel_of_a_lenze(const Finding& finding) {
  return finding.file.ends_with("lenze8400.eds") && finding.rule == "cob-id-restricted" &&
         finding.severity == Severity::warning && finding.message.starts_with("1201sub");
}

class ShareEds : public testing::TestWithParam<const char*> {};

TEST_P(ShareEds, IsWithoutAFinding) {
  const auto path = std::string{TAKT_SOURCE_DIR "/share/eds/"} + GetParam();
  for (const auto node :
       {std::optional<NodeId>{}, std::optional{1_node}, std::optional{127_node}}) {
    const auto file = read_eds_file(path, node);

    ASSERT_TRUE(file.readable);
    for (const auto& finding : file.findings) ADD_FAILURE() << to_string(finding);
    for (const auto& finding : check(file.dictionary)) {
      if (!is_second_channel_of_a_lenze(finding)) ADD_FAILURE() << to_string(finding);
    }
    EXPECT_EQ(describe_pdos(file.dictionary).size(),
              file.dictionary.device.nr_rx_pdo + file.dictionary.device.nr_tx_pdo);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ShareEds,
                         testing::Values("takt_drive402.eds", "takt_io401.eds",
                                         "takt_encoder406.eds", "lenze8400.eds", "beckhoff_io.eds",
                                         "plain301.eds", "astraada_drv28.eds"));

}  // namespace
}  // namespace takt
