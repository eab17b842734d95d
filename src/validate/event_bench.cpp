// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/validate/event_bench.hpp"

#include "fem/blas_threads.hpp"
#include "reproduce/needle_way.hpp"
#include "stylet/coupling/near_field/near_field_compliance.hpp"
#include "stylet/coupling/paper/dense_inverse.hpp"
#include "stylet/coupling/track_compliance.hpp"
#include "stylet/reproduce/measure.hpp"
#include "stylet/validate/context.hpp"

#include <unistd.h>

#include <algorithm>
#include <functional>

namespace stylet::validate {

namespace {

constexpr double kDepth_mm = 90.0;
constexpr double kSpacing_mm = 2.25;
constexpr int kMostPoints = 40;

Spread spread(std::vector<double> seconds) {
  if (seconds.empty()) return {};
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double q) {
    return 1e6 *
           seconds[std::min(seconds.size() - 1, static_cast<std::size_t>(q * static_cast<double>(seconds.size())))];
  };
  return {at(0.05), at(0.5), at(0.95), 1e6 * seconds.back()};
}

/// Goes through more memory than the caches hold, so that nothing else is left in them.
class ColdCaches {
 public:
  ColdCaches() {
    constexpr long smallest = 64L << 20;
    constexpr long largest = 512L << 20;
    bytes_.resize(static_cast<std::size_t>(std::clamp(2 * sysconf(_SC_LEVEL3_CACHE_SIZE), smallest, largest)));
  }
  void make() {
    constexpr std::size_t line = 64;
    for (std::size_t i = 0; i < bytes_.size(); i += line) ++bytes_[i];
  }

 private:
  std::vector<unsigned char> bytes_;
};

/// A place where a contact is laid.
struct Place {
  Index hint = -1;  ///< element the tip is in
  Vec3 x = Vec3::Zero();
  MaterialPoint at;
};

/// One mesh with all that an insertion needs, for node addition and for the near field.
struct Ground {
  std::shared_ptr<const Model> model;       ///< method = "node-addition": linear tetrahedra
  std::shared_ptr<const Model> near_field;  ///< the default
  reproduce::NeedleWay way;
  std::vector<reproduce::AddedNode> inside;
  std::vector<reproduce::AddedNode> on_faces;
  std::vector<Place> places;
};

Result<std::shared_ptr<const Model>> compile(const TetMesh& mesh, const std::string& method, const Progress& progress) {
  Scenario scenario = demo_scenario();
  scenario.coupling.method = method;
  scenario.insertions.front().depth_mm = kDepth_mm;
  return Model::compile(scenario, mesh, "the demo", {}, progress);
}

Result<Ground> ground_of(const TetMesh& mesh, const Progress& progress) {
  Ground ground;
  auto model = compile(mesh, "node-addition", progress);
  if (!model) return model.error();
  ground.model = *model;
  model = compile(mesh, "near-field", progress);
  if (!model) return model.error();
  ground.near_field = *model;

  const PlannedInsertion& plan = ground.model->insertions().front();
  ground.way.store = ground.model->store();
  ground.way.locator = &ground.model->locator();
  ground.way.from = plan.entry;
  ground.way.to = plan.entry + kDepth_mm * plan.direction;
  reproduce::RemeshCostOptions options{.spacing_mm = kSpacing_mm, .most_nodes = kMostPoints};
  options.placement = Placement::interior;
  ground.inside = reproduce::nodes_along(ground.way, options);
  options.placement = Placement::face;
  ground.on_faces = reproduce::nodes_along(ground.way, options);

  Index hint = -1;
  for (int k = 1; k <= kMostPoints; ++k) {
    const Vec3 x = plan.entry + k * kSpacing_mm * plan.direction;
    const auto at = ground.near_field->locator().find(x, hint, -plan.direction);
    if (!at) break;
    ground.places.push_back({hint < 0 ? at->tet : hint, x, *at});
    hint = at->tet;
  }
  return ground;
}

using Laying = std::function<void(std::size_t)>;

/// Lays `count` contacts round by round and times each one.
std::vector<double> time_rounds(ContactCompliance& compliance, std::size_t count, int rounds, const Laying& lay,
                                ColdCaches* cold) {
  std::vector<double> seconds;
  seconds.reserve(count * static_cast<std::size_t>(rounds));
  for (int round = 0; round < rounds; ++round) {
    compliance.reset();
    for (std::size_t k = 0; k < count; ++k) {
      if (cold != nullptr) cold->make();
      const double started = reproduce::thread_cpu_s();
      lay(k);
      seconds.push_back(reproduce::thread_cpu_s() - started);
    }
  }
  return seconds;
}

EventRow measure(const Ground& ground, const std::string& rule, ContactCompliance& compliance, std::size_t count,
                 const EventBenchOptions& options, const Laying& lay) {
  ColdCaches caches;
  EventRow row;
  row.nodes = ground.model->mesh().node_count();
  row.rule = rule;
  row.points = static_cast<int>(count);
  auto warm = time_rounds(compliance, count, options.rounds, lay, nullptr);
  row.events = static_cast<long>(warm.size());
  row.warm_us = spread(std::move(warm));
  row.cold_us = spread(time_rounds(compliance, count, std::max(1, options.rounds / 5), lay, &caches));
  return row;
}

/// Contacts as Insertion lays them: the search starts where the tip is.
void measure_all(const Ground& ground, std::size_t inside, std::size_t on_faces, std::size_t places,
                 const EventBenchOptions& options, std::vector<EventRow>& rows) {
  const Locator& locator = ground.model->locator();
  const Vec3 travel = (ground.way.to - ground.way.from).normalized();
  TrackCompliance track(ground.way.store, locator, kMostPoints);
  rows.push_back(measure(ground, "interior", track, inside, options, [&](std::size_t k) {
    const Index hint = ground.inside[k == 0 ? 0 : k - 1].at.tet;
    const auto at = locator.find(ground.inside[k].x, hint, -travel);
    track.add(*at, ground.inside[k].x, Placement::interior, travel);
  }));
  rows.push_back(measure(ground, "paper", track, on_faces, options, [&](std::size_t k) {
    const reproduce::AddedNode& node = ground.on_faces[k];
    // The march of the tip tells through which element's face it goes.
    track.add({node.at.tet, locator.weights(node.at.tet, node.x)}, node.x, Placement::face, travel);
  }));

  const Model& model = *ground.near_field;
  const CouplingSettings& settings = model.coupling();
  NearFieldCompliance near_field(std::make_unique<TrackCompliance>(model.store(), model.locator(), kMostPoints),
                                 model.store()->shared_tissue(), model.kernel(),
                                 NeedleKernel{settings.needle_radius_mm, kSpacing_mm}, kMostPoints);
  std::array<int, ContactCompliance::kNeighbours> neighbours{};
  double kept = 0.0;
  rows.push_back(measure(ground, "near-field", near_field, places, options, [&](std::size_t k) {
    const Place& place = ground.places[k];
    const auto at = model.locator().find(place.x, place.hint, -travel);
    const auto added = near_field.add(*at, place.x, Placement::embedded, travel);
    int count = 0;
    for (int point = added.point - 1; point > 0 && count < ContactCompliance::kNeighbours; --point)
      neighbours[static_cast<std::size_t>(count++)] = point;
    // Insertion takes a contact back that follows from its neighbours.
    kept += near_field.independence(added.point, {neighbours.data(), static_cast<std::size_t>(count)});
  }));
}

/// The same nodes on faces in the full inverse.
Result<Spread> woodbury(const Ground& ground, const EventBenchOptions& options) {
  const Tissue& tissue = ground.model->tissue();
  const auto inverse = std::make_shared<const MatX>(paper::full_inverse(tissue));
  const auto room = static_cast<int>(ground.on_faces.size());
  paper::DenseInverse changed(paper::DenseInverse::Engine::woodbury, inverse, room);
  std::vector<double> seconds;
  for (int round = 0; round < options.rounds; ++round) {
    changed.reset();
    Index hint = ground.on_faces.front().at.tet;
    for (const reproduce::AddedNode& node : ground.on_faces) {
      const double started = reproduce::thread_cpu_s();
      const auto at = ground.model->locator().find(node.x, hint, node.travel);
      const MatX change = reproduce::stiffness_change(tissue, node);
      changed.append_node();
      changed.change(node.dofs, change);
      seconds.push_back(reproduce::thread_cpu_s() - started);
      hint = at->tet;
    }
  }
  return spread(std::move(seconds));
}

}  // namespace

