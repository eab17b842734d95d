// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/dose_bench.hpp"

#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/rate_table.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

namespace stylet::measure {

namespace {

template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Work>
double median_seconds(int repeats, const Work& work) {
  std::vector<double> times;
  for (int k = 0; k < std::max(1, repeats); ++k) times.push_back(seconds_of(work));
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

/// Sums by the table in pieces of points that stay in the cache, as sum_rates() does, but on one core.
void sum_in_pieces(const RateTable& table, std::span<const PlacedSource> sources, std::span<const Vec3> points,
                   std::span<double> rates) {
  constexpr std::size_t piece = 8192;
  std::fill(rates.begin(), rates.end(), 0.0);
  for (std::size_t begin = 0; begin < points.size(); begin += piece) {
    const std::size_t count = std::min(piece, points.size() - begin);
    for (const PlacedSource& source : sources)
      table.add(source, points.subspan(begin, count), rates.subspan(begin, count));
  }
}

}  // namespace

Result<std::vector<DoseRow>> bench_dose(const DoseBenchOptions& options, const Progress& progress) {
  constexpr double half_box_mm = 25.0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-half_box_mm, half_box_mm);
  const auto anywhere = [&] { return Vec3(place(random), place(random), place(random)); };
  std::vector<PlacedSource> sources(options.sources);
  for (PlacedSource& source : sources) source = {anywhere(), anywhere().normalized(), 0.5};
  std::vector<Vec3> points(options.points);
  for (Vec3& point : points) point = anywhere();

  const Result<SourceModel> model = find_source("i125_6711");
  if (!model) return model.error();
  std::vector<DoseRow> rows;
  std::vector<double> exact(points.size()), quick(points.size());
  for (const DoseFormalism formalism : {DoseFormalism::line2d, DoseFormalism::line1d, DoseFormalism::point}) {
    const Result<Tg43> tg43 = Tg43::create(*model, formalism);
    if (!tg43) return tg43.error();
    DoseRow row;
    row.formalism = to_string(formalism);
    row.sources = sources.size();
    row.points = points.size();
    row.make_table_s = median_seconds(options.repeats, [&] { const RateTable made(*tg43); });
    const RateTable table(*tg43);
    row.exact_s = seconds_of([&] { sum_rates(*tg43, sources, points, exact); });
    row.table_s = median_seconds(options.repeats, [&] { sum_in_pieces(table, sources, points, quick); });
    for (std::size_t p = 0; p < points.size(); ++p)
      row.worst_percent = std::max(row.worst_percent, 100.0 * std::abs(quick[p] / exact[p] - 1.0));
    row.one_more_s = median_seconds(options.repeats, [&] { table.add(sources.front(), points, quick); });
    rows.push_back(row);
    report(progress, "dose rates", static_cast<double>(rows.size()) / 3.0);
  }
  return rows;
}

}  // namespace stylet::measure
