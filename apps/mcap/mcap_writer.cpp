#include "apps/mcap/mcap_writer.hpp"

#include <algorithm>

#include "apps/mcap/record.hpp"

namespace takt::mcap {
namespace {

/// An upper bound for the size of the records at the end of a file, without schemas, channels,
/// indexes of chunks and the counts of channels.
constexpr std::uint64_t ending_bytes = 512;
/// Size of the count of one channel in the statistics.
constexpr std::uint64_t count_bytes = 10;

void put_range(std::string& out, Opcode group, std::uint64_t begin, std::uint64_t end) {
  if (begin == end) return;
  const Record record{out, Opcode::summary_offset};
  put(out, static_cast<std::uint8_t>(group));
  put(out, begin);
  put(out, end - begin);
}

}  // namespace

McapWriter::McapWriter(ByteSink& sink, std::string_view library, std::size_t chunk_bytes)
    : sink_{sink}, chunk_bytes_{chunk_bytes} {
  std::string bytes{magic};
  {
    const Record header{bytes, Opcode::header};
    put_text(bytes, "");  // no profile
    put_text(bytes, library);
  }
  usable_ = emit(bytes);
}

ChannelId McapWriter::add(const Channel& channel) {
  const auto id = static_cast<ChannelId>(streams_.size() + 1);
  streams_.emplace_back();
  std::string schema;
  {
    const Record record{schema, Opcode::schema};
    put(schema, id);  // each channel has a separate schema
    put_text(schema, channel.schema_name);
    put_text(schema, channel.schema_encoding);
    put_text(schema, channel.schema);
  }
  std::string stream;
  {
    const Record record{stream, Opcode::channel};
    put(stream, id);
    put(stream, id);
    put_text(stream, channel.topic);
    put_text(stream, channel.message_encoding);
    const Counted<std::uint32_t> notes{stream};
    for (const auto& [key, value] : channel.notes) {
      put_text(stream, key);
      put_text(stream, value);
    }
  }
  schemas_ += schema;
  channels_ += stream;
  usable_ = usable_ && emit(schema + stream);
  return id;
}

bool McapWriter::emit(std::string_view bytes) {
  const std::uint64_t rest = schemas_.size() + channels_.size() + chunk_indexes_.size() +
                             count_bytes * streams_.size() + ending_bytes;
  if (full_ || !sink_.reserve(bytes.size() + rest) || !sink_.write(bytes)) {
    full_ = true;
    return false;
  }
  crc_.add(bytes);
  offset_ += bytes.size();
  return true;
}

bool McapWriter::write(ChannelId channel, std::uint64_t time, std::string_view data) {
  if (full_) return false;
  if (!chunk_.empty() && chunk_.size() + data.size() > chunk_bytes_ && !flush()) return false;
  Stream& stream = streams_[channel - 1U];
  if (chunk_.empty()) chunk_times_ = {time, time};
  chunk_times_ = {std::min(chunk_times_.first, time), std::max(chunk_times_.last, time)};
  stream.index.emplace_back(time, chunk_.size());
  const Record record{chunk_, Opcode::message};
  put(chunk_, channel);
  put(chunk_, stream.sequence++);
  put(chunk_, time);
  put(chunk_, time);  // time of publishing
  chunk_ += data;
  return true;
}

/// Returns the chunk and its message indexes, and puts its record for the summary into `index`.
std::string McapWriter::chunk_record(std::string& index) {
  std::string bytes;
  bytes.reserve(chunk_.size() + 1024);
  {
    const Record record{bytes, Opcode::chunk};
    put(bytes, chunk_times_.first);
    put(bytes, chunk_times_.last);
    put(bytes, std::uint64_t{chunk_.size()});
    put(bytes, crc32(chunk_));
    put_text(bytes, "");  // no compression
    put(bytes, std::uint64_t{chunk_.size()});
    bytes += chunk_;
  }
  const std::uint64_t length = bytes.size();
  const Record record{index, Opcode::chunk_index};
  put(index, chunk_times_.first);
  put(index, chunk_times_.last);
  put(index, offset_);
  put(index, length);
  {
    const Counted<std::uint32_t> offsets{index};
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      auto& messages = streams_[i].index;
      if (messages.empty()) continue;
      const auto id = static_cast<ChannelId>(i + 1);
      put(index, id);
      put(index, offset_ + bytes.size());
      std::ranges::sort(messages);
      const Record message_index{bytes, Opcode::message_index};
      put(bytes, id);
      const Counted<std::uint32_t> entries{bytes};
      for (const auto& [time, offset] : messages) {
        put(bytes, time);
        put(bytes, offset);
      }
    }
  }
  put(index, bytes.size() - length);
  put_text(index, "");
  put(index, std::uint64_t{chunk_.size()});
  put(index, std::uint64_t{chunk_.size()});
  return bytes;
}

