// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/rate_table.hpp"

#include "stylet/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace stylet {

namespace {

constexpr double kStepsPer_mm = 8.0;  // radii of the table; knots of published tables lie on these steps
constexpr int kStepsOfAngle = 180;    // from 0° to 180°, so that knots at whole degrees lie on these steps
constexpr int kRadii = static_cast<int>(RateTable::kFar_mm * kStepsPer_mm) + 2;
constexpr std::size_t kBlock = 128;  // points that are computed together, so that their numbers stay in the cache

// GCC compiles the loop for processors with AVX2 and for all others, and chooses when the program is
// loaded. Sanitizers do not support this choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define STYLET_FOR_VECTORS __attribute__((target_clones("arch=haswell", "default")))
#else
#define STYLET_FOR_VECTORS
#endif

/// Points of one block, relative to a source.
struct Block {
  std::array<double, kBlock> x{}, y{}, z{};     // [mm] from the source
  std::array<double, kBlock> radius{};          // [mm]
  std::array<double, kBlock> cosine{}, turn{};  // of the angle to the axis; this angle in steps of the table
  std::array<double, kBlock> rate{};            // dose rate by the table
};

/// Asks for the points and rates of a later block, so that they are in the cache when their turn comes: for one source
/// and many points, waiting for memory would take as long as the computation.
void fetch_ahead(std::span<const Vec3> points, std::span<const double> rates, std::size_t begin) {
#if defined(__GNUC__)
  constexpr std::size_t kLine = 64;  // bytes of a line of the cache
  if (begin + kBlock > points.size()) return;
  const auto* point = reinterpret_cast<const char*>(points.data() + begin);
  const auto* rate = reinterpret_cast<const char*>(rates.data() + begin);
  for (std::size_t byte = 0; byte < kBlock * sizeof(Vec3); byte += kLine) __builtin_prefetch(point + byte);
  for (std::size_t byte = 0; byte < kBlock * sizeof(double); byte += kLine) __builtin_prefetch(rate + byte, 1);
#endif
}

/// The table's numbers that the loop needs.
struct TableView {
  const float* scaled;
  int angles;            // entries for each radius
  double steps_per_rad;  // 0: the angle does not matter
  bool folds;            // whether angles beyond 90° have the values of those below
  int last_radius;       // largest radius with a neighbour
};

/// Distance, angle and dose rate by the table for each point of a block. It has no branches and calls no functions, so
/// that the compiler can use vector instructions. The angle is √(1 − x) times a polynomial for x ≥ 0, the Chebyshev
/// expansion of arccos(x) / √(1 − x) up to the fifth degree, within 2e-6 rad.
STYLET_FOR_VECTORS void read_table(Block& block, const TableView& table, double ax, double ay, double az) {
  constexpr double half_turn = std::numbers::pi;
  const double beyond = table.folds ? 0.0 : 1.0;
  const double steps_per_rad = table.steps_per_rad;
  for (std::size_t p = 0; p < kBlock; ++p) {
    const double x = block.x[p], y = block.y[p], z = block.z[p];
    const double radius = std::sqrt(std::max(x * x + y * y + z * z, 1e-12));
    const double inverse = 1.0 / radius;
    const double cosine = (x * ax + y * ay + z * az) * inverse;
    block.radius[p] = radius;
    block.cosine[p] = cosine;
    const double c = std::abs(cosine) < 1.0 ? std::abs(cosine) : 1.0;
    const double root = std::sqrt(1.0 - c);
    const double acute =
        root * (((((-0.004258281 * c + 0.019150963) * c - 0.044784508) * c + 0.087813916) * c - 0.214504546) * c +
                1.570795051);
    const double turn = (acute + (cosine < 0.0 ? beyond : 0.0) * (half_turn - 2.0 * acute)) * steps_per_rad;
    block.turn[p] = turn;
    block.rate[p] = inverse * inverse;
  }
  for (std::size_t p = 0; p < kBlock; ++p) {
    const double across = block.radius[p] * kStepsPer_mm;
    const double turn = block.turn[p];
    int i = static_cast<int>(across);
    i = i < table.last_radius ? i : table.last_radius;
    const int k = static_cast<int>(turn);
    const double u = across - i;
    const double v = turn - k;
    const int at = i * table.angles + k;
    const double here = table.scaled[at], here_next = table.scaled[at + 1];
    const double there = table.scaled[at + table.angles], there_next = table.scaled[at + table.angles + 1];
    const double inner = here + v * (here_next - here);
    const double outer = there + v * (there_next - there);
    block.rate[p] *= (inner + u * (outer - inner));
  }
}

double least_factor(const std::vector<Stretch>& stretches) {
  double least = std::numeric_limits<double>::infinity();
  for (const Stretch& part : stretches) least = std::min(least, part.factor);
  return least;
}

}  // namespace

