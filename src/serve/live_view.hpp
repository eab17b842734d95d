// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "open_model.hpp"
#include "seed_follower.hpp"
#include "stylet/serve/picture.hpp"
#include "stylet/sim/display_near_field.hpp"

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace stylet::serve {

/// The displacement of the scene's points in the pictures of a live run. It is computed for the newest state of the
/// loop, as often as a share of the thread's time allows.
class TissueView {
 public:
  explicit TissueView(const OpenModel& open);

  /// Sets the displacement field. Without it nothing is shown.
  void set_field(std::shared_ptr<const DisplayField> field);
  [[nodiscard]] bool has_field() const { return load_.has_value(); }
  [[nodiscard]] const DisplayField& field() const { return *field_; }
  [[nodiscard]] DisplayField::Load& load() { return *load_; }

  /// Takes the forces of the newest state; there must be a field.
  void set(std::span<const TissueForce> forces) { field_->set(forces, *load_); }
  /// Says that there is a state whose displacement has not been computed.
  void owe() { is_owed_ = true; }
  /// Whether such a displacement may be computed now.
  [[nodiscard]] bool is_due() const;
  /// Computes the displacement, of the seeds too, by the forces of the last set(). @param forces the same forces
  void compute(std::span<const TissueForce> forces, SeedFollower& seeds);
  /// [mm] (3 × points of the scene)
  [[nodiscard]] const Eigen::Matrix3Xf& shown() const { return shown_; }
  /// Whether pages would see that it differs from what they were last told.
  [[nodiscard]] bool has_moved() const;
  /// shown(), of which pages are told now.
  const Eigen::Matrix3Xf& tell() { return told_ = shown_; }
  /// Whether it has changed since the last call.
  [[nodiscard]] bool take_anew() { return std::exchange(is_anew_, false); }
  /// The larger of the forces [N] whose far field, and whose near field, is not shown.
  [[nodiscard]] double left_out_N() const;

 private:
  ScenePoints points_;
  std::shared_ptr<const DisplayField> field_;
  std::optional<DisplayField::Load> load_;  ///< set if there is a field
  DisplayNearField near_;                   ///< near field at the points of the scene
  Eigen::Matrix3Xf shown_;
  Eigen::Matrix3Xf told_;  ///< what pages know; empty: nothing
  bool is_owed_ = false;
  bool is_computed_ = false;  ///< at least once
  bool is_anew_ = false;
  double after_s_ = 0.0;  ///< wall-clock time after which the next displacement may be computed
};

/// The force curve of a live run for pages.
class LiveCurve {
 public:
  void add(const Step& step);
  void thin();
  /// The steps since the last call, or all, thinned.
  std::vector<Step> take(bool whole);

 private:
  std::vector<Step> unsent_;
  std::vector<Step> all_;
};

}  // namespace stylet::serve