const EventRow* EventBench::coarsest(const std::string& rule) const {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const EventRow& row) { return row.rule == rule; });
  return found == rows.end() ? nullptr : &*found;
}

const EventRow* EventBench::finest(const std::string& rule) const {
  const auto found = std::find_if(rows.rbegin(), rows.rend(), [&](const EventRow& row) { return row.rule == rule; });
  return found == rows.rend() ? nullptr : &*found;
}

Result<EventBench> bench_events(const EventBenchOptions& options, const Progress& progress) {
  const detail::OneBlasThread one_thread;
  std::vector<Ground> grounds;
  for (const Index nodes : {570, 5000, 20000}) {
    if (nodes > options.largest) continue;
    const auto anatomy = mesh_demo(nodes, progress);
    if (!anatomy) return anatomy.error();
    auto ground = ground_of(anatomy->mesh, progress);
    if (!ground) return ground.error();
    grounds.push_back(std::move(*ground));
  }
  // As many points on every mesh, for the cost grows with their number.
  std::size_t inside = kMostPoints;
  std::size_t on_faces = kMostPoints;
  std::size_t places = kMostPoints;
  for (const Ground& ground : grounds) {
    inside = std::min(inside, ground.inside.size());
    on_faces = std::min(on_faces, ground.on_faces.size());
    places = std::min(places, ground.places.size());
  }
  if (grounds.empty() || inside == 0 || on_faces == 0 || places == 0)
    return failure("timing changes of the mesh", "no node can be added on the needle's way", "Choose a finer mesh");

  EventBench bench;
  for (std::size_t k = 0; k < grounds.size(); ++k) {
    report(progress, "timing changes of the mesh", static_cast<double>(k) / static_cast<double>(grounds.size()));
    measure_all(grounds[k], inside, on_faces, places, options, bench.rows);
  }
  const auto of_inverse = woodbury(grounds.front(), options);
  if (!of_inverse) return of_inverse.error();
  bench.woodbury_nodes = grounds.front().model->mesh().node_count();
  bench.woodbury_us = *of_inverse;
  report(progress, "timing changes of the mesh", 1.0);
  return bench;
}

}  // namespace stylet::validate
