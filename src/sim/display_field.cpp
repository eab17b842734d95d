// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/display_field.hpp"

#include "planning.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace stylet {

namespace {

constexpr double kShownBeyond_mm = 10.0;  ///< the zone extends this far beyond the planned depth
constexpr Eigen::Index kBatch = 192;      ///< right-hand sides solved for at once
constexpr std::size_t kNearBatch = 64;    ///< near nodes whose rows are corrected at once
constexpr Eigen::Index kOversample = 20;  ///< random rows in addition to the number of columns
constexpr Eigen::Index kChecks = 60;      ///< columns on which the error is measured
constexpr double kSafety = 2.0;           ///< factor on the measured error: only a sample of columns is measured
constexpr double kRows_mm_per_N = 1e-4;   ///< tolerance of the low-rank compression of the rows (LowRankRows)
constexpr unsigned kSeed = 20050101;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

/// Collects the zone Z: free displacement nodes near a planned path whose compliance is in the store.
void DisplayField::find_zone(double reach_mm) {
  const Tissue& tissue = model_->tissue();
  const ComplianceStore& store = *model_->store();
  slot_.assign(static_cast<std::size_t>(tissue.displacement_nodes()), -1);
  std::vector<std::array<Vec3, 2>> ways;
  for (const auto* plans : {&model_->insertions(), &model_->staying()}) {
    for (const PlannedInsertion& plan : *plans)
      ways.push_back({plan.entry, plan.entry + (plan.depth_mm + kShownBeyond_mm) * plan.direction});
  }
  const Corridor near = find_corridor(tissue.mesh(), ways, reach_mm, std::numeric_limits<int>::max());
  for (const Index tet : near.elements) {
    for (const Index node : tissue.nodes_of(tet)) {
      Index& slot = slot_[static_cast<std::size_t>(node)];
      if (slot >= 0 || tissue.is_fixed(node) || !store.has(node)) continue;
      slot = static_cast<Index>(zone_.size());
      zone_.push_back(node);
    }
  }
  statistics_.zone_dofs = static_cast<int>(3 * zone_.size());
}

void DisplayField::find_surface() {
  const Topology& topology = model_->topology();
  for (const auto* faces : {&topology.boundary, &topology.interfaces}) {
    for (const Face& face : *faces) surface_.insert(surface_.end(), face.nodes.begin(), face.nodes.end());
  }
  std::sort(surface_.begin(), surface_.end());
  surface_.erase(std::unique(surface_.begin(), surface_.end()), surface_.end());
}

/// Solves for the columns of K⁻¹ [mm/N] (3 mesh nodes × dofs) of some degrees of freedom of the zone.
Eigen::MatrixXf DisplayField::solve_columns(std::span<const Eigen::Index> dofs, const Progress& progress) const {
  const Tissue& tissue = model_->tissue();
  const auto all = static_cast<Eigen::Index>(dofs.size());
  const Eigen::Index rows = 3 * Eigen::Index{tissue.mesh().node_count()};
  Eigen::MatrixXf columns(rows, all);
  for (Eigen::Index first = 0; first < all; first += kBatch) {
    report(progress, "display: columns", static_cast<double>(first) / static_cast<double>(all));
    const Eigen::Index count = std::min(kBatch, all - first);
    MatX f = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::Index dof = dofs[static_cast<std::size_t>(first + j)];
      f(3 * Eigen::Index{zone_[static_cast<std::size_t>(dof / 3)]} + dof % 3, j) = 1.0;
    }
    columns.middleCols(first, count) = tissue.solve(f).topRows(rows).cast<float>();
  }
  return columns;
}

/// Takes every degree of freedom of the zone into the skeleton, so that the field is exact.
void DisplayField::keep_all(const Progress& progress) {
  for (Eigen::Index i = 0; i < 3 * static_cast<Eigen::Index>(zone_.size()); ++i) skeleton_.push_back(i);
  rows_ = LowRankRows(model_->mesh().nodes, solve_columns(skeleton_, progress), 0.0, surface_, progress);
}

/// M = Ωᵀ K⁻¹(F,Z) (rows × 3Z): random combinations Ω of the rows of the nodes F that the store does not have.
MatX DisplayField::random_rows(Eigen::Index rows, const Progress& progress) const {
  const Tissue& tissue = model_->tissue();
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  MatX M(rows, 3 * static_cast<Eigen::Index>(zone_.size()));
  for (Eigen::Index first = 0; first < rows; first += kBatch) {
    report(progress, "display: choosing columns", static_cast<double>(first) / static_cast<double>(rows));
    const Eigen::Index count = std::min(kBatch, rows - first);
    MatX f = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, count);
    for (Index node = 0; node < tissue.mesh().node_count(); ++node) {
      if (model_->store()->has(node)) continue;  // held, or read from the store
      for (double& value : f.middleRows<3>(3 * Eigen::Index{node}).reshaped()) value = normal(random);
    }
    const MatX u = tissue.solve(f);
    for (std::size_t z = 0; z < zone_.size(); ++z) {
      M.block(first, 3 * static_cast<Eigen::Index>(z), count, 3) =
          u.middleRows<3>(3 * Eigen::Index{zone_[z]}).transpose();
    }
  }
  return M;
}

