// SPDX-License-Identifier: GPL-3.0-or-later
#include "assignment.hpp"

#include <cassert>
#include <limits>
#include <utility>

namespace stylet {

namespace {

/// An assignment of some rows, with prices that prove that it is the cheapest of these rows: no reduced cost
/// cost − row price − column price is negative, and it is 0 where a row has its column.
class Assigning {
 public:
  explicit Assigning(const MatX& cost)
      : cost_(cost),
        row_price_(VecX::Zero(cost.rows())),
        column_price_(VecX::Zero(cost.cols())),
        column_of_(static_cast<std::size_t>(cost.rows()), -1),
        row_of_(static_cast<std::size_t>(cost.cols()), -1) {}

  /// Adds a row: Dijkstra's search over reduced costs for the nearest column that no row has, and the exchange of
  /// columns along the way to it.
  void add(Index new_row) {
    const auto columns = static_cast<Index>(cost_.cols());
    VecX way = VecX::Constant(columns, std::numeric_limits<double>::infinity());
    std::vector<Index> from(static_cast<std::size_t>(columns), -1);  // the row before each column
    std::vector<bool> settled(static_cast<std::size_t>(columns), false);
    Index row = new_row, last = -1;
    double so_far = 0.0;
    while (last < 0) {
      Index nearest = -1;
      for (Index c = 0; c < columns; ++c) {
        if (settled[at(c)]) continue;
        const double through = so_far + cost_(row, c) - row_price_[row] - column_price_[c];
        if (through < way[c]) {
          way[c] = through;
          from[at(c)] = row;
        }
        if (nearest < 0 || way[c] < way[nearest]) nearest = c;
      }
      so_far = way[nearest];
      settled[at(nearest)] = true;
      row = row_of_[at(nearest)];
      if (row < 0) last = nearest;
    }
    row_price_[new_row] += so_far;
    for (Index c = 0; c < columns; ++c) {
      if (!settled[at(c)] || c == last) continue;
      row_price_[row_of_[at(c)]] += so_far - way[c];
      column_price_[c] -= so_far - way[c];
    }
    for (Index c = last; c >= 0;) {
      const Index owner = from[at(c)];
      row_of_[at(c)] = owner;
      std::swap(c, column_of_[at(owner)]);  // the owner gives its earlier column to the row before it
    }
  }

  [[nodiscard]] const std::vector<Index>& column_of() const { return column_of_; }

 private:
  static std::size_t at(Index k) { return static_cast<std::size_t>(k); }

  const MatX& cost_;
  VecX row_price_, column_price_;
  std::vector<Index> column_of_, row_of_;  // -1: none
};

}  // namespace

std::vector<Index> cheapest_assignment(const MatX& cost) {
  assert(cost.rows() <= cost.cols());
  Assigning assigning(cost);
  for (Index row = 0; row < static_cast<Index>(cost.rows()); ++row) assigning.add(row);
  return assigning.column_of();
}

}  // namespace stylet
