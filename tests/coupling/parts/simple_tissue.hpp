// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <memory>

namespace stylet::test {

/// Tissue whose points are displaced by their own force only, so that expected results can be computed by hand.
class SimpleCompliance : public ContactCompliance {
 public:
  static constexpr int kRoom = 40;

  explicit SimpleCompliance(double own_mm_per_N) : own_(own_mm_per_N) {
    A_ = MatX::Zero(3 * kRoom, 3 * kRoom);
    A_.topLeftCorner<3, 3>().diagonal().setConstant(own_);
  }

  bool has_all = true;  ///< whether no compliance is missing
  int forced = 0;       ///< number of calls of enter_by()

  Added add(const MaterialPoint&, const Vec3&, Placement, const Vec3& = Vec3::Zero()) override {
    if (!has_all) return {-1, Refusal::missing};
    if (points_ == kRoom) return {-1, Refusal::capacity};
    A_.block<3, 3>(3 * points_, 3 * points_).diagonal().setConstant(own_);
    ++version_;
    return {points_++, Refusal::none};
  }
  bool move_tip(const MaterialPoint&, const Vec3&) override { return has_all; }
  void enter_by(double, const Vec3&) override { ++forced; }
  [[nodiscard]] bool available(Index) const override { return has_all; }
  void remove_last_embedded() override { --points_; }
  void reset() override { points_ = 1; }
  [[nodiscard]] Mat3 gradient_at_tip(const Eigen::Ref<const MatX>&) const override { return Mat3::Zero(); }
  [[nodiscard]] VecX displacement(const Eigen::Ref<const MatX>&) const override { return {}; }
  [[nodiscard]] Nodes nodes(const Eigen::Ref<const MatX>&) const override { return {}; }
  [[nodiscard]] std::span<const RemeshEvent> remeshing() const override { return {}; }

 private:
  double own_;
};

/// A needle that never bends: 100 mm along its base's z.
class StraightNeedle : public Needle {
 public:
  [[nodiscard]] double length() const override { return 100.0; }
  [[nodiscard]] std::string model() const override { return "straight"; }
  void set_base(const Pose& base) override { base_ = base; }
  [[nodiscard]] const Pose& base() const override { return base_; }
  [[nodiscard]] Vec3 point(double s) const override { return base_.origin + s * tangent(s); }
  [[nodiscard]] Vec3 tangent(double) const override { return base_.rotation * Vec3::UnitZ(); }
  bool linearise(std::span<const PointLoad>, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free, std::span<const Mat3>,
                 Indefinite) override {
    compliance.setZero();
    free.setZero();
    return true;
  }
  bool relax(std::span<const PointLoad>, Eigen::Ref<VecX> free) override {
    free.setZero();
    return true;
  }
  void advance(std::span<const PointLoad>) override {}
  [[nodiscard]] double residual(std::span<const PointLoad>) override { return 0.0; }
  void straighten() override {}
  [[nodiscard]] double energy() const override { return 0.0; }
  [[nodiscard]] Eigen::Ref<const VecX> state() const override { return state_; }
  void set_state(const Eigen::Ref<const VecX>& state) override { state_ = state; }

 private:
  Pose base_;
  VecX state_ = VecX::Zero(4);
};

/// A block of two layers, 40 mm wide: "body" from the skin at z = 0 to z = 20 mm, "organ" to z = 40 mm; and a straight
/// needle whose tip is placed by put_tip().
struct SimpleTissue {
  static constexpr double kOwn = 2.0;  ///< [mm/N]

  explicit SimpleTissue(const Creep& creep = {}) {
    settings.creep = creep;
    settings.capacity = SimpleCompliance::kRoom - 1;
    mesh = box_mesh(Vec3(-20, -20, 0), Vec3(20, 20, 40), {4, 4, 4}, 0.0);
    assign_regions(mesh, {"body", "organ"}, [](const Vec3& x) { return x.z() > 20.0 ? 1 : 0; });
    topology = std::make_unique<Topology>(mesh);
    locator = std::make_unique<Locator>(mesh, *topology);
    insertion.locator = locator.get();
    insertion.laws = {{0.3, 1.0, {18e-3, 11e-3, 250e-6, 50.0}, false, true, -1},
                      {0.2, 0.8, {20e-3, 12e-3, 250e-6, 50.0}, false, false, 0}};
    auto made = std::make_unique<SimpleCompliance>(kOwn);
    compliance = made.get();
    tissue = std::make_unique<TissueResponse>(std::move(made), creep, settings.needle_radius_mm,
                                              SimpleCompliance::kRoom - 1);
  }

  /// Places the needle along `axis`, with its tip at x [mm].
  void put_tip(const Vec3& x, const Vec3& axis = Vec3::UnitZ()) {
    Pose pose;
    pose.rotation = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis);
    pose.origin = x - needle.length() * axis.normalized();
    needle.set_base(pose);
  }

  [[nodiscard]] MaterialPoint at(const Vec3& x) const { return locator->find(x).value(); }

  CouplingSettings settings;
  TetMesh mesh;
  std::unique_ptr<Topology> topology;
  std::unique_ptr<Locator> locator;
  InsertionTissue insertion;
  SimpleCompliance* compliance = nullptr;
  std::unique_ptr<TissueResponse> tissue;
  StraightNeedle needle;
};

}  // namespace stylet::test