/// Determines S and T by a pivoted QR factorisation M P = Q R: K⁻¹(F, first k pivots) R₁₁⁻¹ R₁ Pᵀ ≈ K⁻¹(F,Z). The
/// pivots that follow the first k are the columns that those represent worst, so the error is measured on them.
void DisplayField::choose_skeleton(const DisplayFieldOptions& options, const Progress& progress) {
  const Eigen::Index zone = 3 * static_cast<Eigen::Index>(zone_.size());
  const Eigen::Index solved = std::min<Eigen::Index>(zone, options.columns + kChecks);
  const Eigen::ColPivHouseholderQR<MatX> qr(random_rows(solved + kOversample, progress));
  const auto& order = qr.colsPermutation().indices();
  std::vector<Eigen::Index> pivots;
  for (Eigen::Index j = 0; j < solved; ++j) pivots.push_back(order[j]);
  const MatX R = qr.matrixR().topRows(solved).triangularView<Eigen::Upper>();
  const Eigen::MatrixXf columns = solve_columns(pivots, progress);

  const auto interpolation = [&](Eigen::Index k, Eigen::Index first, Eigen::Index count) -> MatX {
    return R.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(R.block(0, first, k, count));
  };
  const auto error = [&](Eigen::Index k) {
    const Eigen::Index count = std::min(kChecks, solved - k);
    const Eigen::MatrixXf off =
        columns.middleCols(k, count) - columns.leftCols(k) * interpolation(k, k, count).cast<float>();
    float worst = 0.0F;
    for (Index node = 0; node < model_->mesh().node_count(); ++node) {
      if (!model_->store()->has(node))
        worst = std::max(worst, off.middleRows<3>(3 * Eigen::Index{node}).colwise().norm().maxCoeff());
    }
    return kSafety * static_cast<double>(worst);
  };
  Eigen::Index k = options.columns;
  statistics_.error_mm_per_N = error(k);
  while (true) {  // reduce the number of columns by a fifth as long as the error stays below the tolerance
    const Eigen::Index fewer = 4 * k / 5;
    const double with_fewer = fewer > 0 ? error(fewer) : options.tolerance_mm_per_N + 1.0;
    if (with_fewer > options.tolerance_mm_per_N) break;
    k = fewer;
    statistics_.error_mm_per_N = with_fewer;
  }

  const MatX inner = interpolation(k, 0, zone);
  to_skeleton_.resize(k, zone);
  for (Eigen::Index j = 0; j < zone; ++j) to_skeleton_.col(order[j]) = inner.col(j).cast<float>();
  for (Eigen::Index j = 0; j < k; ++j) {
    skeleton_.push_back(order[j]);
    to_skeleton_.col(order[j]) = Eigen::VectorXf::Unit(k, j);
  }
  // Each of the three components of a force causes one column of T on the skeleton, hence the factor √3.
  statistics_.error_mm_per_N +=
      std::numbers::sqrt3 * kRows_mm_per_N * static_cast<double>(to_skeleton_.colwise().norm().maxCoeff());
  rows_ = LowRankRows(model_->mesh().nodes, columns.leftCols(k), kRows_mm_per_N, surface_, progress);
}

/// Near the ways the skeleton is not accurate enough, so its rows are corrected to the values of the store.
void DisplayField::keep_near_rows() {
  if (to_skeleton_.size() == 0) return;
  const ComplianceStore& store = *model_->store();
  const Index nodes = model_->mesh().node_count();
  near_slot_.assign(static_cast<std::size_t>(nodes), -1);
  std::vector<Index> near;
  for (Index node = 0; node < nodes; ++node) {
    if (!store.has(node) || model_->tissue().is_fixed(node)) continue;
    near_slot_[static_cast<std::size_t>(node)] = static_cast<Index>(near.size());
    near.push_back(node);
  }
  near_rows_.resize(3 * static_cast<Eigen::Index>(near.size()), 3 * static_cast<Eigen::Index>(zone_.size()));
  for (std::size_t first = 0; first < near.size(); first += kNearBatch) {
    const std::span<const Index> batch = std::span(near).subspan(first, std::min(kNearBatch, near.size() - first));
    Eigen::MatrixXf shown(3 * static_cast<Eigen::Index>(batch.size()), to_skeleton_.rows());
    for (std::size_t r = 0; r < batch.size(); ++r)
      shown.middleRows<3>(3 * static_cast<Eigen::Index>(r)) = rows_.transposed(batch[r]).transpose();
    auto rows = near_rows_.middleRows(3 * static_cast<Eigen::Index>(first), shown.rows());
    rows.noalias() = -shown * to_skeleton_;
    for (std::size_t z = 0; z < zone_.size(); ++z) {
      for (std::size_t r = 0; r < batch.size(); ++r)
        rows.block<3, 3>(3 * static_cast<Eigen::Index>(r), 3 * static_cast<Eigen::Index>(z)) +=
            store.block(batch[r], zone_[z]).cast<float>();
    }
  }
}

