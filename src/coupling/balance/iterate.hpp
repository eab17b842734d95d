// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"

#include <vector>

namespace stylet {

/// A saved iterate of a balance, to be restored if the next one leads away. Nothing allocates after construction.
class Iterate {
 public:
  /// @param shape_size size of Needle::state() @param most_contacts largest number of shaft contacts
  Iterate(Eigen::Index shape_size, int most_contacts)
      : shape_(VecX::Zero(shape_size)), work_(shape_), shaft_(static_cast<std::size_t>(most_contacts)) {}

  void keep(const Contacts& contacts) {
    shape_ = contacts.needle.state();
    advance_ = contacts.tip.cut.advance();
    tip_force_ = contacts.tip.force;
    for (std::size_t k = 0; k < contacts.grips().size(); ++k)
      shaft_[k] = {contacts.grips()[k].force, contacts.grips()[k].s};
  }

  /// Restores the iterate. No contact may have changed its state since keep().
  void restore(const Contacts& contacts) const {
    contacts.needle.set_state(shape_);
    contacts.tip.force = tip_force_;
    for (std::size_t k = 0; k < contacts.grips().size(); ++k) {
      contacts.grips()[k].force = shaft_[k].force;
      contacts.grips()[k].s = shaft_[k].s;
    }
    if (contacts.tip.cuts()) contacts.tip.cut.march(advance_);
  }

  /// Moves the present iterate half of the way back to the kept one. No contact may have changed its state.
  void halve_step(const Contacts& contacts) {
    work_ = 0.5 * (shape_ + contacts.needle.state());
    contacts.needle.set_state(work_);
    contacts.tip.force = 0.5 * (tip_force_ + contacts.tip.force).eval();
    for (std::size_t k = 0; k < contacts.grips().size(); ++k) {
      ShaftContact& contact = contacts.grips()[k];
      contact.force = 0.5 * (shaft_[k].force + contact.force).eval();
      contact.s = 0.5 * (shaft_[k].s + contact.s);
    }
    if (contacts.tip.cuts()) contacts.tip.cut.march(0.5 * (advance_ + contacts.tip.cut.advance()));
  }

 private:
  struct OfShaft {
    Vec3 force = Vec3::Zero();
    double s = 0.0;
  };
  VecX shape_;
  VecX work_;  ///< a state between two iterates
  double advance_ = 0.0;
  Vec3 tip_force_ = Vec3::Zero();
  std::vector<OfShaft> shaft_;
};

}  // namespace stylet
