#include "test/unit/apps/takt/smooth/judge/seeded_causes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace takt::smooth {
namespace {

using std::chrono::microseconds;

Time part(const Generated& plan, double share) {
  return Time{static_cast<std::int64_t>(share * static_cast<double>(plan.recipe.period.count()))};
}

/// Sends again what the first axis sends, with a change of the times and values.
void resend(Generated& plan, const std::function<void(std::size_t, Sent&)>& change) {
  auto& sent = plan.axes[0].sent;
  for (std::size_t k = 0; k < sent.size(); ++k) change(k, sent[k]);
}

/// Lets the first axis be commanded by a program with a clock of its own.
void own_clock(Generated& plan, double factor) {
  GeneratedAxis& axis = plan.axes[0];
  const Time end = plan.planned(axis.sent.size());
  axis.sent.clear();
  const Time own = part(plan, factor);
  for (Time t = own / 2; t < end; t += own)
    axis.sent.push_back({t + part(plan, plan.normal(0.02)), axis.path(t)});
}

/// Lets an application with a period of its own compute the values, which are sent in time.
void own_values(Generated& plan, double factor) {
  const Time own = part(plan, factor);
  resend(plan, [&](std::size_t k, Sent& sent) {
    sent.value = plan.axes[0].path(plan.planned(k + 1) / own * own);
  });
}

/// Returns a cycle in which the first axis is fast, in its motion number `motion`.
std::size_t fast_cycle(const Generated& plan, std::size_t motion) {
  const auto& sent = plan.axes[0].sent;
  const std::size_t share = sent.size() / 4;
  std::size_t best = motion * share + 1;
  for (std::size_t k = best; k < (motion + 1) * share && k < sent.size(); ++k) {
    if (std::abs(sent[k].value - sent[k - 1].value) >
        std::abs(sent[best].value - sent[best - 1].value))
      best = k;
  }
  return best;
}

}  // namespace