/// Writes the chunk, or drops it if there is no room.
bool McapWriter::flush() {
  if (chunk_.empty()) return true;
  if (chunks_ == most_chunks) full_ = true;
  std::string index;
  const std::string bytes = full_ ? std::string{} : chunk_record(index);
  const std::size_t indexes_before = chunk_indexes_.size();
  chunk_indexes_ += index;
  const bool written = emit(bytes);
  if (written) {
    times_ = chunks_ == 0 ? chunk_times_
                          : Span{std::min(times_.first, chunk_times_.first),
                                 std::max(times_.last, chunk_times_.last)};
    ++chunks_;
  } else {
    chunk_indexes_.resize(indexes_before);
  }
  for (Stream& stream : streams_) {
    if (written) stream.messages += stream.index.size();
    if (written) messages_ += stream.index.size();
    stream.index.clear();
  }
  chunk_.clear();
  return written;
}

std::string McapWriter::statistics() const {
  std::string out;
  {
    const Record record{out, Opcode::statistics};
    put(out, messages_);
    put(out, static_cast<std::uint16_t>(streams_.size()));  // number of schemas
    put(out, static_cast<std::uint32_t>(streams_.size()));
    put(out, std::uint32_t{0});  // number of attachments
    put(out, std::uint32_t{0});  // number of metadata records
    put(out, chunks_);
    put(out, times_.first);
    put(out, times_.last);
    const Counted<std::uint32_t> counts{out};
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      put(out, static_cast<ChannelId>(i + 1));
      put(out, streams_[i].messages);
    }
  }
  return out;
}

/// Returns everything from the summary section to the end of the file. The file has `offset_` bytes
/// up to the end of the data section.
std::string McapWriter::summary() const {
  std::string out;
  std::string offsets;
  const auto add = [&](Opcode group, const std::string& records) {
    put_range(offsets, group, offset_ + out.size(), offset_ + out.size() + records.size());
    out += records;
  };
  add(Opcode::schema, schemas_);
  add(Opcode::channel, channels_);
  add(Opcode::chunk_index, chunk_indexes_);
  add(Opcode::statistics, statistics());
  const std::uint64_t offsets_begin = offset_ + out.size();
  out += offsets;
  {
    const Record footer{out, Opcode::footer};
    put(out, offset_);
    put(out, offsets_begin);
    // The CRC covers the opcode and the length of the footer, which are not yet in the file.
    std::string covered = out;
    covered.replace(covered.size() - 24, 8, std::string{"\x14\0\0\0\0\0\0\0", 8});
    put(out, crc32(covered));
  }
  out += magic;
  return out;
}

bool McapWriter::finish() {
  flush();
  if (!usable_) return false;
  std::string end;
  {
    const Record record{end, Opcode::data_end};
    put(end, crc_.value());
  }
  offset_ += end.size();
  const bool written = sink_.write(end + summary());
  full_ = true;
  return written;
}

}  // namespace takt::mcap
