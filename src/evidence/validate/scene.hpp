// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/validate/row.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/sim/simulation.hpp"

#include <Eigen/Geometry>

#include <array>
#include <functional>

namespace stylet::validate {

/// A block of tissue, by default 100 mm wide and deep, with its skin at z = 0, in a box of rigid wall that is open at
/// the skin, and a needle along z. It is compiled from a Scenario, so it uses all default values.
struct Block {
  Vec3 lo{-50, -50, 0};  ///< [mm] corners lo and hi of the soft part; the wall is one cell thick
  Vec3 hi{50, 50, 100};
  std::array<int, 3> cells{8, 8, 8};  ///< number of cells of the soft part
  double jitter = 0.1;
  double gland_radius_mm = 20.0;  ///< radius of a ball of region "prostate"; 0: no ball
  Vec3 gland_centre{0, 0, 45};    ///< [mm] centre of the ball
  std::array<double, 3> entry_mm{3, 2, 0};
  std::array<double, 3> direction{0, 0, 1};
  double depth_mm = 60.0;                                 ///< depth to which compliance is prepared
  Eigen::Affine3d placing = Eigen::Affine3d::Identity();  ///< rigid motion or reflection of the whole scene
  Scenario scenario;  ///< all settings except patient, supports and insertions, which compile() sets

  /// A block without the ball of the gland.
  static Block of_one_tissue(TissuePreset preset = Scenario{}.tissue_model.preset);

  /// The tissue parameters of a region of the block, for changing them.
  TissueParameters& tissue(const std::string& region);
  [[nodiscard]] TetMesh mesh() const;
  /// @param more entry points of further insertions in the same direction
  [[nodiscard]] Result<std::shared_ptr<const Model>> compile(const std::vector<std::array<double, 3>>& more = {}) const;
};

/// The result of a step of a drive.
struct DriveStep {
  Step record;
  Vec3 hand_force = Vec3::Zero();  ///< [N] LPS
  int shaft_contacts = 0;
  double work_Nmm = 0.0;  ///< work of the hand since the start; the base is only translated
};

/// Moves the needle of a model in and out and keeps every step.
class Drive {
 public:
  /// @param start_mm base depth at the start
  /// @param insertion index of the planned insertion whose line the needle follows
  explicit Drive(std::shared_ptr<const Model> model, double start_mm = -1.0, std::size_t insertion = 0);

  /// Places the needle in front of another insertion's entry. The needle should be out of the tissue.
  void aim(std::size_t insertion, double start_mm = -1.0);
  /// Moves the base along the line to a depth [mm] at a speed [mm/s].
  void go(double to_mm, double speed_mm_per_s = 20.0, double dt_s = 1e-3);
  void wait(double seconds, double dt_s = 1e-3);
  /// Moves the base sideways [mm] LPS in one step.
  void shift(const Vec3& sideways, double dt_s = 1e-3);

  [[nodiscard]] const std::vector<DriveStep>& steps() const { return steps_; }
  [[nodiscard]] const DriveStep& last() const { return steps_.back(); }
  [[nodiscard]] const std::vector<Event>& events() const { return events_; }
  [[nodiscard]] const Event* event(EventKind kind) const;
  [[nodiscard]] unsigned flags() const { return flags_; }
  [[nodiscard]] double peak_N() const;  ///< largest absolute axial force
  [[nodiscard]] const Simulation& simulation() const { return simulation_; }
  [[nodiscard]] const Insertion& insertion() const { return simulation_.insertion(); }

 private:
  void step(double dt_s);
  [[nodiscard]] Pose pose() const;

  std::shared_ptr<const Model> model_;
  Simulation simulation_;
  std::size_t number_ = 0;
  double depth_mm_ = -1.0;
  Vec3 sideways_ = Vec3::Zero();
  Pose base_;
  std::vector<DriveStep> steps_;
  std::vector<Event> events_;
  unsigned flags_ = 0;
};

/// A quantity in all steps of a drive over another one: the axial force over the base depth by default.
Curve curve_of(const Drive& drive, const std::string& label, double Step::*over = &Step::base_depth_mm,
               double Step::*quantity = &Step::force_axial_N);

}  // namespace stylet::validate
