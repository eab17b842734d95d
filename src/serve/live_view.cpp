// SPDX-License-Identifier: GPL-3.0-or-later
#include "live_view.hpp"

#include "wall_clock.hpp"
#include "wire.hpp"

#include <algorithm>

namespace stylet::serve {

namespace {

constexpr std::size_t kCurve = 8000;  ///< samples of the curve kept for viewers that connect later
constexpr double kMoved_mm = 0.02;    ///< smallest displacement that pages are told of: a tenth of a pixel
constexpr double kShareOfTime = 0.3;  ///< share of this thread's time for displacements that pages show

}  // namespace

TissueView::TissueView(const OpenModel& open)
    : points_(open.points),
      near_(open.model, open.points.on_mesh()),
      shown_(Eigen::Matrix3Xf::Zero(3, open.points.count())) {
  if (open.field) set_field(open.field);
}

void TissueView::set_field(std::shared_ptr<const DisplayField> field) {
  field_ = std::move(field);
  load_ = field_->make_load();
  told_.resize(3, 0);
}

bool TissueView::is_due() const { return load_ && is_owed_ && wall_clock_s() >= after_s_; }

void TissueView::compute(std::span<const TissueForce> forces, SeedFollower& seeds) {
  const double before = wall_clock_s();
  field_->displacement(points_.nodes, *load_, shown_.leftCols(static_cast<Eigen::Index>(points_.nodes.size())));
  points_.carry_along(shown_);
  near_.set(forces);
  near_.add(shown_);
  seeds.follow(*field_, *load_);
  is_owed_ = false;
  is_computed_ = true;
  is_anew_ = true;
  const double after = wall_clock_s();
  after_s_ = after + (after - before) * (1.0 / kShareOfTime - 1.0);
}

bool TissueView::has_moved() const {
  if (!is_computed_ || shown_.size() == 0) return false;
  return told_.cols() != shown_.cols() || !((shown_ - told_).cwiseAbs().maxCoeff() < static_cast<float>(kMoved_mm));
}

double TissueView::left_out_N() const { return load_ ? std::max(load_->left_out_N(), near_.left_out_N()) : 0.0; }

void LiveCurve::add(const Step& step) {
  unsent_.push_back(step);
  all_.push_back(step);
}

void LiveCurve::thin() {
  for (std::vector<Step>* steps : {&all_, &unsent_}) {
    if (steps->size() > 2 * kCurve) wire::thin(*steps, kCurve);
  }
}

std::vector<Step> LiveCurve::take(bool whole) {
  std::vector<Step> steps = std::exchange(unsent_, {});
  return whole ? all_ : steps;
}

}  // namespace stylet::serve
