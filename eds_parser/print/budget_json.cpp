#include <utility>

#include "eds_parser/print/json.hpp"
#include "eds_parser/print/names.hpp"
#include "eds_parser/print/print_budget.hpp"
#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

Json bound_json(const std::optional<Time>& worst) {
  return worst ? Json(us(*worst)) : Json(nullptr);
}

std::string_view key_of(Traffic kind) noexcept {
  static constexpr std::string_view names[]{
      "nmt", "time", "sync", "emcy", "tpdo", "rpdo", "sdo", "remote_request", "error_control"};
  return name_of(kind, names);
}

Json row_json(const BudgetRow& row) {
  const auto& frame = row.frame;
  Json json{{"name", frame.name},
            {"kind", key_of(frame.kind)},
            {"cob_id", frame.cob_id.id()},
            {"extended", frame.cob_id.is_extended()},
            {"bytes", frame.bytes},
            {"frame_us", us(frame.frame)},
            {"period_us", us(frame.period)},
            {"burst", frame.burst},
            {"on_change", frame.on_change},
            {"after_sync", row.cycle != Time{0}},
            {"worst_us", bound_json(row.worst)},
            {"worst_in_emcy_burst_us", bound_json(row.worst_in_burst)},
            {"worst_behind_services_us", bound_json(row.worst_behind_services)},
            {"worst_without_changes_us", bound_json(row.worst_steady)},
            {"limit_us", row.why == BudgetLimit::none ? Json(nullptr) : Json(us(row.limit))},
            {"limit", name_of(row.why)},
            {"limit_by", frame.waits},
            {"next_sync_us", row.cycle == Time{0} ? Json(nullptr) : Json(us(row.cycle))},
            {"fits", row.fits()},
            {"fits_in_emcy_burst", row.fits_in_burst()}};
  if (frame.in_cycle) json["every_syncs"] = frame.every;
  return json;
}

}  // namespace

void print_budget_json(std::ostream& out, const BusPlan& plan, const BusBudget& budget,
                       std::span<const Suggestion> suggestions) {
  Json would_fit = list_of(suggestions, [](const Suggestion& suggestion) {
    return Json{{"change", suggestion.text}, {"what_if", to_string(suggestion.changes)}};
  });
  const Json document{
      {"bus", plan.name},
      {"bitrate", plan.bitrate},
      {"sync", plan.cycle.sync},
      {"period_us", us(plan.cycle.period)},
      {"receive_window_us", us(plan.cycle.receive_window)},
      {"output_deadline_us", us(plan.cycle.output_deadline)},
      {"load",
       {{"typical", budget.load.typical},
        {"worst", budget.load.worst},
        {"services", budget.load.services}}},
      {"fits", budget.fits()},
      {"refused_by_taktd", budget.refused},
      {"fits_in_emcy_burst", budget.fits_in_burst()},
      {"fits_but_for_changes", budget.fits_but_for_changes()},
      {"sync_delay_us", us(budget.sync_delay())},
      {"sync_delay_behind_services_us", bound_json(budget.sync_delay_behind_services())},
      {"assumptions", budget.assumptions},
      {"would_fit", std::move(would_fit)},
      {"frames", list_of(budget.rows, row_json)}};
  out << document.dump(2) << '\n';
}

}  // namespace takt
