#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/mcap/byte_sink.hpp"
#include "apps/mcap/crc32.hpp"

namespace takt::mcap {

/// A stream of messages, and the schema that all of them follow.
struct Channel {
  std::string topic;
  std::string message_encoding;              ///< for example "json"
  std::string schema_name;                   ///< for example "foxglove.Log"
  std::string schema_encoding;               ///< for example "jsonschema"
  std::string schema;                        ///< text of the schema
  std::map<std::string, std::string> notes;  ///< metadata of the channel
};

using ChannelId = std::uint16_t;

/// Writes an MCAP file, version 0 (mcap.dev/spec): the messages in chunks without compression, the
/// index of each chunk, and at the end the summary that lets a reader jump to a time or a channel.
///
/// The memory is bounded: one chunk with its index, and about 100 bytes for each chunk of the file,
/// of which there are at most `most_chunks`. Before each chunk the writer reserves room for it and
/// for the summary. If there is no room, the writer leaves the chunk out, and finish() still makes
/// a complete file.
class McapWriter {
 public:
  static constexpr std::size_t usual_chunk_bytes = std::size_t{4} << 20U;
  static constexpr std::uint32_t most_chunks = 65'536;  // 256 GiB

  /// Writes the header. `library` names the program. `sink` must live longer than the writer.
  McapWriter(ByteSink& sink, std::string_view library, std::size_t chunk_bytes = usual_chunk_bytes);

  /// Adds a channel, before the first message. At most 65,535 are possible.
  ChannelId add(const Channel& channel);

  /// Adds a message. `time` is in ns since 1970; messages need not come in the order of their
  /// times. Returns false if the file takes no more messages: the sink has no room, or there are
  /// `most_chunks` chunks.
  bool write(ChannelId channel, std::uint64_t time, std::string_view data);

  /// Writes the last chunk and the summary. Returns false if the file is not complete.
  bool finish();

  /// Returns true if messages were left out because there was no room.
  bool full() const noexcept { return full_; }
  /// Returns the number of messages in the chunks that are written.
  std::uint64_t messages() const noexcept { return messages_; }

 private:
  struct Stream {
    std::uint32_t sequence = 0;  // number of the next message
    std::uint64_t messages = 0;  // number of messages in written chunks
    // Time and offset of each message of the chunk.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;
  };
  struct Span {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
  };

  bool emit(std::string_view bytes);
  bool flush();
  std::string chunk_record(std::string& index);
  std::string summary() const;
  std::string statistics() const;

  ByteSink& sink_;
  std::size_t chunk_bytes_;
  std::uint64_t offset_ = 0;  // bytes written
  Crc32 crc_;                 // CRC of the bytes written
  std::vector<Stream> streams_;
  std::string schemas_;  // records for the summary
  std::string channels_;
  std::string chunk_indexes_;
  std::string chunk_;  // records of the chunk that is being filled
  Span chunk_times_;
  Span times_;  // times of the written chunks
  std::uint32_t chunks_ = 0;
  std::uint64_t messages_ = 0;
  bool full_ = false;
  bool usable_ = false;  // the header and all channels are written
};

}  // namespace takt::mcap
