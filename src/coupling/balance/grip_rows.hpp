// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/yield.hpp"

#include <span>
#include <vector>

namespace stylet {

/// The rows of GripMatrix: their directions, and the order in which they are eliminated. The three rows of a contact
/// stand for the columns of its frame: two across the needle, then one along it.
///
/// The order has three parts:
///   1. settled rows: the lateral rows of contacts whose lateral yield is zero and stays zero,
///   2. the springs' rows, two for each spring,
///   3. yielding rows: all other rows of contacts, whose yield changes between iterations.
/// Nothing allocates after construction.
class GripRows {
 public:
  /// @param most_grips largest number of contacts
  explicit GripRows(int most_grips);

  /// Sets the frame of every contact and the place of every row.
  /// @param yields one for each contact, from the base to the tip @param spring_rows two for each spring
  void arrange(std::span<const Yield> yields, Eigen::Index spring_rows);
  /// Adds a contact, whose three rows come last. @param along unit vector in LPS, third column of its frame
  void append(const Vec3& along);
  /// Removes all contacts but the first `grips`; the removed ones must have yielding rows only.
  void keep_first(int grips);

  [[nodiscard]] int grips() const { return grips_; }
  [[nodiscard]] Eigen::Index count() const { return grip_rows() + spring_rows_; }
  [[nodiscard]] Eigen::Index grip_rows() const { return 3 * static_cast<Eigen::Index>(grips_); }
  [[nodiscard]] Eigen::Index spring_rows() const { return spring_rows_; }
  [[nodiscard]] Eigen::Index settled() const { return settled_; }
  /// Rows that are not settled: the springs' and the yielding ones.
  [[nodiscard]] Eigen::Index unsettled() const { return count() - settled_; }
  [[nodiscard]] Eigen::Index first_yielding() const { return settled_ + spring_rows_; }

  /// Place in the order of elimination of a contact's row k = 0, 1, 2.
  [[nodiscard]] Eigen::Index place(int grip, int k) const {
    return place_[3 * static_cast<std::size_t>(grip) + static_cast<std::size_t>(k)];
  }
  [[nodiscard]] bool settled(int grip, int k) const { return place(grip, k) < settled_; }
  /// A contact's directions in LPS as columns.
  [[nodiscard]] const Mat3& frame(int grip) const { return frames_[static_cast<std::size_t>(grip)]; }

  /// Sorts columns from contact order into the order of elimination.
  /// @param Y (count × k) three rows for each contact in LPS, then the springs' rows @param ordered (count × k) written
  void order(const Eigen::Ref<const MatX>& Y, Eigen::Ref<MatX> ordered) const;
  /// The inverse of order(). @param Y (count × k) written
  void restore(const Eigen::Ref<const MatX>& ordered, Eigen::Ref<MatX> Y) const;

 private:
  void set_place(int grip, int k, Eigen::Index place) {
    place_[3 * static_cast<std::size_t>(grip) + static_cast<std::size_t>(k)] = place;
  }

  int grips_ = 0;
  Eigen::Index spring_rows_ = 0;
  Eigen::Index settled_ = 0;
  std::vector<Eigen::Index> place_;  ///< (3 for each contact)
  std::vector<Mat3> frames_;         ///< (one for each contact)
};

}  // namespace stylet
