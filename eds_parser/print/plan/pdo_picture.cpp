#include "eds_parser/print/plan/pdo_picture.hpp"

#include <algorithm>
#include <utility>

namespace takt {
namespace {

void draw(std::string& cells, std::size_t first, std::size_t bits, const std::string& label) {
  if (bits == 0 || first + bits > cells.size()) return;
  cells.replace(first, bits, bits, ' ');
  cells[first] = '|';
  std::ranges::copy_n(label.begin(), static_cast<std::ptrdiff_t>(std::min(label.size(), bits - 1)),
                      cells.begin() + static_cast<std::ptrdiff_t>(first) + 1);
}

}  // namespace

std::array<std::string, 2> pdo_picture(const BusPlan& plan, const PdoRow& row) {
  std::string bytes;
  for (unsigned byte = 0; byte < row.length; ++byte) bytes += std::to_string(byte) + "       ";
  bytes.erase(bytes.find_last_not_of(' ') + 1);
  std::string cells(row.length * std::size_t{8}, '.');
  for (const PdoField& field : plan.pdos.fields_of(row)) {
    const Signal& signal = plan.layout.signals[field.signal];
    draw(cells, field.bit_offset, field.bits, to_string(signal.object) + " " + signal.name);
  }
  return {std::move(bytes), cells + "|"};
}

}  // namespace takt