Result<> DisplayField::check(const Model& model) {
  if (!model.inverse()) return Ok{};
  return input_error("coupling.engine",
                     "the display needs the compliance near the needles' ways, which this engine does not store",
                     "Use coupling.engine = \"condensed\"");
}

Result<std::shared_ptr<const DisplayField>> DisplayField::prepare(std::shared_ptr<const Model> model,
                                                                  const DisplayFieldOptions& options,
                                                                  const Progress& progress) {
  if (auto good = check(*model); !good) return good.error();
  const double started = seconds_now();
  std::shared_ptr<DisplayField> field(new DisplayField(std::move(model)));
  field->find_surface();
  field->find_zone(options.reach_mm);
  const auto& zone = field->statistics_.zone_dofs;
  2 * zone <= 3 * options.columns ? field->keep_all(progress) : field->choose_skeleton(options, progress);
  report(progress, "display: columns", 1.0);
  field->keep_near_rows();
  Statistics& s = field->statistics_;
  s.columns = static_cast<int>(field->skeleton_.size());
  s.seconds = seconds_now() - started;
  const auto floats = static_cast<std::size_t>(field->to_skeleton_.size() + field->near_rows_.size());
  s.megabytes = static_cast<double>(field->rows_.bytes() + floats * sizeof(float)) / 1048576.0;
  return std::shared_ptr<const DisplayField>(std::move(field));
}

bool DisplayField::exact_on(Index node) const {
  const Eigen::Index slot = slot_[static_cast<std::size_t>(node)];
  if (slot < 0) return model_->tissue().is_fixed(node);
  for (Eigen::Index dof = 3 * slot; dof < 3 * slot + 3; ++dof) {
    if (std::find(skeleton_.begin(), skeleton_.end(), dof) == skeleton_.end()) return false;
  }
  return true;
}

DisplayField::Load DisplayField::make_load() const {
  Load load;
  load.zone_ = Eigen::VectorXf::Zero(3 * static_cast<Eigen::Index>(zone_.size()));
  load.loaded_.reserve(zone_.size());
  load.skeleton_ = rows_.make_product();
  load.near_ = Eigen::VectorXf::Zero(near_rows_.rows());
  return load;
}

void DisplayField::set(std::span<const TissueForce> forces, Load& load) const {
  const Tissue& tissue = model_->tissue();
  for (const Index slot : load.loaded_) load.zone_.segment<3>(3 * Eigen::Index{slot}).setZero();
  load.loaded_.clear();
  load.left_out_N_ = load.shown_N_ = 0.0;
  for (const TissueForce& force : forces) {
    if (force.at.tet < 0) continue;
    const Shape shape = tissue.shape(force.at.tet, force.at.weights);
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i) {
      const Vec3 on_node = shape.weight[i] * force.force;
      if (on_node.isZero(0.0) || tissue.is_fixed(shape.node[i])) continue;
      const Index slot = slot_[static_cast<std::size_t>(shape.node[i])];
      if (slot < 0) {
        load.left_out_N_ += on_node.norm();
        continue;
      }
      load.shown_N_ += on_node.norm();
      auto there = load.zone_.segment<3>(3 * Eigen::Index{slot});
      if (std::find(load.loaded_.begin(), load.loaded_.end(), slot) == load.loaded_.end()) load.loaded_.push_back(slot);
      there += on_node.cast<float>();
    }
  }
  load.near_is_there_ = false;
  load.skeleton_.forget();
  Eigen::VectorXf& on_skeleton = load.skeleton_.vector();
  if (to_skeleton_.size() == 0) {
    on_skeleton = load.zone_;
    return;
  }
  on_skeleton.setZero();
  for (const Index slot : load.loaded_)
    on_skeleton.noalias() +=
        to_skeleton_.middleCols<3>(3 * Eigen::Index{slot}).lazyProduct(load.zone_.segment<3>(3 * Eigen::Index{slot}));
}

/// Computes the correction of all near nodes at once: the columns of the few forces are contiguous in memory, whereas
/// the rows of single nodes are not.
void DisplayField::read_near_rows(Load& load) const {
  load.near_.setZero();
  for (const Index slot : load.loaded_)
    load.near_.noalias() +=
        near_rows_.middleCols<3>(3 * Eigen::Index{slot}).lazyProduct(load.zone_.segment<3>(3 * Eigen::Index{slot}));
  load.near_is_there_ = true;
}

void DisplayField::displacement(std::span<const Index> nodes, Load& load, Eigen::Ref<Eigen::Matrix3Xf> out) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    auto u = out.col(static_cast<Eigen::Index>(i));
    u = rows_.times(nodes[i], load.skeleton_);
    const Index near = near_slot_.empty() ? -1 : near_slot_[static_cast<std::size_t>(nodes[i])];
    if (near < 0) continue;
    if (!load.near_is_there_) read_near_rows(load);
    u += load.near_.segment<3>(3 * Eigen::Index{near});
  }
}

}  // namespace stylet
