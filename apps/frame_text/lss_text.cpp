#include "apps/frame_text/lss_text.hpp"

#include <fmt/format.h>

#include "master/wire/bytes.hpp"

namespace takt {
namespace {

std::uint32_t word(const Frame& frame) {
  return load_le<std::uint32_t>(std::span{frame.data}.subspan(1));
}

std::string result(const char* what, const Frame& frame) {
  if (frame.data[1] == 0) return fmt::format("{}: done", what);
  if (frame.data[1] == 255) return fmt::format("{}: device error {}", what, frame.data[2]);
  return fmt::format("{}: refused, error {}", what, frame.data[1]);
}

std::string configure_text(const Frame& frame, bool of_master) {
  switch (frame.data[0]) {
    case 0x04:
      return frame.data[1] == 0 ? "all to waiting" : "all to configuration";
    case 0x11:
      return of_master ? fmt::format("node id := {}", frame.data[1]) : result("node id", frame);
    case 0x13:
      return of_master
                 ? fmt::format("bit timing := table {} entry {}", frame.data[1], frame.data[2])
                 : result("bit timing", frame);
    case 0x15:
      return fmt::format("activate bit timing after {} ms", word(frame) & 0xFFFF);
    default:
      return of_master ? "store configuration" : result("store configuration", frame);
  }
}

std::string inquire_text(const Frame& frame, bool of_master) {
  constexpr const char* what[] = {"vendor id", "product code", "revision", "serial number"};
  if (frame.data[0] == 0x5E) {
    return of_master ? "inquire node id" : fmt::format("node id is {}", frame.data[1]);
  }
  const char* name = what[frame.data[0] - 0x5A];
  return of_master ? fmt::format("inquire {}", name)
                   : fmt::format("{} is 0x{:08X}", name, word(frame));
}

std::string identify_text(const Frame& frame) {
  constexpr const char* select[] = {"vendor id", "product code", "revision", "serial number"};
  constexpr const char* range[] = {"vendor id",   "product code", "revision from",
                                   "revision to", "serial from",  "serial to"};
  switch (frame.data[0]) {
    case 0x44:
      return "selected";
    case 0x4C:
      return "who has no node id?";
    case 0x4F:
      return "here (identify)";
    case 0x50:
      return "here, without node id";
    case 0x51:
      return fmt::format("fastscan number 0x{:08X}, bit {}, part {}, next {}", word(frame),
                         frame.data[5], frame.data[6], frame.data[7]);
    default:
      break;
  }
  if (frame.data[0] < 0x44) {
    return fmt::format("select {} 0x{:08X}", select[frame.data[0] - 0x40], word(frame));
  }
  return fmt::format("identify {} 0x{:08X}", range[frame.data[0] - 0x46], word(frame));
}

}  // namespace

std::string lss_text(const Frame& frame, bool of_master) {
  switch (frame.data[0]) {
    case 0x04:
    case 0x11:
    case 0x13:
    case 0x15:
    case 0x17:
      return configure_text(frame, of_master);
    case 0x5A:
    case 0x5B:
    case 0x5C:
    case 0x5D:
    case 0x5E:
      return inquire_text(frame, of_master);
    case 0x40:
    case 0x41:
    case 0x42:
    case 0x43:
    case 0x44:
    case 0x46:
    case 0x47:
    case 0x48:
    case 0x49:
    case 0x4A:
    case 0x4B:
    case 0x4C:
    case 0x4F:
    case 0x50:
    case 0x51:
      return identify_text(frame);
    default:
      return fmt::format("unknown command 0x{:02X}", frame.data[0]);
  }
}

}  // namespace takt
