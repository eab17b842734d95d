// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/track/split_borders.hpp"

#include <algorithm>

namespace stylet {

/// The hats of added nodes, and their contribution to the compliance. A split stands for one added node p. For each
/// split and each observable x the class holds
///   b_p(x)   the value of the node's hat there [1],
///   z_p(x)   b_p(x) I − Σ_j A_{p−1}(x,j) k_jp [1], which gives A(x,y) = base + Σ_p z_p(x) s_p⁻¹ z_p(y)ᵀ,
/// and for each split the flexibility s_p⁻¹ [mm/N] (TrackCompliance has the derivation). A node inside an element has
/// no border, so that z_p = b_p I for it, and few b_p are not zero.
///
/// z of an observable is known for the splits before known() and is computed split by split. Splits and observables
/// have their numbers from SplitBorders and TrackObservables. After construction nothing allocates.
class AddedHats {
 public:
  /// @param observables largest number of observables
  /// @param capacity largest number of splits
  AddedHats(int observables, int capacity);

  /// Removes all splits, and the values of the tip and of the nodes of its element.
  void reset();

  [[nodiscard]] int count() const { return static_cast<int>(splits_.size()); }  ///< number of splits
  /// Whether the node of a split is inside an element and has no border.
  [[nodiscard]] bool inside(int split) const { return splits_[static_cast<std::size_t>(split)].inside; }
  [[nodiscard]] const Mat3& flexibility(int split) const {
    return splits_[static_cast<std::size_t>(split)].flexibility;
  }

  /// Adds a split by a node inside an element. @param stiffness k_pp [N/mm]
  void add_inside(const Mat3& stiffness);
  /// Adds a split by a node on a face. z of its border's vertices must be known for all earlier splits. Its flexibility
  /// is set by complete().
  void add_bordered(std::span<const Border> border);
  /// Computes the flexibility of the last split, after z of its border's vertices is known for this split.
  /// @param stiffness k_pp [N/mm], summed over the elements that are split
  void complete(std::span<const Border> border, const Mat3& stiffness);

  /// Resets a new observable: its hats are zero and its z is not known.
  void clear(int observable);
  /// Adds `weight` × the hats at `from` to the hats at `observable`, which is interpolated from several observables.
  void add_hats(int observable, int from, double weight);
  /// Makes an observable the node of a split, which may be added later.
  void set_node(int observable, int split) { hat_[at(observable, split)] = 1.0; }

  /// Number of splits, from the first, for which z of an observable is known.
  [[nodiscard]] int known(int observable) const { return known_[static_cast<std::size_t>(observable)]; }
  /// z_p(x) [1] (3×3). @param split less than known(); for the tip, a split with a border
  [[nodiscard]] const Mat3& z(int observable, int split) const { return z_[at(observable, split)]; }
  /// Computes z of an observable for the split number known().
  /// @param base Σ_j K⁻¹(x,j) k_jp [1]: displacement of the base mesh by the split's loads; zero for a node inside an
  /// element
  void extend_z(int observable, const Mat3& base);
  /// Copies z to an observable at the same place.
  void copy_z(int from, int to);
  /// Interpolates z of an observable for one split: own × I + Σ weight z(from).
  /// @param own value there of the split's own hat, which is not interpolated
  /// @param from observables @param weights (from)
  void interpolate_z(int observable, int split, double own, std::span<const int> from, std::span<const double> weights);

  /// s_p⁻¹ z_pᵀ [mm/N] (3×3): amplitude of a split's hat per force on an observable.
  [[nodiscard]] Mat3 amplitude(int observable, int split) const {
    if (inside(split)) return hat_[at(observable, split)] * flexibility(split);
    return flexibility(split) * z(observable, split).transpose();
  }
  /// The compliance between two observables [mm/N] (3×3). @param base compliance of the base mesh between them
  [[nodiscard]] Mat3 compliance(int a, int b, const Mat3& base) const;

  /// Computes the amplitudes of all hats under a unit force on an observable, for moved().
  void load(int observable);
  /// Computes, for moved(), the amplitudes under a unit force on an observable; from hats of splits with a border it
  /// subtracts their amplitudes under the same force distributed over other observables.
  /// @param from observables @param weights (from)
  void load_beyond(int observable, std::span<const int> from, std::span<const double> weights);
  /// Displacement of an observable by the hats, under the last load() or load_beyond() [mm/N] (3×3).
  [[nodiscard]] Mat3 moved(int observable) const;

 private:
  struct Split {
    Mat3 flexibility = Mat3::Zero();  ///< s_p⁻¹ [mm/N]
    bool inside = false;
  };
  /// Index in a list that has an entry for each row (observable, or split) and each split.
  [[nodiscard]] std::size_t at(int row, int split) const { return static_cast<std::size_t>(row * capacity_ + split); }
  [[nodiscard]] Mat3 interpolated(int split, Mat3 sum, std::span<const int> from,
                                  std::span<const double> weights) const;

  int capacity_;
  bool any_border_ = false;  ///< whether any split has a border
  std::vector<Split> splits_;
  std::vector<int> known_;   ///< (observables) number of splits for which z is known
  std::vector<double> hat_;  ///< (observables × capacity) b_p
  std::vector<Mat3> z_;      ///< (observables × capacity)
  std::vector<Mat3>
      passed_on_;  ///< (capacity × capacity) s_q⁻¹ Σ_j z_q(j)ᵀ k_jp at (p,q): what load p makes of hat q < p
  std::vector<Mat3> amplitude_;  ///< (capacity) [mm/N] of each hat under the last load
};

}  // namespace stylet
