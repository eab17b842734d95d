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
  double reach_mm = 3.0;  ///< forces on elements so near a planned way are carried exactly, or to the stated error
  int columns = 600;      ///< most columns of K⁻¹ that are kept
  double tolerance_mm_per_N = 0.05;  ///< no more columns than this error needs, as far as `columns` goes
};

/// Displacement of any nodes of the mesh under forces along the planned ways, fast enough for a picture and without the
/// factor: u_R = K⁻¹(R,S) T f_Z.
///
/// Z are the nodes near the ways, S some of their degrees of freedom (the skeleton) and T what a force on Z comes to on
/// the skeleton. Where Z has no more degrees of freedom than `columns`, S is all of it and u exact but for single
/// precision. Otherwise S and T come from a pivoted QR of random combinations of the rows of K⁻¹(F,Z), F being the
/// nodes further away than the compliance store reaches (Halko, Martinsson & Tropp 2011); rows nearer by are exact,
/// from the store. Forces on the skeleton are exact everywhere, but for 1e-4 mm/N that K⁻¹(R,S) may be off by as it is
/// kept (LowRankRows). docs/theory/display.md has the whole story.
///
/// Immutable once prepared: any number of threads may read, each with a Load of its own. Reading does not allocate.
class DisplayField {
 public:
  /// Refuses a model whose engine keeps the full inverse and no store: it has no field.
  static Result<> check(const Model& model);
  /// Solves for the columns. Not for the loop. Errors: those of check().
  static Result<std::shared_ptr<const DisplayField>> prepare(std::shared_ptr<const Model> model,
                                                             const DisplayFieldOptions& options = {},
                                                             const Progress& progress = {});

  /// Forces, put together for reading.
  class Load {
   public:
    /// Sum of the magnitudes [N] of what fell on nodes that are not near a planned way, and is not shown.
    [[nodiscard]] double left_out_N() const { return left_out_N_; }
    [[nodiscard]] double shown_N() const { return shown_N_; }  ///< the same of what is shown

   private:
    friend class DisplayField;
    Eigen::VectorXf zone_;           ///< [N] f_Z
    std::vector<Index> loaded_;      ///< slots in the zone with a force
    LowRankRows::Product skeleton_;  ///< K⁻¹(R,S) times T f_Z [N]
    Eigen::VectorXf near_;           ///< [mm] what near_rows_ make of f_Z, once a near node was asked for
    bool near_is_there_ = false;
    double left_out_N_ = 0.0;
    double shown_N_ = 0.0;
  };
  [[nodiscard]] Load make_load() const;

  /// Takes new forces in the place of those before. Forces on a held node move nothing.
  void set(std::span<const TissueForce> forces, Load& load) const;

  /// Displacement [mm] LPS of nodes of the mesh: what the mesh represents, without the needle's near field
  /// (ContactCompliance::mesh_displacement).
  /// @param out (3 × nodes)
  void displacement(std::span<const Index> nodes, Load& load, Eigen::Ref<Eigen::Matrix3Xf> out) const;

  /// Nodes of the patient's surface and of all surfaces between regions, ascending. They are the quickest to read.
  [[nodiscard]] std::span<const Index> surface() const { return surface_; }

  /// Whether forces on a node of the mesh are shown without error everywhere.
  [[nodiscard]] bool exact_on(Index node) const;

  struct Statistics {
    int zone_dofs = 0;  ///< free degrees of freedom of Z
    int columns = 0;    ///< of the skeleton; as many: exact
    /// No node is off by more than this for each newton of the magnitudes of all forces, rounding apart. Measured on
    /// the columns that the skeleton represents worst, and taken twice.
    double error_mm_per_N = 0.0;
    double seconds = 0.0;
    double megabytes = 0.0;
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
  std::vector<Index> zone_;             ///< nodes of Z, none of them held
  std::vector<Index> slot_;             ///< (displacement nodes) in zone_, -1
  std::vector<Eigen::Index> skeleton_;  ///< degrees of freedom of Z that are in S
  LowRankRows rows_;                    ///< (3 mesh nodes × S) [mm/N] K⁻¹(R,S)
  Eigen::MatrixXf to_skeleton_;         ///< (S × 3Z) T; empty: the identity
  std::vector<Index> near_slot_;        ///< (mesh nodes) number among near nodes, -1; empty where nothing is left out
  Eigen::MatrixXf near_rows_;           ///< (3 near nodes × 3Z) [mm/N] K⁻¹ − what the skeleton gives
  Statistics statistics_;
};

}  // namespace stylet
