// SPDX-License-Identifier: GPL-3.0-or-later
// A second needle beside the track of a first one, drawn at random: on flat, tilted and curved skin, with a trembling
// hand. STYLET_RANDOM_CASES=1000 build/bin/test_random_needles --gtest_filter=RandomEntries.* tries a thousand cases.
#include "needle_in_block.hpp"
#include "random_cases.hpp"

#include <iostream>

namespace stylet::test {
namespace {

using Kind = EventKind;

constexpr double kDiameter_mm = 1.27;
constexpr double kDt_s = 4e-3;

/// Changes the block's skin from z = 0 to z = rise(x, y).
NeedleInBlock skin(const std::function<double(double, double)>& rise, int cells) {
  BlockOptions options;
  options.cells = {cells, cells, cells};
  options.edit = [rise](TetMesh& mesh) {
    for (Vec3& x : mesh.nodes) x.z() += (1.0 - x.z() / 100.0) * rise(x.x(), x.y());
  };
  return NeedleInBlock(options);
}

/// The displacement of the needle by the tremor of a hand.
struct Tremor {
  Vec3 size_mm = Vec3::Zero();
  Vec3 per_s = Vec3::Zero();  ///< [rad/s]
  Vec3 phase = Vec3::Zero();

  explicit Tremor(Draw& draw) {
    if (draw.one_in_two()) return;  // a steady hand
    for (int k = 0; k < 3; ++k) {
      size_mm[k] = draw.between(0.0, 0.3);
      per_s[k] = 2.0 * std::numbers::pi * draw.between(6.0, 12.0);
      phase[k] = draw.between(0.0, 6.28);
    }
  }
  [[nodiscard]] Vec3 at(double t) const { return size_mm.cwiseProduct(((per_s * t + phase).array().sin()).matrix()); }
};

/// A needle that goes in along `axis` and out again, and a description of what went wrong.
class Entry {
 public:
  Entry(NeedleInBlock& block, const Vec3& through, const Vec3& axis, const Tremor& tremor)
      : block_(block), tremor_(tremor) {
    const auto crossing = block.locator->first_entry(through - 60.0 * axis, through + 60.0 * axis);
    surface_ = through - 60.0 * axis + crossing->t * 120.0 * axis;
    double start = -1.0;
    do {
      start -= 1.0;
      block.sideways = tremor.at(0.0);
      block.aim(surface_, axis, start);
    } while (inside());
    block.flags = 0;
  }

  void go(double to) {
    const double way = 20.0 * kDt_s;
    const double from = block_.depth;
    const auto steps = std::lround(std::abs(to - from) / way);
    for (long k = 1; k <= steps; ++k) {
      block_.depth = from + (to - from) * static_cast<double>(k) / static_cast<double>(steps);
      step();
    }
  }

  [[nodiscard]] const std::string& wrong() const { return wrong_; }
  [[nodiscard]] bool joined() const { return joined_; }

 private:
  void step() {
    time_s_ += kDt_s;
    block_.sideways = tremor_.at(time_s_);
    block_.step(kDt_s);
    const Step& report = block_.report;
    for (const InsertionEvent& event : block_.insertion->events()) {
      const Kind kind = event.kind;
      grazed_ = grazed_ || kind == Kind::grazed;
      punctured_ = punctured_ || kind == Kind::puncture;
      if (kind == Kind::withdrawn && inside()) note("the insertion ends with the tip in the tissue");
    }
    joined_ = joined_ || (report.tip_state == TipState::in_track && !punctured_);
    // Before the first contact, a needle in a joined track may move some millimetres without a force.
    const double deep = block_.axis.dot(report.tip_mm - surface_);
    const bool unheld = report.hand_force_N.norm() < 1e-6 && (report.tip_state == TipState::air || deep > 7.0);
    if (!unheld || !inside()) return;
    const bool says_so = (report.flags & Step::no_contact_inside) != 0;
    if (!says_so) note("no force acts on a needle in the tissue, and nothing is said");
    if (!grazed_) note("no force acts on a needle in the tissue");
  }

  [[nodiscard]] bool inside() const {
    const Vec3 tip = block_.insertion->needle().point(block_.length);
    return block_.locator->find(tip - 1e-6 * block_.axis).has_value();
  }

  void note(const std::string& what) {
    if (wrong_.empty()) wrong_ = what + ", depth " + std::to_string(block_.depth);
  }

  NeedleInBlock& block_;
  Tremor tremor_;
  Vec3 surface_;
  double time_s_ = 0.0;
  bool grazed_ = false;     ///< met the skin flat
  bool punctured_ = false;  ///< broke the skin
  bool joined_ = false;     ///< joined an earlier track
  std::string wrong_;
};

/// @param joined incremented if the second needle joins the track of the first
/// @return what went wrong with either needle; empty if nothing did
std::string second_needle_beside_a_first(NeedleInBlock& block, Draw& draw, int& joined) {
  const Vec3 place{draw.between(-22.0, 22.0), draw.between(-22.0, 22.0), 0.0};
  const Vec3 axis = draw.near(Vec3::UnitZ(), 45.0);
  Entry first(block, place, axis, Tremor(draw));
  first.go(draw.between(2.0, 12.0));
  first.go(-3.0);
  if (!first.wrong().empty()) return "first needle: " + first.wrong();

  const double beside = draw.one_in_two() ? draw.between(0.0, kDiameter_mm) : draw.between(kDiameter_mm, 5.0);
  const Vec3 through = block.point + beside * draw.across(axis);
  const Vec3 along = draw.near(axis, 12.0);
  Entry second(block, through, along, Tremor(draw));
  second.go(draw.between(8.0, 16.0));
  second.go(-3.0);
  joined += second.joined() ? 1 : 0;
  return second.wrong();
}

TEST(RandomEntries, a_needle_in_tissue_is_never_without_force_whatever_lies_beside_it) {
  std::vector<NeedleInBlock> skins;
  skins.push_back(skin([](double, double) { return 0.0; }, 8));
  skins.push_back(skin([](double x, double y) { return (x * x + y * y) / 100.0; }, 10));          // a sphere
  skins.push_back(skin([](double x, double) { return 6.0 * std::sin(x / 6.0) - x / 3.0; }, 12));  // folds
  const int cases = random_cases(36);
  int wrong = 0, joined = 0;
  for (int k = 0; k < cases; ++k) {
    Draw draw(k);
    const std::string what =
        second_needle_beside_a_first(skins[static_cast<std::size_t>(k) % skins.size()], draw, joined);
    if (what.empty()) continue;
    if (++wrong <= 10) std::cout << "case " << k << ": " << what << "\n";
  }
  std::cout << wrong << " of " << cases << " needles went wrong\n";
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(joined, cases / 20);  // most first needles do not break the skin, or are too far from the second one
}

}  // namespace
}  // namespace stylet::test
