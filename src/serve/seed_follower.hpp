// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "seed_forecast.hpp"
#include "stylet/realtime/tissue_probe.hpp"
#include "stylet/sim/display_field.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace stylet::serve {

/// Drops seeds in a running loop and follows dropped seeds as the tissue moves. Seeds of the needle in the patient are
/// followed with its near field (TissueProbe); seeds of other needles, which lie some millimetres away, with the
/// displacement of the pictures. All calls from one thread, except that the loop answers the probe.
class SeedFollower {
 public:
  explicit SeedFollower(std::shared_ptr<const Model> model);

  /// To be answered by the loop.
  [[nodiscard]] const std::shared_ptr<TissueProbe>& probe() const { return probe_; }

  /// Orders that the next seed is pushed out of the tip. @param beyond_tip_mm distance of its centre from the tip
  void order_drop(double beyond_tip_mm);
  /// Orders that a train is left as the needle is drawn back (TissueProbe::order_train()).
  void order_train(std::span<const double> behind_tip_mm, double half_length_mm);
  /// Leaves the rest of the train in the needle.
  void call_off();
  /// Number of seeds that have been ordered and not been taken.
  [[nodiscard]] std::size_t dropping() const { return dropping_; }
  /// Depth of the base [mm] at which the loop has begun what was ordered; empty: nothing is being dropped, or the loop
  /// has not taken up the order.
  [[nodiscard]] std::optional<double> began_at_mm();
  /// The next of the ordered drops, once the loop has found its place; then it is taken. If the tip was not in the
  /// tissue, the other seeds of the order are not dropped either.
  [[nodiscard]] std::optional<ProbedDrop> take_drop();

  /// Sets the seeds to follow. @param rest_mm [mm] LPS, in the tissue at rest
  /// @param own indices of the seeds that the needle in the patient has dropped
  void set(std::vector<Vec3> rest_mm, std::vector<std::size_t> own);
  /// Moves the seeds by the displacement of a picture.
  void follow(const DisplayField& field, DisplayField::Load& load);
  /// Where the seeds are now [mm] LPS.
  [[nodiscard]] std::vector<Vec3> now_mm();
  /// The same; empty if no seed has moved by more than 0.01 mm since the last call.
  [[nodiscard]] std::optional<std::vector<Vec3>> news();

  /// Asks where a seed would rest that left the needle now (SeedForecast::aim()).
  void foretell(const std::optional<SeedForecast::Places>& now);
  [[nodiscard]] const SeedForecast& forecast() const { return forecast_; }

 private:
  void watch();
  void take_answer();

  std::shared_ptr<const Model> model_;
  std::shared_ptr<TissueProbe> probe_;
  std::uint32_t ordered_ = 0;  ///< number of the last order
  std::size_t dropping_ = 0;
  std::size_t taken_ = 0;  ///< seeds of the last order that have been taken
  std::vector<Vec3> rest_;
  std::vector<MaterialPoint> at_;          ///< of each seed; outside of the mesh without an element
  std::vector<Index> nodes_;               ///< four for each seed that has an element
  std::vector<Vec3> moved_;                ///< displacement of each seed [mm]
  std::vector<std::size_t> watched_;       ///< seeds that the probe watches
  std::vector<std::optional<Vec3>> near_;  ///< where the probe saw them last
  SeedForecast forecast_;                  ///< its point is the first that the probe watches, so the last it looks at
  std::uint32_t version_ = 0;              ///< of the points that the probe watches
  std::vector<Vec3> told_;                 ///< the places of the last news
  bool is_new_ = true;                     ///< other seeds since the last news
};

}  // namespace stylet::serve
