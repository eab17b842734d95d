// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/tissue_block.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
/// [mm] From a shorter cut no derivative is computed. Raised, the derivative is older; lowered, it loses digits.
constexpr double kLeastCut_mm = 1e-4;
/// [mm] A larger motion of the tip is a change of place, not a cut. Raised, a derivative may be used that is not valid.
constexpr double kMostCut_mm = 1.0;
/// Part of the tip's motion that has to be along the cut for a derivative. Raised, fewer cuts give one.
constexpr double kAlong = 0.9;
/// Largest drift. If the gaps changed by as much as the tip moves, they would close by themselves, and the tip's rows
/// would be singular. Raised nearer to 1, the rows come nearer to that.
constexpr double kMostDrift = 0.5;
}  // namespace

TissueBlock::TissueBlock(ContactSystem& system, int most_contacts)
    : system_(system),
      tip_columns_(MatX::Zero(3 * static_cast<Eigen::Index>(most_contacts), 3)),
      slope_(tip_columns_),
      held_(tip_columns_) {
  points_.reserve(static_cast<std::size_t>(most_contacts));
}

int TissueBlock::renew(const Contacts& contacts) {
  const int count = contacts.count();
  before_ = static_cast<int>(points_.size());
  int same = 0;
  while (same < std::min(before_, count) && points_[static_cast<std::size_t>(same)] == contacts.point(same)) ++same;
  points_.resize(static_cast<std::size_t>(same));
  for (int c = same; c < count; ++c) points_.push_back(contacts.point(c));
  return same;
}

void TissueBlock::take_points(std::span<const int> points) { points_.assign(points.begin(), points.end()); }

/// Updates the tip's columns and rows of A, which change with every cut, and their derivative from the last cut.
void TissueBlock::gather_tip(const Contacts& contacts, double share, int same) {
  const TipContact& tip = contacts.tip;
  const Vec3 way = tip.cut.x() - tip_;
  const double cut = tip.cut.direction().dot(way);
  const TissueHold* const hold = contacts.tissue.hold();
  const std::uint64_t held_by = hold != nullptr ? hold->version() : 0;
  const bool told = way.norm() < kMostCut_mm && std::abs(cut) > std::max(kLeastCut_mm, kAlong * way.norm()) &&
                    share == share_ && !tip.cut.is_stale() && !stale_ && held_by == held_by_;
  tip_ = tip.cut.x();
  stale_ = tip.cut.is_stale();
  if (told) slope_at_ = tip_;
  if ((tip_ - slope_at_).norm() > kMostCut_mm) slope_.setZero();  // slope_ belongs to another place
  const ContactCompliance& compliance = contacts.tissue.compliance();
  held_by_ = held_by;
  const auto count = static_cast<int>(points_.size());
  for (int c = 0; hold != nullptr && c < count; ++c)
    held_.middleRows<3>(3 * c) = hold->reduction(points_[static_cast<std::size_t>(c)], ContactCompliance::kTip);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double* const from = compliance.matrix().col(3 * ContactCompliance::kTip + k).data();
    const double* const wide = compliance.wide().col(3 * ContactCompliance::kTip + k).data();
    double* const column = tip_columns_.col(k).data();
    double* const slope = slope_.col(k).data();
    for (int c = 0; c < count; ++c) {
      const int point = points_[static_cast<std::size_t>(c)];
      for (int i = 3 * c; i < 3 * c + 3; ++i) {
        const int row = 3 * point + i - 3 * c;
        double now = share > 0.0 ? from[row] + share * wide[row] : from[row];
        if (hold != nullptr) now -= held_(i, k);
        if (c >= same) {
          slope[i] = 0.0;
        } else if (told) {
          slope[i] = (now - column[i]) / cut;
        }
        column[i] = now;
      }
    }
    const Eigen::Index size = 3 * static_cast<Eigen::Index>(count);
    system_.A.col(k).head(size) = tip_columns_.col(k).head(size);
    system_.A.row(k).head(size) = tip_columns_.col(k).head(size).transpose();
  }
}

void TissueBlock::gather(const Contacts& contacts, int same) {
  const auto count = static_cast<int>(points_.size());
  const double share = contacts.tissue.creep_share();
  const bool whole = version_ != contacts.tissue.version() || share_ != share;
  gather_tip(contacts, share, same);
  for (int c = 1; c < count; ++c) {
    for (int d = whole ? c : std::max(c, same); d < count; ++d) {
      const int point = points_[static_cast<std::size_t>(c)];
      const Mat3 block = contacts.tissue.compliance_now(point, points_[static_cast<std::size_t>(d)]);
      // A contact created ahead of the shaft changes no compliance among the present ones, unless it changes the mesh.
      if (d < same && block != system_.A.block<3, 3>(3 * c, 3 * d)) system_.outdate_all();
      system_.A.block<3, 3>(3 * c, 3 * d) = block;
      system_.A.block<3, 3>(3 * d, 3 * c) = block.transpose();
    }
  }
  version_ = contacts.tissue.version();
  share_ = share;
}

void TissueBlock::stiffen(const TipRelief& relief) {
  if (!relief.is_any()) return;
  const auto count = static_cast<int>(points_.size());
  for (int c = 0; c < count; ++c) {
    const Mat3 less = relief.slope(points_[static_cast<std::size_t>(c)]);
    system_.A.block<3, 3>(3 * c, 0) -= less;
    if (c > 0) system_.A.block<3, 3>(0, 3 * c) -= less.transpose();
  }
}

/// The part of A that changes along the cut has the needle's own scale. Through this part the contacts move as under φ,
/// the force that makes the same dent in linear tissue, and the tip moves φ′ times as far as in linear tissue.
void TissueBlock::gather_drift(const Contacts& contacts, const TipRelief& relief, ContactRows& rows) const {
  const auto size = 3 * static_cast<Eigen::Index>(contacts.count());
  const auto slope = slope_.topRows(size);
  auto drift = rows.tip.drift.head(size);
  drift.noalias() = slope.lazyProduct(relief.is_any() ? relief.linear() : Vec3(rows.now.head<3>()));
  drift.head<3>() += slope.bottomRows(size - 3).transpose().lazyProduct(rows.now.segment(3, size - 3));
  if (relief.is_any()) drift.head<3>() = (relief.share().transpose() * drift.head<3>()).eval();
  drift.head<3>() += contacts.tip.cut.direction() - rows.frame.front().col(2);
  if (!(drift.lpNorm<Eigen::Infinity>() < kMostDrift)) drift.setZero();
}

}  // namespace stylet
