#pragma once
#include <optional>
#include <string>

#include "apps/mcap/mcap_writer.hpp"
#include "apps/takt/log/log_writer.hpp"

namespace takt::logging {

/// States whether the log has a channel for the frames of recordings.
enum class FrameChannelUse : std::uint8_t { none, one };

/// Writes an MCAP file with JSON messages and JSON schemas, as Foxglove, Lichtblick and PlotJuggler
/// read it: `/BUS/image` has one message a cycle with an object for each node, `/BUS/event` is a
/// foxglove.Log, and `/BUS/frame` has the frames of recordings. All times are those of the wall
/// clock.
class McapLog final : public LogWriter {
 public:
  /// `sink` must live longer than the log.
  McapLog(mcap::ByteSink& sink, const LogHead& head, FrameChannelUse frames);

  bool row(const LogRow& row) override;
  bool event(const LogEvent& event) override;
  bool frame(const LogFrame& frame) override;
  bool finish() override { return writer_.finish(); }

  bool full() const noexcept { return writer_.full(); }

 private:
  /// A signal in a message. The signals of a node follow each other.
  struct Column {
    std::size_t at = 0;  // position in LogRow
    ValueFormat format{};
    std::string node{};  // JSON that begins the object of the node; empty within the object
    std::string name{};  // JSON before the value
  };

  std::vector<Column> columns_;
  std::string begin_;  // JSON before the number of the cycle
  mcap::McapWriter writer_;
  mcap::ChannelId images_ = 0;
  mcap::ChannelId events_ = 0;
  mcap::ChannelId frames_ = 0;
  std::string json_;
};

}  // namespace takt::logging
