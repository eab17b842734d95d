// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/deadline_histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <thread>
#include <type_traits>
#include <vector>

using namespace stylet;

static_assert(std::is_trivially_copyable_v<DeadlineHistogram>);

namespace {

/// The quantile computed by sorting.
std::int64_t exact_quantile(std::vector<std::int64_t> values, double q) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

/// Random durations up to 1000 s with a uniform distribution of their logarithm.
std::vector<std::int64_t> durations(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(0.0, 12.0);
  std::vector<std::int64_t> values;
  for (int k = 0; k < count; ++k) values.push_back(static_cast<std::int64_t>(std::pow(10.0, exponent(random))));
  return values;
}

}  // namespace

TEST(DeadlineHistogram, one_value_comes_back_within_its_resolution_and_the_largest_exactly) {
  std::vector<std::int64_t> values = durations(1, 3000);
  for (std::int64_t v = 0; v < 5000; ++v) values.push_back(v);
  auto other = std::make_unique<DeadlineHistogram>();
  for (const std::int64_t v : values) {
    *other = DeadlineHistogram();
    other->add(v);
    other->add(DeadlineHistogram::kRange_ns);  // so that the quantile is not limited by the largest value
    const std::int64_t found = other->quantile_ns(0.5);
    ASSERT_GE(found, v);
    ASSERT_LE(found - v, v / 64) << v;
    ASSERT_EQ(other->largest_ns(), DeadlineHistogram::kRange_ns);
  }
}

TEST(DeadlineHistogram, quantiles_are_those_of_the_sorted_values_within_2_percent) {
  const std::vector<std::int64_t> values = durations(2, 20'000);
  DeadlineHistogram histogram;
  for (const std::int64_t v : values) histogram.add(v);
  EXPECT_EQ(histogram.count(), 20'000);
  for (const double q : {0.0, 0.001, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const std::int64_t exact = exact_quantile(values, q);
    const std::int64_t found = histogram.quantile_ns(q);
    EXPECT_GE(found, exact) << q;
    EXPECT_LE(static_cast<double>(found - exact), 0.02 * static_cast<double>(exact)) << q;
  }
  EXPECT_EQ(histogram.quantile_ns(1.0), *std::max_element(values.begin(), values.end()));
}

TEST(DeadlineHistogram, counts_what_does_not_exceed_a_duration_within_the_width_of_a_bin) {
  const std::vector<std::int64_t> values = durations(5, 20'000);
  DeadlineHistogram histogram;
  for (const std::int64_t v : values) histogram.add(v);
  for (const std::int64_t limit : {0L, 63L, 1000L, 50'000L, 1'000'000L}) {
    const auto exact = [&](double factor) {
      return std::count_if(values.begin(), values.end(), [&](std::int64_t v) {
        return static_cast<double>(v) <= factor * static_cast<double>(limit);
      });
    };
    EXPECT_LE(histogram.up_to(limit), exact(1.0)) << limit;
    EXPECT_GE(histogram.up_to(limit), exact(0.98)) << limit;
  }
  EXPECT_EQ(histogram.up_to(histogram.largest_ns()), 20'000);
  EXPECT_EQ(DeadlineHistogram().up_to(5), 0);
}

TEST(DeadlineHistogram, merging_is_adding_all_to_one) {
  DeadlineHistogram one(1000);
  DeadlineHistogram other(1000);
  DeadlineHistogram all(1000);
  for (const std::int64_t v : durations(3, 1000)) {
    one.add(v);
    all.add(v);
  }
  for (const std::int64_t v : durations(4, 500)) {
    other.add(v);
    all.add(v);
  }
  one.merge(other);
  EXPECT_EQ(one.count(), all.count());
  EXPECT_EQ(one.largest_ns(), all.largest_ns());
  EXPECT_EQ(one.misses(), all.misses());
  for (double q = 0.0; q <= 1.0; q += 0.01) EXPECT_EQ(one.quantile_ns(q), all.quantile_ns(q));
}

TEST(DeadlineHistogram, only_durations_beyond_the_deadline_are_misses) {
  DeadlineHistogram histogram(1'000'000);
  for (const std::int64_t v : {0L, 999'999L, 1'000'000L, 1'000'001L, 5'000'000L}) histogram.add(v);
  EXPECT_EQ(histogram.misses(), 2);
  DeadlineHistogram none;
  none.add(5'000'000'000);
  EXPECT_EQ(none.misses(), 0);
}

TEST(DeadlineHistogram, negative_and_endless_durations_are_counted) {
  DeadlineHistogram histogram;
  histogram.add(-5);
  EXPECT_EQ(histogram.quantile_ns(1.0), 0);
  histogram.add(std::int64_t{1} << 60);
  EXPECT_EQ(histogram.count(), 2);
  EXPECT_EQ(histogram.largest_ns(), std::int64_t{1} << 60);
  EXPECT_EQ(histogram.quantile_ns(1.0), std::int64_t{1} << 60);
  EXPECT_EQ(histogram.quantile_ns(0.5), 0);
}

TEST(DeadlineHistogram, a_snapshot_taken_while_another_thread_adds_is_consistent) {
  auto histogram = std::make_unique<DeadlineHistogram>(1'000'000);
  constexpr std::int64_t kAdds = 300'000;
  std::thread writer([&] {
    for (std::int64_t k = 0; k < kAdds; ++k) histogram->add(k);
  });
  std::int64_t last = 0;
  while (last < kAdds) {
    const DeadlineHistogram copy = histogram->snapshot();
    ASSERT_GE(copy.count(), last);
    last = copy.count();
    ASSERT_LE(copy.quantile_ns(1.0), kAdds);
  }
  writer.join();
  EXPECT_EQ(histogram->snapshot().largest_ns(), kAdds - 1);
}
