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

/// Compliance among held points with the near field of the needle put right. Elements cannot represent the field of a
/// needle thinner than they are. So what the mesh makes of that field is taken out of K⁻¹, and the field itself put in:
///   A(c,d) = Λ_c (K⁻¹ − g) Λ_dᵀ + ⟨G⟩(c,d),
/// g being the mesh's own kernel (MeshKernel) and ⟨G⟩ the medium's, averaged over the needle's pieces. K⁻¹ − g is
/// smooth, any mesh represents it; ⟨G⟩ does not know the mesh.
///
/// Near the ways that a needle was planned to go, in tissue that stiffens or creeps, it is instead
///   A(c,d) = F(c,d) + ⟨G⟩(c,d) − G₁₀(c,d),
/// F being what forces that are spread over 10 mm do (SpreadCompliance), which has nothing of the elements in it, and
/// G₁₀ the medium's kernel for such forces. docs/theory/near_field.md derives both.
///
/// Points are interpolated, whatever placement is asked for; the mesh does not change.
class NearFieldCompliance final : public ContactCompliance {
 public:
  /// @param far Λ K⁻¹ Λᵀ from whatever engine keeps K⁻¹; has no points yet
  /// @param kernel of the tissue's mesh
  /// @param stiffening_MPa (regions) k₂ of DentLaw; empty: no tissue stiffens
  /// @param creeps whether wide() is kept even if nothing stiffens
  /// @param spread along the ways of the needle, what its wide part is there; null: that is made of K⁻¹ everywhere
  NearFieldCompliance(std::unique_ptr<ContactCompliance> far, std::shared_ptr<const Tissue> tissue,
                      std::shared_ptr<const MeshKernel> kernel, const NeedleKernel& needle, int capacity,
                      std::vector<double> stiffening_MPa = {}, bool creeps = false,
                      std::shared_ptr<const SpreadCompliance> spread = nullptr);

  /// @param travel direction of the piece of needle there; zero = a point
  Added add(const MaterialPoint& at, const Vec3& x, Placement placement, const Vec3& travel = Vec3::Zero()) override;
  bool move_tip(const MaterialPoint& at, const Vec3& x) override;
  void begin_sub_step() override { wide_at_.reset(); }
  void enter_by(double force, const Vec3& direction) override {
    press_N_ = force;
    entry_ = direction;
  }
  [[nodiscard]] bool available(Index base_tet) const override;
  void mark_nodes(std::span<unsigned> stamps, unsigned stamp) const override;
  void remove_last_embedded() override;
  void reset() override;

  /// Of the far field: what the mesh represents.
  [[nodiscard]] Mat3 gradient_at_tip(const Eigen::Ref<const MatX>& forces) const override;

  /// With the near field, wherever a node lies in it, and the dent under the tip as it stiffens.
  [[nodiscard]] VecX displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] VecX wide_displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] VecX mesh_displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] double softness(int point) const override { return softness_[static_cast<std::size_t>(point)]; }
  [[nodiscard]] Nodes nodes(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] std::span<const RemeshEvent> remeshing() const override { return {}; }

 private:
  [[nodiscard]] Mat3 of_mesh_at_tip(int point, int medium);
  template <class Correction>
  VecX with_corrections(const Eigen::Ref<const MatX>& forces, const Correction& correction) const;
  template <class OfMesh>
  void write_block(int point, int other, const OfMesh& g);
  template <class OfMesh>
  void write_wide_block(int point, int other, const OfMesh& g);
  /// How much of the compliance between two places is that of spread forces and the needle's narrow part.
  [[nodiscard]] double spread_share(const NearPlace& at, const NearPlace& on) const {
    return ground_.spread ? at.spread.known * on.spread.known : 0.0;
  }
  void write_wide_of_tip();
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
    int way = -1;  ///< of spread, that the needle goes; −1 before it comes
  } ground_;
  NeedleKernel needle_;
  std::vector<double> region_stiffening_MPa_;  ///< (regions) or none
  double press_N_ = 0.0;                       ///< what the surface the needle went in by took before it broke …
  Vec3 entry_ = Vec3::Zero();                  ///< … and which way it went
  std::vector<NearPlace> places_;              ///< (points)
  std::vector<double> softness_;               ///< (points) softness_in_mesh(), where wide() is kept
  int capacity_;                               ///< of points, tip included
  std::optional<Vec3> wide_at_;                ///< [mm] the tip that wide() is of; empty: its next place is
  int tip_tet_ = -1;
  TipElement tip_element_;
  // g between the nodes of the tip's element and the points, for E = 1 MPa, as it is asked for.
  std::vector<Mat3> tip_node_g_;      ///< (numbers × points × media) [mm/N]
  std::vector<char> tip_node_known_;  ///< (the same)
};

}  // namespace stylet
