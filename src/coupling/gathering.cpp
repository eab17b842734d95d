// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/dense_kernels.hpp"
#include "insertion_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// What the linear equations of an iteration are about (ContactSystem): where the needle's contacts are, what each
/// yields by itself, tissue's compliance among them, their forces, and how far tissue and needle are apart.
namespace stylet {

namespace {
constexpr double kNoViscosity = 1e-12;  ///< [N s/mm] stands for none in a division
/// [N s/mm²] Friction without viscosity would leave a sliding contact's place undetermined: at 100 mm/s this adds 1e-7
/// N/mm.
constexpr double kLeastViscosity = 1e-9;
/// What is left of friction's growth with speed beyond the speed where it ends: enough to tell how far a contact
/// slides.
constexpr double kFlat = 1e-3;

/// [mm] A cut so short says nothing about how compliance changes, one so long is none.
constexpr double kLeastCut_mm = 1e-4;
constexpr double kMostCut_mm = 1.0;
constexpr double kAlong = 0.9;  ///< [of the tip's way] and one that is more of a way sideways says little
/// Gaps that change by as much as the tip goes on could close of themselves: the tip's rows would be singular.
constexpr double kMostDrift = 0.5;
/// From a contact nearer than this to the tip its direction is not told.
constexpr double kLeastTurn_mm = 1.0;
}  // namespace

double Insertion::Parts::arc_of(int load) const {
  return load == 0 ? length() : std::clamp(grips[static_cast<std::size_t>(load - 1)].s, 0.0, length());
}

Vec3 Insertion::Parts::shaft_point(int load) const {
  const double s = arc_of(load);
  const double beyond = load == 0 ? 0.0 : grips[static_cast<std::size_t>(load - 1)].s - s;
  return needle->point(s) + beyond * frames[static_cast<std::size_t>(load)].col(2);
}

void Insertion::Parts::gather_forces() {
  forces.leftCols(compliance.points()).setZero();
  forces.col(ContactCompliance::kTip) = tip.force;
  for (const Grip& grip : grips) forces.col(grip.point) = grip.force;
}

Vec3 Insertion::Parts::tissue_displacement(int point) const {
  Vec3 u = Vec3::Zero();
  const auto columns = compliance.matrix().middleCols<3>(3 * point);  // or rows: A is symmetric
  u.noalias() += columns.topRows<3>().transpose() * tip.force;
  for (const Grip& grip : grips) u.noalias() += columns.middleRows<3>(3 * grip.point).transpose() * grip.force;
  if (memory.on()) u = memory.share() * u + memory.displacement(compliance, point);
  return u;
}

void Insertion::Parts::set_frames() {
  const InPhase in_phase(phases, StepPhase::gather);
  for (int c = 0; c < load_count(); ++c) {
    const double s = arc_of(c);
    const AxisPlace at = needle->place(s);
    const Vec3& t = at.tangent;
    const double beyond = c == 0 ? 0.0 : grips[static_cast<std::size_t>(c - 1)].s - s;
    shaft[static_cast<std::size_t>(c)] = at.point + beyond * t;
    // Any pair of normals will do: both lateral directions are treated alike.
    const Vec3 helper = std::abs(t.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 n1 = t.cross(helper).normalized();
    Mat3& frame = frames[static_cast<std::size_t>(c)];
    frame.col(0) = n1;
    frame.col(1) = t.cross(n1);
    frame.col(2) = t;
    past[static_cast<std::size_t>(c)] = memory.displacement(compliance, point_of(c));
  }
}

void Insertion::Parts::fill_loads() {
  loads.resize(static_cast<std::size_t>(load_count()));
  for (int c = 0; c < load_count(); ++c) loads[static_cast<std::size_t>(c)] = {arc_of(c), -force_of(c)};
}

double Insertion::Parts::slip_of_cut(double h) const {
  return h / std::max(settings.tip_viscosity_Ns_per_mm, kNoViscosity);
}

/// What each contact yields by itself in its present state, and what that adds to the right-hand side.
void Insertion::Parts::soften_rows(double h) {
  const InPhase in_phase(phases, StepPhase::gather);
  for (int c = 0; c < load_count(); ++c) {
    const Mat3& Q = frames[static_cast<std::size_t>(c)];
    Yield& yield = system.yield[static_cast<std::size_t>(c)];
    Vec3 shift = Vec3::Zero();
    yield.along = Q.col(2);
    if (c == 0) {
      system.cut_per_N = 0.0;
      yield.lateral = tip_lateral_rows() ? tip_lateral_softness() : 0.0;
      yield.axial = settings.axial_compliance_mm_per_N;
      shift.head<2>().noalias() = yield.lateral * (Q.leftCols<2>().transpose() * bevel_force());
      if (tip.state == Tip::State::cut) {
        const double slip = slip_of_cut(h);
        yield.axial += slip;
        shift[2] = slip * tip.cutting + tip.advance;
        if (foresees_cut && tip.touching) {
          system.cut_per_N = slip;
          system.cut_due = slip * (Q.col(2).dot(tip.force) - tip.cutting) - tip.advance;
        }
      }
    } else {
      Grip& grip = grips[static_cast<std::size_t>(c - 1)];
      const double slow = std::max(grip.law.viscous_Ns_per_mm2, kLeastViscosity);
      const double viscosity = grip.fast ? std::max(kFlat * slow, kLeastViscosity) : slow;
      grip.coulomb = grip.law.coulomb_N_per_mm * grip.length;
      if (grip.fast) grip.coulomb += (slow - viscosity) * grip.law.viscous_to_mm_per_s * grip.length;
      grip.slip = h / std::max(viscosity * grip.length, kNoViscosity);
      grip.reach = slow > kLeastViscosity ? grip.law.viscous_to_mm_per_s * h : std::numeric_limits<double>::infinity();
      yield.lateral = yield.axial = grip.softness;
      if (grip.state != Grip::State::stick) {
        const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
        yield.axial += grip.slip;
        shift[2] = grip.slip * sign * grip.coulomb + grip.s_start - grip.s;
      }
    }
    system.shift.segment<3>(3 * c) = shift;
  }
}

/// Goes over to the contacts of now. What was there before and is the first of them stays as it is.
/// @return how many stayed
int Insertion::Parts::renew_contacts() {
  const int count = load_count();
  const int before = static_cast<int>(system_points.size());
  int same = 0;
  while (same < std::min(before, count) && system_points[static_cast<std::size_t>(same)] == point_of(same)) ++same;
  if (same < std::min(before, count)) {
    tangent_fits = matrix_fits = false;
  } else if (count < before) {  // the last ones slid off the tip
    matrix_fits = matrix_fits && system.keep_first(count);
  }
  system_points.resize(static_cast<std::size_t>(same));
  for (int c = same; c < count; ++c) system_points.push_back(point_of(c));
  return same;
}

/// A contact that has come alive goes into tangent and matrix, where they are there.
void Insertion::Parts::append_contact(int load) {
  const InPhase in_phase(phases, StepPhase::factorise);
  const int count = load + 1;
  const Eigen::Index before = 3 * static_cast<Eigen::Index>(load);
  auto rows = system.N.block(before, 0, 3, before + 3);
  tangent_fits = tangent_fits && needle->append({loads.data(), static_cast<std::size_t>(count)}, rows);
  if (!tangent_fits) return;
  system.N.block(0, before, before, 3) = rows.leftCols(before).transpose();
  system.spring[static_cast<std::size_t>(load)] = {};
  system.count = count;
  matrix_fits = matrix_fits && system.append();
}

/// A's columns and rows of the tip, number by number: they change with every cut. How much, the last cut tells.
/// @param same so many contacts are those of before
void Insertion::Parts::gather_tip_columns(double share, int same) {
  const Vec3 way = tip.x - system_tip;
  const double cut = tip.direction.dot(way);
  const bool told = way.norm() < kMostCut_mm && std::abs(cut) > std::max(kLeastCut_mm, kAlong * way.norm()) &&
                    share == system_share && !tip.stale && !system_stale;
  system_tip = tip.x;
  system_stale = tip.stale;
  if (told) slope_at = tip.x;
  if ((tip.x - slope_at).norm() > kMostCut_mm) tip_slope.setZero();  // that was another place
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double* const from = compliance.matrix().col(3 * ContactCompliance::kTip + k).data();
    double* const column = system.A.col(k).data();
    double* const slope = tip_slope.col(k).data();
    for (int c = 0; c < load_count(); ++c) {
      for (int i = 3 * c; i < 3 * c + 3; ++i) {
        const double now = share * from[3 * point_of(c) + i - 3 * c];
        if (c >= same) {
          slope[i] = 0.0;
        } else if (told) {
          slope[i] = (now - column[i]) / cut;
        }
        column[i] = now;
      }
    }
    const Eigen::Index size = 3 * static_cast<Eigen::Index>(load_count());
    system.A.row(k).head(size) = system.A.col(k).head(size).transpose();
  }
}

/// By how much the gaps change as the cut goes on: the tip moves in the direction of the cut, which need not be that of
/// the needle, and its compliance is another one there. What viscous tissue remembers is left out.
void Insertion::Parts::gather_drift() {
  const auto size = 3 * static_cast<Eigen::Index>(load_count());
  const auto slope = tip_slope.topRows(size);
  auto drift = system.drift.head(size);
  drift.noalias() = slope.lazyProduct(system.now.head<3>());
  drift.head<3>() += slope.bottomRows(size - 3).transpose().lazyProduct(system.now.segment(3, size - 3));
  drift.head<3>() += tip.direction - frames[0].col(2);
  if (!(drift.lpNorm<Eigen::Infinity>() < kMostDrift)) drift.setZero();
}

/// What the linear equations are about: tissue's compliance among the contacts, their forces, and how far tissue and
/// needle are apart.
void Insertion::Parts::gather_system() {
  const InPhase in_phase(phases, StepPhase::gather);
  const int count = load_count();
  const auto size = static_cast<Eigen::Index>(3 * count);
  const double share = memory.share();
  const int same = renew_contacts();
  const bool whole = system_version != compliance.version() || system_share != share;
  gather_tip_columns(share, same);
  for (int c = 1; c < count; ++c) {
    for (int d = whole ? c : std::max(c, same); d < count; ++d) {
      const Mat3 block = share * compliance(point_of(c), point_of(d));
      // A contact laid ahead of the shaft changes nothing among those there, unless it changes the mesh.
      if (d < same && block != system.A.block<3, 3>(3 * c, 3 * d)) matrix_fits = false;
      system.A.block<3, 3>(3 * c, 3 * d) = block;
      system.A.block<3, 3>(3 * d, 3 * c) = block.transpose();
    }
  }
  system_version = compliance.version();
  system_share = share;
  for (int c = same; c < count; ++c) append_contact(c);
  system.count = count;

  auto now = system.now.head(size);
  auto gap = system.gap.head(size);
  for (int c = 0; c < count; ++c) now.segment<3>(3 * c) = force_of(c);
  for (int c = 0; c < count; ++c) gap.segment<3>(3 * c) = shaft[static_cast<std::size_t>(c)] - unloaded(c);
  dense::subtract_product(gap, system.A.topLeftCorner(size, size), now);
  gap = -gap;
  if (tip.touching) gather_drift();
  system.behind = 0;
  for (int c = count - 1; tip.touching && c > 0 && system.behind == 0; --c) {
    system.behind_mm = loads.front().s - loads[static_cast<std::size_t>(c)].s;
    if (system.behind_mm > kLeastTurn_mm) system.behind = c;
  }
}

}  // namespace stylet
