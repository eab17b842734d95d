// SPDX-License-Identifier: GPL-3.0-or-later
#include "interrupted_implant.hpp"

#include "stylet/core/survive.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>

namespace stylet::serve {

namespace {

std::int64_t written_s(const std::filesystem::path& file) {
  std::error_code code;
  const auto written = std::filesystem::last_write_time(file, code);
  if (code) return 0;
  const auto since = std::chrono::file_clock::to_sys(written).time_since_epoch();
  return std::chrono::duration_cast<std::chrono::seconds>(since).count();
}

InterruptedImplant interrupted_at(const Shelf& shelf, const std::string& name, const RecordingHead& head,
                                  std::vector<SeedHistory> seeds) {
  const RecordedPlan& plan = head.implant->plan;
  InterruptedImplant out{.recording = name,
                         .recorded_s = written_s(shelf.folder(name) / "run.h5"),
                         .seeds = std::move(seeds),
                         .needle = 0,
                         .name = plan.implant,
                         .tally = plan.before};
  out.needle = plan.current >= 0 ? static_cast<std::size_t>(plan.current) : out.seeds.back().needle;
  TallyOfNeedle tally;
  for (const Event& event : head.events) tally.add(event, out.tally);
  return out;
}

}  // namespace

std::optional<InterruptedImplant> find_interrupted(const Shelf& shelf, const RecordedPlan& plan,
                                                   const std::atomic<bool>& given_up) {
  constexpr std::size_t kAtOnce = 16;  // an implant is mostly among the newest recordings
  const std::string wanted = digest_of_plan(plan);
  std::vector<std::string> names = shelf.names();
  std::erase_if(names, [](const std::string& name) { return !Shelf::is_own_name(name); });  // others have no order
  for (std::size_t from = 0; from < names.size() && !given_up; from += kAtOnce) {
    const auto some = std::span(names).subspan(from, std::min(kAtOnce, names.size() - from));
    const auto heads = shelf.heads(some);
    for (std::size_t k = 0; k < some.size(); ++k) {
      if (!heads[k] || !heads[k]->implant) continue;
      const RecordedImplant& implant = *heads[k]->implant;
      if (implant.acts.empty() || digest_of_plan(implant.plan) != wanted) continue;
      std::vector<SeedHistory> seeds = implant.seeds_after(implant.acts.size());
      if (seeds.empty() || seeds.size() >= plan.seeds.size()) return std::nullopt;
      return interrupted_at(shelf, some[k], *heads[k], std::move(seeds));
    }
  }
  return std::nullopt;
}

ImplantSearch::ImplantSearch(Shelf shelf, const RecordedPlan& plan)
    : thread_([this, shelf = std::move(shelf), plan] {
        survive(
            "the search for an interrupted implant", [&] { found_ = find_interrupted(shelf, plan, given_up_); },
            [this](const Error& /*why*/) { found_.reset(); });
        done_.store(true, std::memory_order_release);
      }) {}

}  // namespace stylet::serve
