// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/unbroken_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

constexpr double kBeside_mm = 1e-3;  ///< a point this far from a surface is safely on one side of it

}  // namespace

void UnbrokenSurface::add(const Simulation& simulation) {
  const Step& step = simulation.last_step();
  deepest_mm_ = std::max(deepest_mm_, step.base_depth_mm);
  for (const Event& event : simulation.new_events()) {
    if (event.kind == EventKind::puncture && hardest_)
      broken_.push_back({event.region, event.depth_mm, event.depth_mm - easy_mm_});
    if (event.kind == EventKind::puncture || event.kind == EventKind::region_entered) forget(step.base_depth_mm);
    if (event.kind == EventKind::grazed && buckled_) slid_off_mm_ = event.depth_mm;
  }
  if (step.tip_state == TipState::cutting) forget(step.base_depth_mm);
  if (step.tip_state != TipState::pressing) return;
  const auto now = pressed_now(simulation);
  if (!now) return;
  if (now->bow < kBuckled && (!buckled_ || now->hand_N > buckled_->hand_N)) buckled_ = now;
  if (!furthest_ || now->past_mm > furthest_->past_mm) furthest_ = now;
  if (hardest_ && now->force_N <= hardest_->force_N) return;
  if (!hardest_ || now->force_N < (1.0 - kClose) * now->needed_N) easy_mm_ = step.base_depth_mm;
  hardest_ = now;
}

std::optional<UnbrokenSurface::Pressed> UnbrokenSurface::pressed_now(const Simulation& simulation) const {
  const std::vector<TissueForce> forces = simulation.insertion().tissue_forces();
  const auto tip =
      std::find_if(forces.begin(), forces.end(), [](const TissueForce& force) { return force.along.isZero(0.0); });
  if (tip == forces.end()) return {};
  const Model& model = simulation.model();
  const TetMesh& mesh = model.mesh();
  const Step& step = simulation.last_step();
  const Vec3 axis = step.base.rotation * Vec3::UnitZ();
  const Needle& needle = simulation.insertion().needle();
  Vec3 at_rest = Vec3::Zero();
  const auto& corners = mesh.tets[static_cast<std::size_t>(tip->at.tet)];
  for (std::size_t i = 0; i < 4; ++i)
    at_rest += tip->at.weights[static_cast<Eigen::Index>(i)] * mesh.nodes[static_cast<std::size_t>(corners[i])];
  const auto region_at = [&](double ahead_mm) {
    const auto found = model.locator().find(at_rest + ahead_mm * axis, tip->at.tet);
    return found ? mesh.tet_region[static_cast<std::size_t>(found->tet)] : -1;
  };
  const int before = region_at(-kBeside_mm);
  const int behind = region_at(kBeside_mm);
  if (behind < 0) return {};
  const auto laws_of = [&](int region) -> const RegionLaws& { return model.laws()[static_cast<std::size_t>(region)]; };
  const auto name_of = [&](int region) { return mesh.regions[static_cast<std::size_t>(region)]; };
  Pressed pressed{.region = name_of(behind),
                  .past_mm = (step.tip_mm - at_rest).dot(axis),
                  .way_mm = step.base_depth_mm - cut_to_mm_,
                  // Two parts of the tip's force do not load the surface: the force under which the tissue has crept,
                  // and the force across the tip of a needle that has bowed.
                  .force_N = (tip->force - tip->lasting).dot(needle.tangent(needle.length())),
                  .at_surface = before != behind,
                  .hand_N = step.force_axial_N,
                  .bow = (step.tip_mm - step.base.origin).norm() / model.scenario().needle.length_mm};
  // A membrane holds only if it bears more than the tissue behind it takes to be cut.
  const double membrane_N = pressed.at_surface ? membrane_force(model.laws(), before, behind) : 0.0;
  pressed.by_cutting = laws_of(behind).cutting_N >= membrane_N;
  pressed.needed_N = pressed.by_cutting ? laws_of(behind).cutting_N : membrane_N;
  const bool of_behind = pressed.by_cutting || before < 0 || laws_of(behind).puncture_N == membrane_N;
  pressed.owner = name_of(of_behind ? behind : before);
  if (!(pressed.needed_N > 0.0) || !std::isfinite(pressed.needed_N)) return {};
  return pressed;
}

