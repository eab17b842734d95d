// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

#include <algorithm>

/// A tangent and the matrix made of it cost as much as many iterations, but a balance can do without new ones. So the
/// next ones are made beside those in use, one piece after each balance that left time for it, and then take their
/// place. All pieces but the first are of a shape some steps old, which is as good: the old tangents that they replace
/// are of one much older.
namespace stylet {

namespace {
constexpr double kWornOut_mm = 2.0;  ///< way of the base after which the next tangent is begun
}  // namespace

/// At the end of a balance: the next piece.
void Insertion::Parts::prepare_tangent() {
  using Stage = Preparation::Stage;
  if (!needle->prepares() || !tangent_fits || !matrix_fits) return;
  if (preparation.stage == Stage::none) {
    if (preparation.worn_mm < kWornOut_mm) return;
    preparation.lent = system.supported && ++supported_for < kTryWithout ? kFewSprings : 0;
    if (preparation.lent == 0) supported_for = 0;
    preparation.stage = Stage::begun;
  }
  if (preparation.stage != Stage::begun && !prepared_contacts_are_there()) {
    forget_preparation();
    return;
  }
  switch (preparation.stage) {
    case Stage::begun:
      if (prepare_on_springs()) preparation.stage = Stage::tangent;
      break;
    case Stage::tangent: {
      const InPhase in_phase(phases, StepPhase::needle_tangent);
      const Eigen::Index size = 3 * static_cast<Eigen::Index>(system.prepared.count);
      if (needle->prepared_compliance(system.prepared.N.topLeftCorner(size, size)))
        preparation.stage = Stage::compliance;
      break;
    }
    case Stage::compliance: {
      const InPhase in_phase(phases, StepPhase::factorise);
      system.fill_prepared();
      preparation.stage = Stage::filled;
      break;
    }
    case Stage::filled: {
      const InPhase in_phase(phases, StepPhase::factorise);
      preparation.stage = system.factorise_prepared() ? Stage::matrix : Stage::none;
      break;
    }
    default:
      break;
  }
}

/// The tangent of now, on as many springs as it may need. False where it needs more: they are lent next time.
bool Insertion::Parts::prepare_on_springs() {
  const InPhase in_phase(phases, StepPhase::needle_tangent);
  const int count = load_count();
  std::span<const Mat3> lent;
  if (preparation.lent > 0) {
    lend_springs(preparation.lent, system.prepared.spring);
    lent = {springs.data(), static_cast<std::size_t>(count)};
  }
  const bool more = preparation.lent < std::max(count - 1, 1);
  if (!needle->prepare(loads, lent, more ? Indefinite::give_up : Indefinite::shift) && more) {
    preparation.lent = preparation.lent == 0 ? kFewSprings : count;
    return false;
  }
  system.prepared.count = count;
  system.prepared.supported = preparation.lent > 0;
  preparation.points.clear();
  for (int c = 0; c < count; ++c) preparation.points.push_back(point_of(c));
  return true;
}

/// The contacts that it is of are still there, the first of those of now.
bool Insertion::Parts::prepared_contacts_are_there() const {
  const auto count = static_cast<int>(preparation.points.size());
  if (count > load_count()) return false;
  for (int c = 0; c < count; ++c) {
    if (preparation.points[static_cast<std::size_t>(c)] != point_of(c)) return false;
  }
  return true;
}

/// At the start of a balance: what is complete is from now on in use.
void Insertion::Parts::take_prepared_tangent() {
  if (preparation.stage != Preparation::Stage::matrix) return;
  forget_preparation();
  if (!prepared_contacts_are_there()) return;
  needle->take_prepared();
  system.take_prepared();
  system_points = preparation.points;
  tangent_fits = matrix_fits = true;
  preparation.worn_mm = 0.0;
}

}  // namespace stylet
