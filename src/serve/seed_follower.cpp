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
  constexpr std::ptrdiff_t kMost = TissueProbe::kPoints - 1;  // one is for the forecast
  if (std::ssize(own) > kMost) own.erase(own.begin(), own.end() - kMost);
  watched_ = std::move(own);
  near_.assign(watched_.size(), std::nullopt);
  watch();
  is_new_ = true;
}

/// Watches the seeds, and in front of them the point of the forecast, if it has one.
void SeedFollower::watch() {
  std::vector<Vec3> points;
  if (forecast_.point()) points.push_back(*forecast_.point());
  for (const std::size_t seed : watched_) points.push_back(rest_[seed]);
  version_ = probe_->watch(points);
}

/// Takes up where the probe has seen the watched points.
void SeedFollower::take_answer() {
  probe_->fetch();
  const TissueProbe::Answer& answer = probe_->answer();
  if (answer.version != version_) return;
  const std::size_t first = forecast_.point() ? 1 : 0;
  for (std::size_t k = 0; k < watched_.size(); ++k)
    if (answer.is_known[first + k]) near_[k] = vec3(answer.now[first + k]);
  if (first == 1 && answer.is_known[0] && forecast_.take(vec3(answer.now[0]))) watch();
}

void SeedFollower::foretell(const std::optional<SeedForecast::Places>& now) {
  take_answer();
  const std::optional<Vec3> before = forecast_.point();
  forecast_.aim(now);
  if (forecast_.point() != before) watch();
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
  take_answer();
  for (std::size_t k = 0; k < watched_.size(); ++k)
    if (near_[k]) now[watched_[k]] = *near_[k];
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
