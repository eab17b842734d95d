// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/low_rank_rows.hpp"
#include "stylet/sim/model.hpp"

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace stylet {

struct DisplayFieldOptions {
  /// [mm] Forces on elements within this distance of a planned path are shown; others are left out. Raising it needs
  /// more columns for the same error.
  double reach_mm = 3.0;
  /// Largest number of columns of K⁻¹ that are chosen; more cost time, memory and preparation. Up to half as many again
  /// are all kept, since choosing among them takes three times as long as solving for all.
  int columns = 600;
  double tolerance_mm_per_N = 0.05;  ///< columns are dropped as long as the error stays below this
};

/// Computes the displacement of any nodes of the mesh under forces along the planned paths, fast enough for pictures
/// and without the factor of the stiffness: u_R = K⁻¹(R,S) T f_Z.
///
/// R are the nodes asked for, Z the nodes near the ways, S some of their degrees of freedom (the skeleton), and T maps
/// a force on Z to the equivalent force on the skeleton. If Z has at most `columns` degrees of freedom, S is all of
/// them and u is exact except for single precision. Otherwise S and T come from a pivoted QR of random combinations of
/// the rows of K⁻¹(F,Z), where F are the nodes that the compliance store does not have (Halko, Martinsson & Tropp
/// 2011); the rows of nearer nodes are exact, from the store. Forces on the skeleton are exact everywhere, except for
/// an error of 1e-4 mm/N by which K⁻¹(R,S) is compressed (LowRankRows). Details: docs/theory/display.md.
///
/// Immutable once prepared: any number of threads may read, each with its own Load. Reading does not allocate.
class DisplayField {
 public:
  /// Error for a model whose engine keeps the full inverse instead of a compliance store: the field needs the store.
  static Result<> check(const Model& model);
  /// Solves for the columns; takes seconds, so it must not be called in the real-time loop. Errors: as check().
  static Result<std::shared_ptr<const DisplayField>> prepare(std::shared_ptr<const Model> model,
                                                             const DisplayFieldOptions& options = {},
                                                             const Progress& progress = {});

  /// The forces of one picture, with the intermediate results of reading the displacement under them.
  class Load {
   public:
    /// Sum of the magnitudes [N] of the nodal forces outside of Z; these forces are not shown.
    [[nodiscard]] double left_out_N() const { return left_out_N_; }
    /// Sum of the magnitudes [N] of the nodal forces that are shown.
    [[nodiscard]] double shown_N() const { return shown_N_; }

   private:
    friend class DisplayField;
    Eigen::VectorXf zone_;           ///< [N] f_Z
    std::vector<Index> loaded_;      ///< slots in the zone with a force
    LowRankRows::Product skeleton_;  ///< product of K⁻¹(R,S) with T f_Z [N]
    Eigen::VectorXf near_;           ///< [mm] near_rows_ × f_Z; computed when the first near node is read
    bool near_is_there_ = false;     ///< near_ is valid
    double left_out_N_ = 0.0;
    double shown_N_ = 0.0;
  };
  [[nodiscard]] Load make_load() const;

  /// Replaces the forces of `load`. Forces on a held node move nothing.
  void set(std::span<const TissueForce> forces, Load& load) const;

  /// Displacement [mm] LPS of nodes of the mesh as the mesh represents it, without the needle's near field
  /// (ContactCompliance::mesh_displacement).
  /// @param out (3 × nodes)
  void displacement(std::span<const Index> nodes, Load& load, Eigen::Ref<Eigen::Matrix3Xf> out) const;

  /// Nodes of the patient's surface and of all surfaces between regions, ascending. Reading them is fastest, because
  /// they are stored together.
  [[nodiscard]] std::span<const Index> surface() const { return surface_; }

  /// Whether the displacement under forces on this node of the mesh is exact everywhere.
  [[nodiscard]] bool exact_on(Index node) const;

  struct Statistics {
    int zone_dofs = 0;  ///< number of free degrees of freedom of Z
    int columns = 0;    ///< number of degrees of freedom of the skeleton; if equal to zone_dofs, the field is exact
    /// Estimated largest error of a node's displacement [mm] per newton of Σ|f| over all forces, without rounding:
    /// twice the error measured on the columns that the skeleton represents worst.
    double error_mm_per_N = 0.0;
    double seconds = 0.0;    ///< wall-clock time of prepare()
    double megabytes = 0.0;  ///< memory of the field
  };
  [[nodiscard]] const Statistics& statistics() const { return statistics_; }
  [[nodiscard]] const Model& model() const { return *model_; }

 private:
  explicit DisplayField(std::shared_ptr<const Model> model) : model_(std::move(model)) {}
  void find_surface();
  void find_zone(double reach_mm);
  void keep_all(const Progress& progress);
  void choose_skeleton(const DisplayFieldOptions& options, const Progress& progress);
  [[nodiscard]] MatX random_rows(Eigen::Index rows, const Progress& progress) const;
  [[nodiscard]] Eigen::MatrixXf solve_columns(std::span<const Eigen::Index> dofs, const Progress& progress) const;
  void keep_near_rows();
  void read_near_rows(Load& load) const;

  std::shared_ptr<const Model> model_;
  std::vector<Index> surface_;
  std::vector<Index> zone_;             ///< nodes of Z; held nodes are not in it
  std::vector<Index> slot_;             ///< (displacement nodes) position in zone_, or -1
  std::vector<Eigen::Index> skeleton_;  ///< S as indices of degrees of freedom of Z
  LowRankRows rows_;                    ///< (3 mesh nodes × S) [mm/N] K⁻¹(R,S)
  Eigen::MatrixXf to_skeleton_;         ///< (S × 3Z) T; empty: the identity
  std::vector<Index> near_slot_;  ///< (mesh nodes) number among the near nodes, or -1; empty if the field is exact
  Eigen::MatrixXf near_rows_;     ///< (3 near nodes × 3Z) [mm/N] K⁻¹ minus its approximation by the skeleton
  Statistics statistics_;
};

}  // namespace stylet
