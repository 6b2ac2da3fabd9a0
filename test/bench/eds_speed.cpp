// How fast a DCF becomes a dictionary, findings included: processor time of reading a file that is
// in the cache, the median of 15 readings. A line each:
//
//   eds_speed              of a dense DCF (VARs and records, 170 bytes of text a sub-object) of 1
//                          and 8 MB
//   eds_speed FILE...      of these files
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "eds_parser/read/eds.hpp"

namespace {

using namespace takt;

std::string sub_object(const std::string& section, const std::string& name, unsigned number) {
  constexpr const char* types[] = {"0x0005", "0x0006", "0x0007", "0x0004", "0x0003"};
  constexpr const char* access[] = {"rw", "ro", "rww", "const"};
  return '[' + section + "]\r\nParameterName=" + name +
         "\r\nObjectType=0x7\r\nDataType=" + types[number % 5] +
         "\r\nAccessType=" + access[number % 4] +
         "\r\nDefaultValue=" + std::to_string(number % 250) +
         "\r\nPDOMapping=" + std::to_string(number % 2) +
         "\r\nLowLimit=0\r\nHighLimit=120\r\nParameterValue=" + hex(number % 250, 2) + "\r\n\r\n";
}

/// Three of four objects are VARs, the fourth is a record of 30 sub-objects.
std::string dense_dcf(std::size_t size) {
  std::string list;
  std::string objects;
  unsigned number = 0;
  unsigned index = 0x2000;
  for (; list.size() + objects.size() < size; ++index) {
    const auto section = hex(index).substr(2);
    list += std::to_string(index - 0x1FFF) + '=' + hex(index) + "\r\n";
    if (index % 4 != 0) {
      objects += sub_object(section, "Parameter number " + std::to_string(number), number);
      ++number;
      continue;
    }
    objects +=
        '[' + section + "]\r\nParameterName=Record\r\nObjectType=0x9\r\nSubNumber=30\r\n\r\n";
    for (unsigned sub = 0; sub < 30; ++sub, ++number) {
      objects += sub_object(section + "sub" + hex(sub, 1).substr(2),
                            "Element " + std::to_string(sub), number);
    }
  }
  return "[DeviceInfo]\r\nVendorName=V\r\n\r\n[DeviceComissioning]\r\nNodeID=5\r\n\r\n"
         "[ManufacturerObjects]\r\nSupportedObjects=" +
         std::to_string(index - 0x2000) + "\r\n" + list + "\r\n" + objects;
}

double seconds_of(const std::filesystem::path& path) {
  const std::clock_t begin = std::clock();
  if (!read_eds_file(path).readable) return -1;
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

bool measure(const std::string& title, const std::filesystem::path& path) {
  std::vector<double> seconds(15);
  std::ranges::generate(seconds, [&] { return seconds_of(path); });
  std::ranges::sort(seconds);
  if (seconds.front() < 0) return false;
  const double megabytes = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
  std::printf("%s: %.0f MB/s\n", title.c_str(), megabytes / seconds[seconds.size() / 2]);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  bool all_read = true;
  for (int i = 1; i < argc; ++i) all_read = measure(argv[i], argv[i]) && all_read;
  if (argc > 1) return all_read ? 0 : 1;
  const auto path = std::filesystem::temp_directory_path() / "takt_eds_speed.dcf";
  for (const std::size_t megabytes : {1, 8}) {
    std::ofstream{path, std::ios::binary} << dense_dcf(megabytes * 1'000'000);
    all_read = measure("dense DCF of " + std::to_string(megabytes) + " MB", path) && all_read;
  }
  std::filesystem::remove(path);
  return all_read ? 0 : 1;
}