const std::vector<Seeded>& seeded_causes() {
  static const std::vector<Seeded> list{
      {"no SYNC", Cause::no_sync, {}, [](Generated& plan) { plan.syncs.clear(); }},
      {"a second SYNC producer",
       Cause::two_sync_producers,
       {},
       [](Generated& plan) {
         const std::size_t all = plan.syncs.size();
         for (std::size_t k = 0; k < all; ++k)
           plan.syncs.push_back(plan.syncs[k] + part(plan, 0.37));
         std::ranges::sort(plan.syncs);
       }},
      {"a few surplus SYNCs",
       Cause::two_sync_producers,
       {},
       [](Generated& plan) {
         const std::size_t all = plan.syncs.size();
         for (std::size_t k = 0; k < all; ++k) {
           if (plan.chance(0.01)) plan.syncs.push_back(plan.syncs[k] + part(plan, 0.3));
         }
         std::ranges::sort(plan.syncs);
       }},
      {"missing SYNCs",
       Cause::sync_missing,
       {},
       [](Generated& plan) { std::erase_if(plan.syncs, [&](Time) { return plan.chance(0.01); }); }},
      {"SYNC with jitter",
       Cause::sync_jitter,
       {},
       [](Generated& plan) {
         for (Time& sync : plan.syncs) sync += part(plan, std::clamp(plan.normal(0.1), -0.2, 0.2));
       }},
      {"a drive that is disabled in motion",
       Cause::left_operation,
       {},
       [](Generated& plan) {
         auto& status = plan.axes[0].status;
         std::fill(status.begin() + static_cast<std::ptrdiff_t>(fast_cycle(plan, 2)), status.end(),
                   0x0218);
       }},
      {"a mode that changes in motion",
       Cause::mode_changed,
       {},
       [](Generated& plan) {
         auto& mode = plan.axes[0].mode;
         std::fill(mode.begin() + static_cast<std::ptrdiff_t>(fast_cycle(plan, 2)), mode.end(),
                   std::int8_t{1});
       }},
      {"a second sender that holds its value",
       Cause::two_senders,
       {},
       [](Generated& plan) {
         const std::size_t all = plan.axes[0].sent.size();
         for (std::size_t k = 0; k < all; ++k)
           plan.axes[0].sent.push_back({plan.planned(k) + part(plan, 0.8), -5000.0});
       }},
      {"a second sender with another path",
       Cause::two_senders,
       {},
       [](Generated& plan) {
         const std::size_t all = plan.axes[0].sent.size();
         const auto path = plan.axes[0].path;
         for (std::size_t k = 0; k < all; ++k) {
           const Time t = plan.planned(k) + part(plan, 0.2 + plan.normal(0.03));
           plan.axes[0].sent.push_back({t, path(t) * 0.5 + 70'000});
         }
       }},
      {"an RPDO that takes effect on arrival",
       Cause::not_synchronous,
       [](Recipe& recipe) { recipe.transmission = 255; },
       {},
       true},
      {"60C2 too short",
       Cause::interpolation_period,
       [](Recipe& recipe) { recipe.interpolation = 0.5; },
       {},
       true},
      {"60C2 too long",
       Cause::interpolation_period,
       [](Recipe& recipe) { recipe.interpolation = 2; },
       {},
       true},
      {"a sender with a slower clock",
       Cause::clock_beat,
       {},
       [](Generated& plan) { own_clock(plan, 1.006); }},
      {"a sender with a faster clock",
       Cause::clock_beat,
       {},
       [](Generated& plan) { own_clock(plan, 0.993); }},
      {"late set-points", Cause::late,
       [](Recipe& recipe) {
         recipe.phase = 0.8;
         recipe.noise = 0.02;
       },
       [](Generated& plan) {
         resend(plan, [&](std::size_t, Sent& sent) {
           if (plan.chance(0.03)) sent.when += part(plan, 0.35);
         });
       }},
      {"set-points with jitter across SYNC",
       Cause::late,
       [](Recipe& recipe) {
         recipe.phase = 0.9;
         recipe.noise = 0.07;
       },
       {}},
      {"early set-points", Cause::early,
       [](Recipe& recipe) {
         recipe.phase = 0.12;
         recipe.noise = 0.01;
       },
       [](Generated& plan) {
         resend(plan, [&](std::size_t, Sent& sent) {
           if (plan.chance(0.03)) sent.when -= part(plan, 0.25);
         });
       }},
      {"set-points that were not sent",
       Cause::skipped,
       {},
       [](Generated& plan) {
         std::erase_if(plan.axes[0].sent, [&](const Sent&) { return plan.chance(0.01); });
       }},
      {"set-points that were sent twice",
       Cause::overwritten,
       {},
       [](Generated& plan) {
         const std::vector<Sent> all = plan.axes[0].sent;
         for (const Sent& sent : all) {
           if (plan.chance(0.02))
             plan.axes[0].sent.push_back({sent.when + part(plan, 0.1), sent.value});
         }
       }},
      {"an application that is five times slower",
       Cause::slow_values,
       {},
       [](Generated& plan) { own_values(plan, 5); }},
      {"an application that is ten times slower",
       Cause::slow_values,
       {},
       [](Generated& plan) { own_values(plan, 10); }},
      {"an application that is twice slower",
       Cause::slow_values,
       {},
       [](Generated& plan) { own_values(plan, 2); }},
      {"an application that is a little slower",
       Cause::value_beat,
       {},
       [](Generated& plan) { own_values(plan, 1.04); }},
      {"an application that is a little faster",
       Cause::value_beat,
       {},
       [](Generated& plan) { own_values(plan, 0.96); }},
      {"repeated values",
       Cause::duplicated,
       {},
       [](Generated& plan) {
         double before = plan.axes[0].sent[0].value;
         resend(plan, [&](std::size_t, Sent& sent) {
           const double value = sent.value;
           if (plan.chance(0.03)) sent.value = before;
           before = value;
         });
       }},
      {"an application that stalls",
       Cause::duplicated,
       {},
       [](Generated& plan) {
         for (std::size_t motion = 0; motion < 4; ++motion) {
           const std::size_t from = fast_cycle(plan, motion);
           for (std::size_t k = from; k < from + 7; ++k) {
             plan.axes[0].sent[k].value = plan.axes[0].sent[from - 1].value;
           }
         }
       }},
      {"values left out",
       Cause::value_skipped,
       {},
       [](Generated& plan) {
         // The application gets ahead of the sender by one cycle, several times.
         std::vector<std::size_t> places;
         for (std::size_t motion = 0; motion < 4; ++motion) {
           for (const std::size_t before : {30U, 12U, 0U}) {
             places.push_back(fast_cycle(plan, motion) - before + plan.random() % 8);
           }
         }
         resend(plan, [&](std::size_t k, Sent& sent) {
           const auto ahead =
               std::ranges::count_if(places, [&](std::size_t place) { return place <= k; });
           sent.value = plan.axes[0].path(plan.planned(k + 1 + static_cast<std::size_t>(ahead)));
         });
       }},
      {"a start at full velocity",
       Cause::velocity_jump,
       {},
       [](Generated& plan) {
         const std::size_t at = fast_cycle(plan, 0);
         const double start = plan.axes[0].sent[0].value;
         const double step = plan.axes[0].sent[at].value - plan.axes[0].sent[at - 1].value;
         resend(plan, [&](std::size_t k, Sent& sent) {
           sent.value =
               start + step * static_cast<double>(std::min<std::size_t>(k < 60 ? 0 : k - 60, 100));
         });
       }},
      {"values for the time of the program",
       Cause::set_point_ripple,
       {},
       [](Generated& plan) {
         resend(plan, [&](std::size_t k, Sent& sent) {
           sent.value = plan.axes[0].path(plan.planned(k + 1) + part(plan, plan.normal(0.06)));
         });
       }},
      {"coarse increments",
       Cause::coarse,
       {},
       [](Generated& plan) {
         const std::size_t at = fast_cycle(plan, 0);
         const double step =
             std::abs(plan.axes[0].sent[at].value - plan.axes[0].sent[at - 1].value);
         resend(plan,
                [&](std::size_t, Sent& sent) { sent.value = std::round(sent.value / step * 5); });
       }},
      {"rounded positions",
       Cause::coarse,
       {},
       [](Generated& plan) {
         const std::size_t at = fast_cycle(plan, 0);
         const double step =
             std::abs(plan.axes[0].sent[at].value - plan.axes[0].sent[at - 1].value);
         const double unit = std::round(std::max(2.0, step / 6));
         resend(plan, [&](std::size_t, Sent& sent) {
           sent.value = std::round(sent.value / unit) * unit;
         });
       }},
      {"an axis behind its group", Cause::lag_in_group,
       [](Recipe& recipe) { recipe.axes = std::max(2U, recipe.axes); },
       [](Generated& plan) {
         GeneratedAxis& axis = plan.axes[0];
         for (std::size_t k = 0; k < axis.sent.size(); ++k) {
           axis.sent[k].value = 500 + 0.7 * plan.axes[1].path(plan.planned(k < 2 ? 0 : k - 2));
         }
       }},
      {"60C2 not written",
       Cause::interpolation_unset,
       [](Recipe& recipe) { recipe.interpolation = 0; },
       {},
       true},
      {"no feed-forward",
       Cause::feed_forward,
       [](Recipe& recipe) {
         recipe.delay_cycles = 5 + 25e6 / static_cast<double>(recipe.period.count());
       },
       {}},
      {"a drive that oscillates",
       Cause::actual_ripple,
       {},
       [](Generated& plan) {
         const std::size_t at = fast_cycle(plan, 0);
         const double step =
             std::abs(plan.axes[0].sent[at].value - plan.axes[0].sent[at - 1].value);
         const double turn =
             2 * std::numbers::pi / (12.0 * static_cast<double>(plan.recipe.period.count()));
         plan.axes[0].shake = [=](Time t) {
           return 0.4 * step * std::sin(turn * static_cast<double>(t.count()));
         };
       }},
      {"a drive whose 606C oscillates", Cause::actual_ripple,
       [](Recipe& recipe) {
         recipe.position_shown = false;
         recipe.boot = false;
       },
       [](Generated& plan) {
         const std::size_t at = fast_cycle(plan, 0);
         const double step =
             std::abs(plan.axes[0].sent[at].value - plan.axes[0].sent[at - 1].value);
         const double turn =
             2 * std::numbers::pi / (12.0 * static_cast<double>(plan.recipe.period.count()));
         plan.axes[0].shake = [=](Time t) {
           return 0.4 * step * std::sin(turn * static_cast<double>(t.count()));
         };
       }},
      {"other frames before the set-point", Cause::bus_load,
       [](Recipe& recipe) {
         recipe.phase = 0.75;
         recipe.noise = 0.01;
         recipe.bitrate = 1'000'000;
       },
       [](Generated& plan) {
         resend(plan, [&](std::size_t k, Sent& sent) {
           if (!plan.chance(0.04)) return;
           Time t = plan.planned(k) + part(plan, 0.6);
           const Time until = plan.planned(k + 1) + part(plan, 0.1);
           for (; t < until; t += microseconds{118}) plan.others.push_back({t, 0});
           sent.when = t - microseconds{10};
         });
       }},
  };
  return list;
}

}  // namespace takt::smooth
