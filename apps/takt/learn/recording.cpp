#include "apps/takt/learn/recording.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "master/trace/time_stamp.hpp"
#include "master/trace/trace_line.hpp"
#include "master/trace/words.hpp"
#include "master/wire/nmt.hpp"

namespace takt::learn {
namespace {

constexpr std::size_t most_identifiers = 4096;
constexpr std::size_t most_boots = 16;
constexpr std::size_t most_writes = 4096;   // limit for one boot
constexpr std::size_t most_objects = 8192;  // limit for one boot
constexpr std::size_t most_line = 512;
constexpr std::size_t most_early = 16;  // limit of interfaces with early error frames

bool is_node(unsigned id) { return id >= 1 && id <= 127; }

}  // namespace

Recording::Recording(std::string file, std::string interface) {
  bus_.file = std::move(file);
  bus_.interface = std::move(interface);
}

void Recording::announce(Severity severity, std::string_view rule, std::uint32_t line,
                         std::string message) {
  bus_.findings.push_back({bus_.file, {line, 0}, severity, rule, std::move(message)});
}

void Recording::add(std::string_view text, std::uint32_t line) {
  line_ = line;
  const auto parsed = lines_.parse(text);
  if (!parsed) {
    if (!is_remark(text) && ++strange_ <= 3) {
      announce(Severity::warning, "not-candump", line,
               "not a frame of candump, .trc or .asc, or a CAN FD frame; line left out");
    }
    return;
  }
  if (bus_.interface.empty()) {
    if (parsed->error_frame) return early_error(parsed->interface);
    choose(parsed->interface);
  }
  if (parsed->interface != bus_.interface) return foreign(parsed->interface, 1);
  ++bus_.frames;
  const auto before = std::exchange(us_, stamp_in_us(parsed->stamp));
  if (before && us_ && *us_ < *before) ++backward_;
  if (us_ && !first_us_) first_us_ = us_;
  if (us_ && *us_ >= *first_us_) bus_.seconds = static_cast<double>(*us_ - *first_us_) / 1e6;
  if (parsed->error_frame) {
    ++bus_.error_frames;
  } else {
    frame(*parsed);
  }
}

/// Keeps an error frame until the first frame of another kind has chosen the interface. The error
/// frame is counted only then.
void Recording::early_error(const std::string& interface) {
  const auto known = std::ranges::find(early_, interface, &EarlyErrors::interface);
  if (known != early_.end()) {
    ++known->count;
  } else if (early_.size() < most_early) {
    early_.push_back({interface, 1});
  } else {
    foreign(interface, 1);
  }
}

void Recording::choose(std::string interface) {
  bus_.interface = std::move(interface);
  for (const EarlyErrors& errors : std::exchange(early_, {})) {
    if (errors.interface != bus_.interface) {
      foreign(errors.interface, errors.count);
    } else {
      bus_.frames += errors.count;
      bus_.error_frames += errors.count;
    }
  }
}

void Recording::foreign(const std::string& interface, std::uint64_t frames) {
  if (foreign_ == 0) foreign_name_ = interface;
  foreign_ += frames;
}

LearnedNode& Recording::node(std::uint8_t id) {
  LearnedNode& node = bus_.nodes[id];
  if (node.id == 0) {
    node.id = id;
    node.first_line = line_;
    node.reset_node = all_reset_;
  }
  return node;
}

LearnedBoot& Recording::boot(LearnedNode& node) {
  if (node.boots.empty()) node.boots.emplace_back();
  return node.boots.back();
}

void Recording::frame(const CandumpLine& line) {
  const Frame& frame = line.frame;
  const unsigned id = frame.id.id();
  const auto node_id = static_cast<std::uint8_t>(id & 0x7FU);
  const unsigned function = frame.id.is_extended() ? 0x7FFU : id & 0x780U;
  if (!frame.id.is_extended() && id == 0) return nmt(frame);
  if (function == 0x600 && is_node(node_id) && !frame.rtr) {
    ++node(node_id).requests;
    return transfer(node(node_id), node(node_id).sdo.request(frame));
  }
  if (function == 0x580 && is_node(node_id) && !frame.rtr) {
    ++node(node_id).answers;
    return transfer(node(node_id), node(node_id).sdo.answer(frame));
  }
  if (function == 0x700 && is_node(node_id)) return error_control(node_id, frame);
  if (!frame.id.is_extended() && id == 0x100) return bus_.time.add(us_);
  if (!frame.id.is_extended() && (id == 0x7E4 || id == 0x7E5)) {
    ++bus_.lss;
    return;
  }
  other(frame);
}

void Recording::reset(LearnedNode& node, bool whole_node) {
  node.reset_node = whole_node;
  if (node.boots.empty() || node.boots.size() >= most_boots) return;
  const LearnedBoot& newest = node.boots.back();
  if (!newest.values.empty() || newest.started) node.boots.emplace_back();
}

void Recording::start(LearnedNode& node, bool by_name) {
  boot(node).started = true;
  node.started = node.started || by_name;
}

void Recording::nmt(const Frame& frame) {
  if (frame.rtr || frame.length < 2 || frame.data[1] > 127) return;
  const auto apply = [&](LearnedNode& node) {
    switch (static_cast<NmtCommand>(frame.data[0])) {
      case NmtCommand::start:
        return start(node, frame.data[1] != 0);
      case NmtCommand::reset_node:
        return reset(node, true);
      case NmtCommand::reset_communication:
        return reset(node, false);
      default:
        return;
    }
  };
  if (frame.data[1] != 0) {
    LearnedNode& one = node(frame.data[1]);
    one.addressed = true;
    return apply(one);
  }
  const auto command = static_cast<NmtCommand>(frame.data[0]);
  bus_.started_all = bus_.started_all || command == NmtCommand::start;
  if (command == NmtCommand::reset_node) all_reset_ = true;
  if (command == NmtCommand::reset_communication) all_reset_ = false;
  const bool resets =
      command == NmtCommand::reset_node || command == NmtCommand::reset_communication;
  for (auto& [id, each] : bus_.nodes) {
    each.ignores_reset = each.ignores_reset || resets;
    apply(each);
  }
}

/// Takes boot-up messages, heartbeats and guarding frames. CiA 301, 7.2.8.3.2.
void Recording::error_control(std::uint8_t id, const Frame& frame) {
  LearnedNode& sender = node(id);
  if (frame.rtr) return sender.guard_requests.add(us_);
  if (frame.length != 1) return;
  if (frame.data[0] == 0) {
    sender.booted_up = true;
    sender.ignores_reset = false;
    return reset(sender, sender.reset_node);
  }
  if ((frame.data[0] & 0x7F) == 5) start(sender, false);
  if (!sender.guarded()) sender.heartbeats.add(us_);
}

void Recording::transfer(LearnedNode& node, const std::optional<SeenTransfer>& transfer) {
  if (!transfer) return;
  const bool written = transfer->kind == SeenTransfer::Kind::write;
  if (transfer->abort_code) {
    if (written && node.refused.size() < most_writes) node.refused.push_back({*transfer, line_});
    return;
  }
  if (written) write(node, *transfer);
  LearnedBoot& now = boot(node);
  if (transfer->extent != SeenTransfer::Extent::whole || now.values.size() >= most_objects) return;
  if (written && now.started) return;  // the configuration has ended
  LearnedValue& value = now.values[transfer->object];
  if (!value.read && !value.written) value.first = transfer->value;
  value.last = transfer->value;
  (written ? value.written : value.read) = true;
}

void Recording::write(LearnedNode& node, const SeenTransfer& transfer) {
  LearnedBoot& now = boot(node);
  std::vector<LearnedWrite>& list = now.started ? node.later : now.writes;
  if (list.size() < most_writes) list.push_back({transfer, line_});
}

void Recording::other(const Frame& frame) {
  const bool known = bus_.traffic.contains(frame.id);
  if (!known && bus_.traffic.size() >= most_identifiers) {
    ++bus_.more_traffic;
    return;
  }
  LearnedTraffic& traffic = bus_.traffic[frame.id];
  if (!known) traffic.first_line = line_;
  if (frame.rtr) return traffic.requests.add(us_);
  traffic.frames.add(us_);
  traffic.shortest = std::min(traffic.shortest, frame.length);
  traffic.longest = std::max(traffic.longest, frame.length);
  if (frame.id.is_extended() || frame.length > 1) return;
  LearnedSync& sync = bus_.sync[frame.id.id()];
  sync.frames.add(us_);
  if (frame.length == 1) sync.highest_counter = std::max(sync.highest_counter, frame.data[0]);
}

LearnedBus Recording::take() {
  if (!early_.empty()) choose(early_.front().interface);
  if (strange_ > 3) {
    announce(Severity::warning, "not-candump", 0,
             fmt::format("{} lines hold no frame and were left out", strange_));
  }
  if (backward_ >= 4 && backward_ > bus_.frames / 8) {
    announce(Severity::error, "no-times", 0,
             "the times go back repeatedly, as time differences do (candump -td), so no period is "
             "right; record with `candump -L`");
  }
  if (foreign_ != 0) {
    announce(Severity::note, "other-interface", 0,
             fmt::format("{} frames of other interfaces ({}) were left out; --bus {} learns from "
                         "them",
                         foreign_, foreign_name_, foreign_name_));
  }
  for (const auto& [id, node] : bus_.nodes) {
    if (node.sdo.strays() != 0) {
      announce(Severity::note, "no-beginning", node.first_line,
               fmt::format("node {}: {} SDO frames of transfers whose beginning is not in the "
                           "recording",
                           id, node.sdo.strays()));
    }
    if (node.sdo.cut_off() != 0) {
      announce(Severity::warning, "cut-off", node.first_line,
               fmt::format("node {}: {} SDO transfers were cut off by another request: no answer, "
                           "lost frames, or two clients at once",
                           id, node.sdo.cut_off()));
    }
  }
  return std::move(bus_);
}

LearnedBus read_recording(std::istream& in, const std::string& name, const std::string& interface) {
  Recording recording{name, interface};
  std::string text;
  std::uint32_t line = 1;
  for (int c = in.get(); c != std::char_traits<char>::eof(); c = in.get()) {
    if (c != '\n') {
      if (text.size() < most_line) text.push_back(static_cast<char>(c));
      continue;
    }
    recording.add(text, line++);
    text.clear();
  }
  recording.add(text, line);
  return recording.take();
}

}  // namespace takt::learn
