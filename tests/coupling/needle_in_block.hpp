// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/insertion.hpp"
#include "stylet/coupling/paper/dense_inverse.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/needle/beam.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

namespace stylet::test {

/// The usual step; twice as long under sanitizers, which check the execution of a step and not its results.
inline constexpr double kStep_s = kSanitized ? 2e-3 : 1e-3;

/// A block of tissue 100 mm wide and deep, skin at z = 0, held at its sides and bottom, and a needle along z.
struct BlockOptions {
  std::array<int, 3> cells{8, 8, 8};
  Vec3 lo{-50, -50, 0};
  Vec3 hi{50, 50, 100};
  double jitter = 0.1;
  std::vector<std::string> regions{"body", "prostate"};
  std::function<int(const Vec3&)> region_at = [](const Vec3& x) { return (x - Vec3(0, 0, 45)).norm() < 20.0 ? 1 : 0; };
  std::vector<Material> materials{{0.06, 0.45}, {0.04, 0.45}};
  std::vector<RegionLaws> laws{{0.35, 1.0, {18e-3, 11e-3, 250e-6, 50.0}, false, true, -1},
                               {0.25, 0.6, {18e-3, 11e-3, 250e-6, 50.0}, false, false, -1}};
  std::function<bool(const Vec3&)> held = [](const Vec3& x) {
    return std::abs(x.x()) > 49.9 || std::abs(x.y()) > 49.9 || x.z() > 99.9;
  };
  std::function<void(TetMesh&)> edit;  ///< called to change the mesh before the tissue is built
  Element element = Element::p1;
  CouplingSettings coupling;
  double needle_length = 150.0;
  std::function<std::unique_ptr<Needle>(int load_capacity)> needle;  ///< makes the needle; empty: the usual beam
  std::vector<NeedleWay> ways;  ///< ways along which the wide part of the compliance is precomputed
};

struct Happened {
  EventKind kind;
  int region;
  double depth;
  double force;  ///< [N] along the motion's axis, before the step
};

class NeedleInBlock {
 public:
  explicit NeedleInBlock(const BlockOptions& options = {}) {
    TetMesh mesh = box_mesh(options.lo, options.hi, options.cells, options.jitter);
    assign_regions(mesh, options.regions, options.region_at);
    if (options.edit) options.edit(mesh);
    std::vector<Index> fixed;
    for (Index node = 0; node < mesh.node_count(); ++node) {
      if (options.held(mesh.nodes[static_cast<std::size_t>(node)])) fixed.push_back(node);
    }
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      if (options.laws[static_cast<std::size_t>(mesh.tet_region[t])].rigid)
        fixed.insert(fixed.end(), mesh.tets[t].begin(), mesh.tets[t].end());
    }
    std::sort(fixed.begin(), fixed.end());
    fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
    auto built = Tissue::build(std::move(mesh), options.materials, fixed, {}, options.element);
    if (!built) {
      ADD_FAILURE() << built.error().message();
      return;
    }
    tissue = std::make_shared<const Tissue>(std::move(*built));
    topology = std::make_unique<Topology>(tissue->mesh());
    locator = std::make_unique<Locator>(tissue->mesh(), *topology);
    store = std::make_shared<ComplianceStore>(tissue);
    const int capacity = options.coupling.capacity + 1;
    std::unique_ptr<Needle> needle =
        options.needle ? options.needle(capacity)
                       : BeamNeedle::build({options.needle_length, 1.27, 15700, 12100}, 20, capacity).value();
    std::shared_ptr<const MatX> inverse;
    if (options.coupling.engine != CouplingSettings::Engine::condensed)
      inverse = std::make_shared<const MatX>(paper::full_inverse(*tissue));
    std::shared_ptr<const SpreadCompliance> spread;
    if (!options.ways.empty())
      spread = std::make_shared<const SpreadCompliance>(SpreadCompliance::solve(*tissue, options.ways).value());
    insertion =
        std::make_unique<Insertion>(InsertionTissue{store, locator.get(), options.laws, inverse, nullptr, spread},
                                    std::move(needle), options.coupling);
    length = options.needle_length;
  }

  /// Puts the needle in front of the skin: at depth 0 its straight tip is at `through`. Its direction is `axis`.
  void aim(const Vec3& through, const Vec3& axis_ = Vec3::UnitZ(), double start = -1.0) {
    point = through;
    axis = axis_.normalized();
    depth = start;
    insertion->place(pose());
  }

  [[nodiscard]] Pose pose() const {
    return {point + sideways + (depth - length) * axis,
            Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis) * Eigen::AngleAxisd(roll, Vec3::UnitZ())};
  }

  /// Moves the base along the axis to a depth at a speed, and records forces and events.
  void go(double to, double speed = 20.0, double dt = kStep_s) {
    const double way = to - depth;
    const auto steps = std::max<long>(1, std::lround(std::abs(way) / (speed * dt)));
    const double from = depth;
    for (long k = 1; k <= steps; ++k) {
      depth = from + way * static_cast<double>(k) / static_cast<double>(steps);
      step(dt);
    }
  }
  void wait(double seconds, double dt = kStep_s) {
    for (long k = 0; k < std::lround(seconds / dt); ++k) step(dt);
  }

  void step(double dt) {
    insertion->prepare(8.0);
    const double before = forces.empty() ? 0.0 : forces.back();
    const Vec3 base_before = last_base;
    report = insertion->step(pose(), dt);
    last_base = pose().origin;
    // The base is only translated in these tests, so the hand's work is force times distance.
    if (!forces.empty()) work += 0.5 * (report.hand_force_N + last_force).dot(last_base - base_before);
    last_force = report.hand_force_N;
    forces.push_back(report.hand_force_N.dot(axis));
    depths.push_back(depth);
    int shaft = 0;
    for (const ContactState& contact : insertion->contacts()) shaft += contact.tip ? 0 : 1;
    contact_counts.push_back(shaft);
    flags |= report.flags;
    for (const InsertionEvent& event : insertion->events())
      happened.push_back({event.kind, event.region, depth, before});
  }

  [[nodiscard]] int count(EventKind kind, int region = -2) const {
    int n = 0;
    for (const Happened& h : happened) n += h.kind == kind && (region == -2 || h.region == region) ? 1 : 0;
    return n;
  }
  [[nodiscard]] const Happened* first(EventKind kind, int region = -2) const {
    for (const Happened& h : happened) {
      if (h.kind == kind && (region == -2 || h.region == region)) return &h;
    }
    return nullptr;
  }
  [[nodiscard]] double peak() const {
    double p = 0.0;
    for (const double f : forces) p = std::max(p, std::abs(f));
    return p;
  }

  std::shared_ptr<const Tissue> tissue;
  std::unique_ptr<Topology> topology;
  std::unique_ptr<Locator> locator;
  std::shared_ptr<ComplianceStore> store;
  std::unique_ptr<Insertion> insertion;
  double length = 150.0;
  Vec3 point = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
  Vec3 sideways = Vec3::Zero();
  double depth = 0.0;
  double roll = 0.0;  ///< [rad] rotation of the base about the axis
  Step report;
  unsigned flags = 0;
  double work = 0.0;
  Vec3 last_force = Vec3::Zero();
  Vec3 last_base = Vec3::Zero();
  std::vector<double> forces;
  std::vector<double> depths;
  std::vector<int> contact_counts;  ///< number of shaft contacts
  std::vector<Happened> happened;
};

}  // namespace stylet::test