void UnbrokenSurface::forget(double depth_mm) {
  cut_to_mm_ = depth_mm;
  furthest_.reset();
  hardest_.reset();
  buckled_.reset();
  slid_off_mm_.reset();
}

std::vector<std::string> UnbrokenSurface::warnings() const {
  std::vector<std::string> result;
  for (const Broken& broken : broken_) {
    const double spare_mm = deepest_mm_ - broken.depth_mm;
    if (spare_mm >= broken.way_mm) continue;
    result.push_back(
        fmt::format("The surface of the {} broke only {:.1f} mm before the needle was at its depth, and would not have "
                    "broken if it bore {:g} % more. With another time step or mesh the needle may stay outside the {}.",
                    broken.region, spare_mm, 100.0 * kClose, broken.region));
  }
  if (auto text = held()) result.push_back(*std::move(text));
  if (hardest_ && hardest_->at_surface && hardest_->force_N >= (1.0 - kClose) * hardest_->needed_N) {
    result.push_back(fmt::format(
        "The tip pressed the surface of the {} with up to {:.2f} N, and {:.2f} N break it. With another time step or "
        "mesh the needle may enter the {}.",
        hardest_->region, hardest_->force_N, hardest_->needed_N, hardest_->region));
  }
  return result;
}

std::optional<std::string> UnbrokenSurface::held() const {
  // Tissue that the needle has dragged far along while it cut is not held by the tip.
  const bool pressed =
      furthest_ && furthest_->past_mm > kFar_mm && (furthest_->at_surface || furthest_->way_mm > kFar_mm);
  const auto text = [&] { return text_of(*furthest_, hardest_->force_N); };
  if (!buckled_) return pressed ? std::optional(text()) : std::nullopt;
  std::string cure;
  if (slid_off_mm_) {
    cure = fmt::format(
        "At a base depth of {:.0f} mm its tip lay flat on the surface and slid off it: from there on the needle "
        "lies on the surface, which is not simulated, and has no force until it has been drawn out. ",
        *slid_off_mm_);
  }
  cure +=
      "Take a thicker or shorter needle, leave the stylet in it (needle.stylet = \"in\"), or hold it in a template "
      "(template.guide = true) whose holes are nearer to the skin (template.distance_mm).";
  if (pressed) {
    return fmt::format("{} The needle bowed out under {:.2f} N: it buckled. {}", text(), buckled_->hand_N, cure);
  }
  return fmt::format(
      "The needle bowed out under {:.2f} N instead of {} the {}, for which {:.2f} N are needed: it buckled. {}",
      buckled_->hand_N, buckled_->at_surface ? "breaking the surface of" : "cutting the tissue of", buckled_->region,
      buckled_->needed_N, cure);
}

std::string UnbrokenSurface::text_of(const Pressed& p, double most_N) {
  const std::string key = fmt::format("tissue.{}.{}", p.owner, p.by_cutting ? "cutting_N" : "puncture_N");
  if (!p.at_surface) {
    return fmt::format(
        "The tip pressed the tissue of the {} {:.1f} mm ahead of itself with up to {:.2f} N, but {:.2f} N are needed "
        "to cut it ({}, see stylet insert --print-tissues): the needle did not go on in the {}. Lower {}, or raise "
        "young_kPa "
        "or stiffening of this tissue.",
        p.region, p.past_mm, most_N, p.needed_N, key, p.region, key);
  }
  return fmt::format(
      "The tip pressed the surface of the {} {:.1f} mm inwards with up to {:.2f} N, but {:.2f} N are needed to {} ({}, "
      "see "
      "stylet insert --print-tissues): the needle did not enter the {}. Lower {}, or raise young_kPa or stiffening on "
      "either side of the surface.",
      p.region, p.past_mm, most_N, p.needed_N, p.by_cutting ? "cut into the tissue behind it" : "break it", key,
      p.region, key);
}

}  // namespace stylet
