#include "eds_parser/read/eds_channels.hpp"

#include <algorithm>
#include <utility>

#include "eds_parser/dictionary/standard_types.hpp"
#include "eds_parser/ini/section_keys.hpp"
#include "eds_parser/read/object_words.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

constexpr std::uint32_t most_segments = 255;
constexpr std::uint16_t first_variable = 0xA000;  // network variables, CiA 302-4
constexpr std::uint16_t last_variable = 0xAFFF;

class ChannelReader {
 public:
  ChannelReader(const IniEntries& entries, SourcePos pos, ValueReader& values, Report& report)
      : keys_{entries, report}, pos_{pos}, values_{values}, report_{report} {}

  std::vector<DynamicChannel> run() {
    std::uint8_t count = 0;
    if (keys_.get("nrofseg") == nullptr) {
      report_.warning(pos_, "channel-incomplete", "[DynamicChannels] has no NrOfSeg");
    }
    keys_.number(count, "nrofseg", values_);
    for (unsigned number = 1; number <= count; ++number) read(std::to_string(number));
    if (count < most_segments && keys_.get("type" + std::to_string(count + 1U)) != nullptr) {
      report_.warning(pos_, "channel-incomplete", "NrOfSeg is ", count, ", but there is Type",
                      count + 1U, "; it was left out");
    }
    return std::move(channels_);
  }

 private:
  void read(const std::string& number) {
    const auto* type = keys_.get("type" + number);
    const auto* range = keys_.get("range" + number);
    const auto* dir = keys_.get("dir" + number);
    if (type == nullptr || range == nullptr || dir == nullptr) {
      report_.warning(pos_, "channel-incomplete", "segment ", number, " needs Type", number,
                      ", Dir", number, " and Range", number, "; it was left out");
      return;
    }
    DynamicChannel channel{.pos = range->pos()};
    if (!read_type(channel, *type) || !read_direction(channel, *dir) ||
        !read_range(channel, *range)) {
      return;
    }
    keys_.number(channel.offset, "ppoffset" + number, values_);
    keys_.number(channel.most, "maxcnt" + number, values_);
    report_overlap(channel, number);
    channels_.push_back(channel);
  }

  bool read_type(DynamicChannel& channel, const IniEntry& entry) {
    const auto code = values_.read_count(entry, 0xFFFF);
    if (!code) return false;
    channel.type_code = static_cast<std::uint16_t>(*code);
    channel.type = data_type_of(*code);
    if (byte_width(channel.type) != 0) return true;
    report_.warning(entry.pos(), "channel-type", Quoted{entry.value},
                    " is not a data type of a network variable (a number or BOOLEAN); the "
                    "segment was left out");
    return false;
  }

  /// Reads the direction as other devices see it: `ro` is an output of the program.
  bool read_direction(DynamicChannel& channel, const IniEntry& entry) {
    const auto access = access_of_word(entry.value);
    if (access && *access != Access::constant) {
      channel.direction = *access;
      return true;
    }
    report_.warning(entry.pos(), "channel-direction", Quoted{entry.value},
                    " is not one of ro, wo, rw, rwr, rww; the segment was left out");
    return false;
  }

  bool read_range(DynamicChannel& channel, const IniEntry& entry) {
    const auto dash = entry.value.find('-');
    if (dash == std::string_view::npos) {
      return wrong_range(entry, "is not of the form 0xA080-0xA0BF");
    }
    IniEntry end = entry;
    end.value = trim(entry.value.substr(0, dash));
    const auto first = values_.read_count(end, 0xFFFF);
    end.value = trim(entry.value.substr(dash + 1));
    const auto last = values_.read_count(end, 0xFFFF);
    if (!first || !last) return false;
    if (*last < *first) return wrong_range(entry, "ends before it begins");
    if (*first < first_variable || *last > last_variable) {
      return wrong_range(entry, "is not within 0xA000-0xAFFF, the network variables");
    }
    channel.first = static_cast<std::uint16_t>(*first);
    channel.last = static_cast<std::uint16_t>(*last);
    return true;
  }

  bool wrong_range(const IniEntry& entry, std::string_view why) {
    report_.warning(entry.pos(), "channel-range", "range ", Quoted{entry.value}, ' ', why,
                    "; the segment was left out");
    return false;
  }

  void report_overlap(const DynamicChannel& channel, const std::string& number) {
    const auto other = std::ranges::find_if(channels_, [&](const DynamicChannel& seen) {
      return channel.first <= seen.last && seen.first <= channel.last;
    });
    if (other == channels_.end()) return;
    report_.warning(channel.pos, "channel-range", "segment ", number, " shares indices with ",
                    Hex{other->first}, "-", Hex{other->last});
  }

  SectionKeys keys_;
  SourcePos pos_;
  ValueReader& values_;
  Report& report_;
  std::vector<DynamicChannel> channels_;
};

}  // namespace

std::vector<DynamicChannel> read_dynamic_channels(const IniEntries& entries, SourcePos pos,
                                                  ValueReader& values, Report& report) {
  return ChannelReader{entries, pos, values, report}.run();
}

}  // namespace takt