RateTable::RateTable(Tg43 tg43, std::vector<Stretch> stretches)
    : tg43_(std::move(tg43)),
      stretches_(std::move(stretches)),
      near_mm_(kNear_mm / std::min(1.0, least_factor(stretches_))),
      isotropic_(tg43_.formalism() != DoseFormalism::line2d),
      folds_(isotropic_ || tg43_.source().F_theta_deg.back() <= 90.0),
      angles_(isotropic_ ? 2 : (folds_ ? kStepsOfAngle / 2 : kStepsOfAngle) + 2),
      steps_per_rad_(isotropic_ ? 0.0 : kStepsOfAngle / std::numbers::pi) {
  scaled_.resize(static_cast<std::size_t>(kRadii) * static_cast<std::size_t>(angles_));
  // The last entries in both directions are read with weight 0 only, or not at all.
  for (int i = 0; i < kRadii; ++i) {
    const double r = i / kStepsPer_mm;
    for (int k = 0; k < angles_; ++k) {
      const double theta = std::min(k, kStepsOfAngle) * std::numbers::pi / kStepsOfAngle;
      const double rate = r < kNear_mm - 0.5 ? 0.0 : formula(r, isotropic_ ? 0.0 : std::cos(theta));
      scaled_[static_cast<std::size_t>(i * angles_ + k)] = static_cast<float>(r * r * rate);
    }
  }
}

double RateTable::formula(double r, double cos_theta) const {
  double sum = 0.0;
  for (const Stretch& part : stretches_) sum += part.share * tg43_.rate(part.factor * r, cos_theta);
  return sum;
}

double RateTable::rate(double r, double cos_theta) const {
  const Vec3 x(0.0, r * std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta)), r * cos_theta);
  double sum = 0.0;
  add({}, {&x, 1}, {&sum, 1});
  return sum;
}

void RateTable::add(const PlacedSource& source, std::span<const Vec3> points, std::span<double> rates) const {
  Block block;
  const TableView table{scaled_.data(), angles_, steps_per_rad_, folds_, kRadii - 2};
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, points.size() - begin);
    fetch_ahead(points, rates, begin + 2 * kBlock);
    for (std::size_t p = 0; p < kBlock; ++p) {
      // The last block is filled up with its last point.
      const Vec3 to = points[begin + std::min(p, count - 1)] - source.at_mm;
      block.x[p] = to.x();
      block.y[p] = to.y();
      block.z[p] = to.z();
    }
    read_table(block, table, source.axis.x(), source.axis.y(), source.axis.z());
    for (std::size_t p = 0; p < count; ++p) {
      const double r = block.radius[p];
      const bool in_table = r >= near_mm_ && r < kFar_mm;
      rates[begin + p] += source.weight * (in_table ? block.rate[p] : formula(r, block.cosine[p]));
    }
  }
}

void sum_rates(const RateTable& table, std::span<const PlacedSource> sources, std::span<const Vec3> points,
               std::span<double> rates) {
  constexpr std::size_t kPiece = 8192;
  for_each_in_parallel((points.size() + kPiece - 1) / kPiece, [&](std::size_t piece) {
    const std::size_t begin = piece * kPiece;
    const std::size_t count = std::min(kPiece, points.size() - begin);
    const std::span<double> out = rates.subspan(begin, count);
    std::fill(out.begin(), out.end(), 0.0);
    for (const PlacedSource& source : sources) table.add(source, points.subspan(begin, count), out);
  });
}

}  // namespace stylet
