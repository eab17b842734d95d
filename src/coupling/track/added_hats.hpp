// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/track/split_borders.hpp"

#include <algorithm>

namespace stylet {

/// The hats of added nodes: what they add to the compliance of the base mesh. For each split p, that is for each added
/// node, and each observable x it has
///   b_p(x)   the value of the node's hat there [1],
///   z_p(x)   b_p(x) I − Σ_j A_{p−1}(x,j) k_jp [1], which gives A(x,y) = base + Σ_p z_p(x) s_p⁻¹ z_p(y)ᵀ,
/// and of each split the flexibility s_p⁻¹ [mm/N] (TrackCompliance has the derivation). A node inside an element has no
/// border, so that there z_p = b_p I, and few b_p are not zero.
///
/// z of an observable is known for the splits up to known(); it is found split by split. Splits and observables have
/// their numbers from SplitBorders and TrackObservables. After construction nothing allocates.
class AddedHats {
 public:
  /// @param observables largest number of observables
  /// @param capacity largest number of splits
  AddedHats(int observables, int capacity);

  /// Forgets all splits, and what is known of the tip and the nodes of its element.
  void reset();

  [[nodiscard]] int count() const { return static_cast<int>(splits_.size()); }  ///< number of splits
  /// Whether a split is by a node inside an element, which has no border.
  [[nodiscard]] bool inside(int split) const { return splits_[static_cast<std::size_t>(split)].inside; }
  [[nodiscard]] const Mat3& flexibility(int split) const {
    return splits_[static_cast<std::size_t>(split)].flexibility;
  }

  /// Adds a split by a node inside an element. @param stiffness k_pp [N/mm]
  void add_inside(const Mat3& stiffness);
  /// Adds a split by a node on a face. z of its border's vertices must be known for all earlier splits. It has no
  /// flexibility before complete().
  void add_bordered(std::span<const Border> border);
  /// Finds the flexibility of the last split, once z of its border's vertices is known for it.
  /// @param stiffness k_pp [N/mm], the sum over the elements that are split
  void complete(std::span<const Border> border, const Mat3& stiffness);

  /// An observable is new: no hat reaches it and its z is not known.
  void clear(int observable);
  /// The hats at `observable` grow by those at `from`, times a weight: it is interpolated from several.
  void add_hats(int observable, int from, double weight);
  /// The observable is the node of a split, whether or not that split has been added yet.
  void set_node(int observable, int split) { hat_[at(observable, split)] = 1.0; }

  /// Splits for which z of an observable is known: those before this one.
  [[nodiscard]] int known(int observable) const { return known_[static_cast<std::size_t>(observable)]; }
  /// z_p(x) [1] (3×3). @param split less than known(), or, of the tip, not inside
  [[nodiscard]] const Mat3& z(int observable, int split) const { return z_[at(observable, split)]; }
  /// Finds z of an observable for the split known().
  /// @param base Σ_j K⁻¹(x,j) k_jp [1]: what the base compliance makes of the split's loads there; zero for a node
  /// inside
  void extend_z(int observable, const Mat3& base);
  /// z of an observable at the same place as another.
  void copy_z(int from, int to);
  /// z of an observable that is interpolated, for one split: own × I + Σ weight z(from).
  /// @param own the value there of a hat that is not interpolated
  /// @param from observables, @param weights (from)
  void interpolate_z(int observable, int split, double own, std::span<const int> from, std::span<const double> weights);

  /// s_p⁻¹ z_pᵀ [mm/N]: amplitude of a split's hat per force on an observable (3×3).
  [[nodiscard]] Mat3 amplitude(int observable, int split) const {
    if (inside(split)) return hat_[at(observable, split)] * flexibility(split);
    return flexibility(split) * z(observable, split).transpose();
  }
  /// The compliance between two observables [mm/N] (3×3). @param base the part that the base mesh has
  [[nodiscard]] Mat3 compliance(int a, int b, const Mat3& base) const;

  /// Computes the amplitudes of all hats under a unit force on an observable, for moved().
  void load(int observable);
  /// Computes the amplitudes under a unit force on an observable less those of the hats of splits with a border under
  /// the same force distributed over others, for moved(). @param from observables, @param weights (from)
  void load_beyond(int observable, std::span<const int> from, std::span<const double> weights);
  /// What the hats move an observable under the last load() or load_beyond() [mm/N] (3×3).
  [[nodiscard]] Mat3 moved(int observable) const;

 private:
  struct Split {
    Mat3 flexibility = Mat3::Zero();  ///< s_p⁻¹ [mm/N]
    bool inside = false;
  };
  /// Position in a list that has, for each of its rows (observables, or splits), an entry for each split.
  [[nodiscard]] std::size_t at(int row, int split) const { return static_cast<std::size_t>(row * capacity_ + split); }
  [[nodiscard]] Mat3 interpolated(int split, Mat3 sum, std::span<const int> from,
                                  std::span<const double> weights) const;

  int capacity_;
  bool any_border_ = false;  ///< whether a split has a border
  std::vector<Split> splits_;
  std::vector<int> known_;   ///< (observables) number of splits for which z is known
  std::vector<double> hat_;  ///< (observables × capacity) b_p
  std::vector<Mat3> z_;      ///< (observables × capacity)
  std::vector<Mat3>
      passed_on_;  ///< (capacity × capacity) s_q⁻¹ Σ_j z_q(j)ᵀ k_jp at (p,q): what load p makes of hat q < p
  std::vector<Mat3> amplitude_;  ///< (capacity) [mm/N] of each hat under the last load
};

}  // namespace stylet
