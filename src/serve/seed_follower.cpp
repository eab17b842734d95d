// SPDX-License-Identifier: GPL-3.0-or-later
#include "seed_follower.hpp"

#include <algorithm>
#include <utility>

namespace stylet::serve {

namespace {
constexpr double kSeen_mm = 0.01;  // a smaller motion is not told
}

SeedFollower::SeedFollower(std::shared_ptr<const Model> model)
    : model_(std::move(model)), probe_(std::make_shared<TissueProbe>()) {}

void SeedFollower::order_drop(double beyond_tip_mm) {
  ordered_ = probe_->order_drop(beyond_tip_mm);
  dropping_ = 1;
  taken_ = 0;
}

void SeedFollower::order_train(std::span<const double> behind_tip_mm, double half_length_mm) {
  ordered_ = probe_->order_train(behind_tip_mm, half_length_mm);
  dropping_ = std::min(behind_tip_mm.size(), TissueProbe::kTrain);
  taken_ = 0;
}

void SeedFollower::call_off() {
  if (dropping_ > 0) order_train({}, 0.0);
}

std::optional<double> SeedFollower::began_at_mm() {
  probe_->fetch();
  const TissueProbe::Answer& answer = probe_->answer();
  if (dropping_ == 0 || answer.order != ordered_) return std::nullopt;
  return answer.began_at_mm;
}

std::optional<ProbedDrop> SeedFollower::take_drop() {
  probe_->fetch();
  const TissueProbe::Answer& answer = probe_->answer();
  if (dropping_ == 0 || answer.order != ordered_ || !answer.drops[taken_].is_done) return std::nullopt;
  const ProbedDrop drop = answer.drops[taken_++];
  dropping_ = drop.tip_in_tissue ? dropping_ - 1 : 0;
  return drop;
}

void SeedFollower::set(std::vector<Vec3> rest_mm, std::vector<std::size_t> own) {
  rest_ = std::move(rest_mm);
  moved_.resize(rest_.size(), Vec3::Zero());
  at_.clear();
  nodes_.clear();
  for (const Vec3& x : rest_) {
    const auto at = model_->locator().find(x);
    at_.push_back(at.value_or(MaterialPoint{}));
    if (!at) continue;
    const auto& corners = model_->mesh().tets[static_cast<std::size_t>(at->tet)];
    nodes_.insert(nodes_.end(), corners.begin(), corners.end());
  }
  // The last ones have just been dropped, where the near field is largest.
  if (own.size() > TissueProbe::kPoints) own.erase(own.begin(), own.end() - TissueProbe::kPoints);
  watched_ = std::move(own);
  std::vector<Vec3> points;
  for (const std::size_t seed : watched_) points.push_back(rest_[seed]);
  version_ = probe_->watch(points);
  is_new_ = true;
}

void SeedFollower::follow(const DisplayField& field, DisplayField::Load& load) {
  if (nodes_.empty()) return;
  Eigen::Matrix3Xf u(3, static_cast<Eigen::Index>(nodes_.size()));
  field.displacement(nodes_, load, u);
  Eigen::Index column = 0;
  for (std::size_t k = 0; k < rest_.size(); ++k) {
    if (at_[k].tet < 0) continue;
    moved_[k].setZero();
    for (Eigen::Index corner = 0; corner < 4; ++corner)
      moved_[k] += at_[k].weights[corner] * u.col(column + corner).cast<double>();
    column += 4;
  }
}

std::vector<Vec3> SeedFollower::now_mm() {
  std::vector<Vec3> now;
  now.reserve(rest_.size());
  for (std::size_t k = 0; k < rest_.size(); ++k) now.emplace_back(rest_[k] + moved_[k]);
  probe_->fetch();
  const TissueProbe::Answer& answer = probe_->answer();
  for (std::size_t k = 0; k < watched_.size() && answer.version == version_; ++k) {
    if (answer.is_known[k]) now[watched_[k]] = vec3(answer.now[k]);
  }
  return now;
}

std::optional<std::vector<Vec3>> SeedFollower::news() {
  std::vector<Vec3> now = now_mm();
  const auto is_still = [&] {
    for (std::size_t k = 0; k < now.size(); ++k) {
      if ((now[k] - told_[k]).norm() > kSeen_mm) return false;
    }
    return true;
  };
  if (!is_new_ && is_still()) return std::nullopt;
  is_new_ = false;
  told_ = now;
  return now;
}

}  // namespace stylet::serve
