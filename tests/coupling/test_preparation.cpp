// SPDX-License-Identifier: GPL-3.0-or-later
// The next tangent is made in pieces beside the present one (src/coupling/balance/needle_tangent.hpp).
#include "needle_in_block.hpp"

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

/// A needle that counts the pieces of tangents that it makes.
class CountedNeedle final : public Needle {
 public:
  /// @param prepares false: each tangent is made in one piece
  CountedNeedle(std::unique_ptr<Needle> inner, bool prepares, int& pieces)
      : inner_(std::move(inner)), prepares_(prepares), pieces_(pieces) {}
  [[nodiscard]] double length() const override { return inner_->length(); }
  [[nodiscard]] std::string model() const override { return inner_->model(); }
  void set_base(const Pose& base) override { inner_->set_base(base); }
  [[nodiscard]] const Pose& base() const override { return inner_->base(); }
  [[nodiscard]] Vec3 point(double s) const override { return inner_->point(s); }
  [[nodiscard]] Vec3 tangent(double s) const override { return inner_->tangent(s); }
  [[nodiscard]] AxisPlace place(double s) const override { return inner_->place(s); }
  bool linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                 std::span<const Mat3> springs, Indefinite otherwise) override {
    ++pieces_;
    return inner_->linearise(loads, compliance, free, springs, otherwise);
  }
  bool relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) override { return inner_->relax(loads, free); }
  bool append(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance) override {
    return inner_->append(loads, compliance);
  }
  [[nodiscard]] bool prepares() const override { return prepares_; }
  bool prepare(std::span<const PointLoad> loads, std::span<const Mat3> springs, Indefinite otherwise) override {
    ++pieces_;
    return inner_->prepare(loads, springs, otherwise);
  }
  bool prepared_compliance(Eigen::Ref<MatX> compliance) override {
    ++pieces_;
    return inner_->prepared_compliance(compliance);
  }
  void take_prepared() override { inner_->take_prepared(); }
  void advance(std::span<const PointLoad> loads) override { inner_->advance(loads); }
  [[nodiscard]] double residual(std::span<const PointLoad> loads) override { return inner_->residual(loads); }
  void damp(double ratio) override { inner_->damp(ratio); }
  void straighten() override { inner_->straighten(); }
  [[nodiscard]] double energy() const override { return inner_->energy(); }
  [[nodiscard]] Eigen::Ref<const VecX> state() const override { return inner_->state(); }
  void set_state(const Eigen::Ref<const VecX>& state) override { inner_->set_state(state); }

 private:
  std::unique_ptr<Needle> inner_;
  bool prepares_;
  int& pieces_;
};

struct Driven {
  std::vector<double> forces;
  double peak = 0.0;
  int iterations_after_turns = 0;
  int steps_with_tangents = 0;
  int most_tangents = 0;
};

/// In and out at two places, each with a back-and-forth motion; the second insertion begins before the needle
/// is all out of the first.
Driven drive(bool prepares) {
  int pieces = 0;
  BlockOptions options;
  options.needle = [&](int capacity) -> std::unique_ptr<Needle> {
    auto beam = BeamNeedle::build({150.0, 1.27, 15700, 12100}, 20, capacity).value();
    return std::make_unique<CountedNeedle>(std::move(beam), prepares, pieces);
  };
  NeedleInBlock run(options);
  Driven result;
  const auto go = [&](double to, int* iterations = nullptr) {
    const double way = to > run.depth ? 0.02 : -0.02;
    for (long k = std::lround((to - run.depth) / way); k > 0; --k) {
      run.depth += way;
      pieces = 0;
      run.step(1e-3);
      if (iterations != nullptr) *iterations += run.report.iterations;
      if (pieces > 0) ++result.steps_with_tangents;
      result.most_tangents = std::max(result.most_tangents, pieces);
    }
  };
  for (const Vec3& through : {Vec3(1.3, 0.7, 0.0), Vec3(-3.2, 2.1, 0.0)}) {
    run.aim(through, {0.02, 0.01, 1.0});
    go(24.0);
    go(20.0, &result.iterations_after_turns);
    go(27.3, &result.iterations_after_turns);
    go(9.1);
  }
  EXPECT_EQ(run.flags, 0u);
  result.forces = run.forces;
  result.peak = run.peak();
  return result;
}

TEST(PreparedTangent, changes_no_balance_wherever_the_needle_is_put_meanwhile) {
  const Driven prepared = drive(true);
  const Driven at_once = drive(false);
  ASSERT_EQ(prepared.forces.size(), at_once.forces.size());
  for (std::size_t k = 0; k < prepared.forces.size(); ++k)
    ASSERT_NEAR(prepared.forces[k], at_once.forces[k], 1e-6 * prepared.peak) << "step " << k;
  EXPECT_LT(prepared.iterations_after_turns, at_once.iterations_after_turns);
  EXPECT_GT(prepared.steps_with_tangents, 3 * at_once.steps_with_tangents);
  EXPECT_EQ(prepared.most_tangents, 1) << "pieces in a step";
}

}  // namespace
}  // namespace stylet
