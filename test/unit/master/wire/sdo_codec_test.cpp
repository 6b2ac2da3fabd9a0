#include "master/wire/sdo_codec.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace takt {
namespace {

// Literal frames: CiA 301 forms as recorded in the project's reference, node 5.
constexpr CobId request = CobId::base(0x605);
constexpr CobId answer = CobId::base(0x585);

SdoInitiate of(ObjectKey object, std::vector<std::uint8_t> bytes) {
  return sdo_initiate(object, std::span<const std::uint8_t>{bytes});
}

TEST(SdoCodec, WritesExpeditedDownloadsOfOneToFourBytes) {
  EXPECT_EQ(download_request(5_node, of({0x6060, 0}, {0x08})),
            make_frame(request, {0x2F, 0x60, 0x60, 0x00, 0x08, 0, 0, 0}));
  EXPECT_EQ(download_request(5_node, of({0x1017, 0}, {0xE8, 0x03})),
            make_frame(request, {0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03, 0, 0}));
  EXPECT_EQ(download_request(5_node, of({0x2000, 1}, {0x11, 0x22, 0x33})),
            make_frame(request, {0x27, 0x00, 0x20, 0x01, 0x11, 0x22, 0x33, 0}));
  EXPECT_EQ(download_request(5_node, of({0x1800, 1}, {0x85, 0x01, 0x00, 0x80})),
            make_frame(request, {0x23, 0x00, 0x18, 0x01, 0x85, 0x01, 0x00, 0x80}));
  EXPECT_EQ(download_request(5_node, of({0x1010, 1}, {0x73, 0x61, 0x76, 0x65})),
            make_frame(request, {0x23, 0x10, 0x10, 0x01, 0x73, 0x61, 0x76, 0x65}));
}

TEST(SdoCodec, WritesTheSegmentedDownloadOfTwentyBytes) {
  std::array<std::uint8_t, 20> value{};
  for (std::uint8_t i = 0; i < 20; ++i) value[i] = i;
  const std::span<const std::uint8_t> bytes{value};

  EXPECT_EQ(download_request(5_node, sdo_initiate({0x2001, 0}, bytes)),
            make_frame(request, {0x21, 0x01, 0x20, 0x00, 0x14, 0, 0, 0}));
  EXPECT_EQ(download_segment_request(5_node, sdo_segment(bytes, false)),
            make_frame(request, {0x00, 0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06}));
  EXPECT_EQ(download_segment_request(5_node, sdo_segment(bytes.subspan(7), true)),
            make_frame(request, {0x10, 0x07, 0x08, 0x09, 0x0A, 0x0B, 0x0C, 0x0D}));
  EXPECT_EQ(download_segment_request(5_node, sdo_segment(bytes.subspan(14), false)),
            make_frame(request, {0x03, 0x0E, 0x0F, 0x10, 0x11, 0x12, 0x13, 0x00}));
}

TEST(SdoCodec, WritesAnEmptyValueAsSizeZeroAndOneEmptySegment) {
  EXPECT_EQ(download_request(5_node, of({0x2001, 0}, {})),
            make_frame(request, {0x21, 0x01, 0x20, 0x00, 0, 0, 0, 0}));
  EXPECT_EQ(download_segment_request(5_node, sdo_segment(std::span<const std::byte>{}, false)),
            make_frame(request, {0x0F, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(SdoCodec, WritesUploadRequestsAndAborts) {
  EXPECT_EQ(upload_request(5_node, {0x1018, 1}),
            make_frame(request, {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}));
  EXPECT_EQ(upload_segment_request(5_node, false),
            make_frame(request, {0x60, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(upload_segment_request(5_node, true), make_frame(request, {0x70, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(sdo_abort(request, {0x1017, 0}, 0x0504'0000),
            make_frame(request, {0x80, 0x17, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
  EXPECT_EQ(sdo_abort(answer, {0x3000, 0}, 0x0602'0000),
            make_frame(answer, {0x80, 0x00, 0x30, 0x00, 0x00, 0x00, 0x02, 0x06}));
}

TEST(SdoCodec, WritesTheAnswersOfAServer) {
  EXPECT_EQ(download_answer(5_node, {0x1017, 0}),
            make_frame(answer, {0x60, 0x17, 0x10, 0x00, 0, 0, 0, 0}));
  EXPECT_EQ(download_segment_answer(5_node, false),
            make_frame(answer, {0x20, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(download_segment_answer(5_node, true), make_frame(answer, {0x30, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(upload_answer(5_node, of({0x6041, 0}, {0x37, 0x02})),
            make_frame(answer, {0x4B, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0}));
  EXPECT_EQ(upload_answer(5_node, of({0x6061, 0}, {0xFF})),
            make_frame(answer, {0x4F, 0x61, 0x60, 0x00, 0xFF, 0, 0, 0}));
  EXPECT_EQ(upload_answer(5_node, {.object = {0x1008, 0}, .expedited = false, .size = 16}),
            make_frame(answer, {0x41, 0x08, 0x10, 0x00, 0x10, 0, 0, 0}));
  EXPECT_EQ(upload_answer(5_node, {.object = {0x1008, 0}}),
            make_frame(answer, {0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
  EXPECT_EQ(upload_answer(5_node, {.object = {0x1008, 0}, .expedited = true, .data = {1, 2, 3, 4}}),
            make_frame(answer, {0x42, 0x08, 0x10, 0x00, 1, 2, 3, 4}));
}

TEST(SdoCodec, ReadsEveryFormOfAnInitiateAnswer) {
  const auto four = decode_initiate(make_frame(answer, {0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0, 0}));
  EXPECT_TRUE(four.expedited);
  EXPECT_EQ(four.object, (ObjectKey{0x1018, 1}));
  EXPECT_EQ(four.payload().size(), 4U);
  EXPECT_EQ(four.payload()[0], 0x5A);

  EXPECT_EQ(decode_initiate(make_frame(answer, {0x4F, 0, 0, 0, 1, 2, 3, 4})).payload().size(), 1U);
  EXPECT_EQ(decode_initiate(make_frame(answer, {0x4B, 0, 0, 0, 1, 2, 3, 4})).payload().size(), 2U);
  EXPECT_EQ(decode_initiate(make_frame(answer, {0x47, 0, 0, 0, 1, 2, 3, 4})).payload().size(), 3U);

  const auto unsized = decode_initiate(make_frame(answer, {0x42, 0, 0, 0, 1, 2, 3, 4}));
  EXPECT_FALSE(unsized.size);
  EXPECT_EQ(unsized.payload().size(), 4U);

  const auto segmented = decode_initiate(make_frame(answer, {0x41, 8, 0x10, 0, 0x10, 0, 0, 0}));
  EXPECT_FALSE(segmented.expedited);
  EXPECT_EQ(segmented.size, 16U);
  EXPECT_FALSE(decode_initiate(make_frame(answer, {0x40, 8, 0x10, 0, 0x10, 0, 0, 0})).size);
}

TEST(SdoCodec, ReadsTheSegmentsOfAString) {
  const auto first =
      decode_segment(make_frame(answer, {0x00, 0x53, 0x61, 0x6D, 0x70, 0x6C, 0x65, 0x20}));
  EXPECT_FALSE(first.toggle);
  EXPECT_FALSE(first.last);
  EXPECT_EQ(first.size, 7);

  const auto last = decode_segment(make_frame(answer, {0x0B, 0x76, 0x31, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(last.last);
  ASSERT_EQ(last.size, 2);
  EXPECT_EQ(last.payload()[0], 'v');
  EXPECT_EQ(last.payload()[1], '1');
}

TEST(SdoCodec, NamesTheCommandSpecifiersOfBothSides) {
  EXPECT_EQ(sdo_answer(make_frame(answer, {0x43})), SdoAnswer::upload_initiate);
  EXPECT_EQ(sdo_answer(make_frame(answer, {0x60})), SdoAnswer::download_initiate);
  EXPECT_EQ(sdo_answer(make_frame(answer, {0x30})), SdoAnswer::download_segment);
  EXPECT_EQ(sdo_answer(make_frame(answer, {0x1F})), SdoAnswer::upload_segment);
  EXPECT_EQ(sdo_answer(make_frame(answer, {0x80})), SdoAnswer::abort);
  EXPECT_EQ(sdo_answer(make_frame(answer, {0xC6})), SdoAnswer::block_upload);
  EXPECT_EQ(sdo_answer(make_frame(answer, {0xA4})), SdoAnswer::block_download);
  EXPECT_EQ(sdo_answer(make_frame(answer, {0xE0})), SdoAnswer::reserved);
  EXPECT_EQ(sdo_request(make_frame(request, {0x40})), SdoRequest::upload_initiate);
  EXPECT_EQ(sdo_request(make_frame(request, {0x70})), SdoRequest::upload_segment);
  EXPECT_EQ(sdo_request(make_frame(request, {0x2F})), SdoRequest::download_initiate);
  EXPECT_EQ(sdo_request(make_frame(request, {0x03})), SdoRequest::download_segment);
  EXPECT_EQ(sdo_request(make_frame(request, {0xC6})), SdoRequest::block_download);
  EXPECT_EQ(sdo_request(make_frame(request, {0xA3})), SdoRequest::block_upload);
}

}  // namespace
}  // namespace takt
