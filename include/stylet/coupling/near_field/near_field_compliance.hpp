// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/near_field/near_place.hpp"
#include "stylet/coupling/tip_element.hpp"
#include "stylet/fem/tissue.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace stylet {

/// Compliance among contact points with the near field of the needle corrected. Elements cannot represent the field of
/// a needle that is thinner than they are. So the mesh's approximation of that field is subtracted from K⁻¹, and the
/// field itself is added in closed form:
///   A(c,d) = Λ_c (K⁻¹ − g) Λ_dᵀ + ⟨G⟩(c,d),
/// with the mesh's own kernel g (MeshKernel) and the medium's kernel ⟨G⟩, averaged over the pieces of the needle. K⁻¹ −
/// g is smooth, so any mesh represents it; ⟨G⟩ does not depend on the mesh.
///
/// Near the planned paths of a needle, in tissue that stiffens or creeps, the compliance is instead
///   A(c,d) = F(c,d) + ⟨G⟩(c,d) − G₁₀(c,d),
/// where F is the displacement by forces that are spread over 10 mm (SpreadCompliance), which does not depend on the
/// elements, and G₁₀ is the medium's kernel for such forces. docs/theory/near_field.md derives both.
///
/// Points are interpolated, whatever placement is requested; the mesh does not change.
class NearFieldCompliance final : public ContactCompliance {
 public:
  /// @param far compliance from the engine that holds K⁻¹, for the part Λ K⁻¹ Λᵀ; it must not have points yet
  /// @param kernel of the tissue's mesh
  /// @param stiffening_MPa (regions) k₂ of DentLaw; empty: no tissue stiffens
  /// @param creeps whether wide() is computed even if no tissue stiffens
  /// @param spread the wide part along the planned paths of the needle; null: computed from K⁻¹ everywhere
  NearFieldCompliance(std::unique_ptr<ContactCompliance> far, std::shared_ptr<const Tissue> tissue,
                      std::shared_ptr<const MeshKernel> kernel, const NeedleKernel& needle, int capacity,
                      std::vector<double> stiffening_MPa = {}, bool creeps = false,
                      std::shared_ptr<const SpreadCompliance> spread = nullptr);

  /// @param travel direction of the contact's piece of needle; zero: a point
  Added add(const MaterialPoint& at, const Vec3& x, Placement placement, const Vec3& travel = Vec3::Zero()) override;
  bool move_tip(const MaterialPoint& at, const Vec3& x) override;
  void restrict_tip(std::span<const int> points) override {
    far_->restrict_tip(points);
    tip_neighbours_.restrict(points, [&](int point) { write_tip(point); });
  }
  void renew_tip(std::span<const int> points) override {
    far_->renew_tip(points);
    for (const int point : points) write_tip(point);
  }
  void release_tip() override {
    far_->release_tip();
    tip_neighbours_.release(points_, [&](int point) { write_tip(point); });
  }
  void begin_sub_step() override { wide_at_.reset(); }
  void enter_by(double force, const Vec3& direction) override {
    press_N_ = force;
    entry_ = direction;
  }
  void change_needle() override {
    ground_.way = -1;
    wide_at_.reset();
    press_N_ = 0.0;
  }
  [[nodiscard]] bool available(Index base_tet) const override;
  void mark_nodes(std::span<unsigned> stamps, unsigned stamp) const override;
  void remove_last_embedded() override;
  void reset() override;

  /// Gradient of the far field only, which the mesh represents.
  [[nodiscard]] Mat3 gradient_at_tip(const Eigen::Ref<const MatX>& forces) const override;

  /// Includes the near field at the nodes that lie in it, and the dent under the tip with its stiffening.
  [[nodiscard]] VecX displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] VecX wide_displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] VecX mesh_displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] double softness(int point) const override { return softness_[static_cast<std::size_t>(point)]; }
  [[nodiscard]] Nodes nodes(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] Moment moment(const Eigen::Ref<const MatX>& present,
                              const Eigen::Ref<const MatX>& lasting) const override;
  [[nodiscard]] std::span<const RemeshEvent> remeshing() const override { return {}; }

 private:
  [[nodiscard]] Mat3 of_mesh_at_tip(int point, int medium);
  template <class Correction>
  void add_corrections(const Eigen::Ref<const MatX>& forces, const Correction& correction, VecX& u) const;
  void add_near(const Eigen::Ref<const MatX>& forces, VecX& u) const;
  void add_wide(const Eigen::Ref<const MatX>& forces, VecX& u) const;
  template <class OfMesh>
  void write_block(int point, int other, const OfMesh& g);
  template <class OfMesh>
  void write_wide_block(int point, int other, const OfMesh& g);
  /// Share 0 … 1 of the compliance between two places that is F + ⟨G⟩ − G₁₀; the rest is Λ (K⁻¹ − g) Λᵀ + ⟨G⟩.
  [[nodiscard]] double spread_share(const NearPlace& at, const NearPlace& on) const {
    return ground_.spread ? at.spread.known * on.spread.known : 0.0;
  }
  /// F between two points that are near a path.
  [[nodiscard]] Mat3 spread_between(int point, int other) const;
  void write_wide_of_tip();
  void write_tip(int point);
  [[nodiscard]] std::size_t tip_node_entry(int number, int point, int medium) const {
    return static_cast<std::size_t>((number * capacity_ + point) * ground_.kernel->media() + medium);
  }
  void forget_tip_node(int number, int first_point, int last_point);
  void write_needle_scale();
  [[nodiscard]] SpreadCompliance::Place spread_place(const Vec3& x, double edge_mm);
  [[nodiscard]] bool knows_wide() const { return wide_.size() > 0; }

  std::unique_ptr<ContactCompliance> far_;
  struct {
    std::shared_ptr<const Tissue> tissue;
    std::shared_ptr<const MeshKernel> kernel;
    std::shared_ptr<const SpreadCompliance> spread;
    int way = -1;  ///< number of the way in `spread` that the needle takes; −1 before it arrives
  } ground_;
  NeedleKernel needle_;
  std::vector<double> region_stiffening_MPa_;  ///< (regions), or empty
  MatX spread_under_tip_;                      ///< SpreadCompliance::press() by the tip, when it is near a path
  double press_N_ = 0.0;                       ///< force at which the surface of the entry broke
  Vec3 entry_ = Vec3::Zero();                  ///< direction of the needle at the entry, LPS
  std::vector<NearPlace> places_;              ///< (points)
  std::vector<double> softness_;               ///< (points) softness_in_mesh(), where wide() is kept
  int capacity_;                               ///< largest number of points, tip included
  /// [mm] Place of the tip that wide() was made for; empty: the tip's next place.
  std::optional<Vec3> wide_at_;
  int tip_tet_ = -1;
  TipElement tip_element_;
  // Cache of g between the nodes of the tip's element and the points, for E = 1 MPa.
  std::vector<Mat3> tip_node_g_;      ///< (numbers × points × media) [mm/N]
  std::vector<char> tip_node_known_;  ///< (the same size) whether the entry has been computed
};

}  // namespace stylet
