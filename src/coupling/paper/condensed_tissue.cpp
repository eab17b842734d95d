// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/paper/condensed_tissue.hpp"

#include <algorithm>

namespace stylet::paper {

namespace {
/// Number of switches after which K_W is made anew. Raised, more rounding errors accumulate in it.
constexpr long kSwitchesToRebuild = 20000;
}  // namespace

CondensedTissue::CondensedTissue(int contacts)
    : system_(contacts),
      y_(VecX::Zero(3 * static_cast<Eigen::Index>(contacts))),
      x_(y_),
      across_(MatX::Zero(3 * static_cast<Eigen::Index>(contacts), 3)),
      frames_(static_cast<std::size_t>(contacts), Mat3::Identity()),
      points_(static_cast<std::size_t>(contacts), -1),
      slot_of_(static_cast<std::size_t>(contacts), 0),
      load_of_(static_cast<std::size_t>(contacts), 0) {}

void CondensedTissue::enter(const Contacts& contacts, int load, const Mat3& frame) {
  const TissueResponse& tissue = contacts.tissue;
  const int point = contacts.point(load);
  for (int k = 0; k < system_.points(); ++k) {
    const int other = load_of_[static_cast<std::size_t>(k)];
    across_.block<3, 3>(3 * k, 0).noalias() = frames_[static_cast<std::size_t>(other)].transpose() *
                                              tissue.compliance_now(contacts.point(other), point) * frame;
  }
  const int k = system_.add(across_.topRows(3 * system_.points()),
                            frame.transpose() * tissue.compliance_now(point, point) * frame);
  slot_of_[static_cast<std::size_t>(load)] = k;
  load_of_[static_cast<std::size_t>(k)] = load;
  points_[static_cast<std::size_t>(load)] = point;
  frames_[static_cast<std::size_t>(load)] = frame;
}

bool CondensedTissue::has_all(const Contacts& contacts) const {
  if (version_ != contacts.tissue.compliance().version() || share_ != contacts.tissue.creep_share() ||
      system_.points() != contacts.count())
    return false;
  for (int c = 1; c < contacts.count(); ++c) {
    if (points_[static_cast<std::size_t>(c)] != contacts.point(c)) return false;
  }
  return true;
}

void CondensedTissue::take(const Contacts& contacts, std::span<const Mat3> frames) {
  if (!has_all(contacts) || system_.switches() > kSwitchesToRebuild) {
    system_.clear();
    version_ = contacts.tissue.compliance().version();
    share_ = contacts.tissue.creep_share();
    for (int c = 0; c < contacts.count(); ++c) enter(contacts, c, frames[static_cast<std::size_t>(c)]);
  } else if (tip_ != contacts.tip.cut.x()) {
    const int k = slot_of_[0];
    system_.remove(k);
    const int moved = load_of_[static_cast<std::size_t>(system_.points())];  // the last point took the tip's number
    slot_of_[static_cast<std::size_t>(moved)] = k;
    load_of_[static_cast<std::size_t>(k)] = moved;
    enter(contacts, 0, frames[0]);
  }
  tip_ = contacts.tip.cut.x();
}

void CondensedTissue::turn(int load, const Mat3& frame) {
  Mat3& old = frames_[static_cast<std::size_t>(load)];
  if (old != frame) system_.rotate(slot_of_[static_cast<std::size_t>(load)], frame.transpose() * old);
  old = frame;
}

}  // namespace stylet::paper
