// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/event_bench.hpp"

#include "fem/blas_threads.hpp"
#include "measure/needle_way.hpp"
#include "stylet/coupling/near_field/near_field_compliance.hpp"
#include "stylet/coupling/paper/dense_inverse.hpp"
#include "stylet/coupling/track_compliance.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/measure/timing.hpp"

#include <unistd.h>

#include <algorithm>
#include <functional>
#include <optional>

namespace stylet::measure {

namespace {

constexpr double kDepth_mm = 90.0;
constexpr double kSpacing_mm = 2.25;
constexpr int kMostPoints = 40;
/// Distance of the tip beyond a face when a node is laid on it: half of a step at 50 mm/s and 1 kHz.
constexpr double kBeyondFace_mm = 0.025;

Spread spread(std::vector<double> seconds) {
  if (seconds.empty()) return {};
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double q) {
    return 1e6 *
           seconds[std::min(seconds.size() - 1, static_cast<std::size_t>(q * static_cast<double>(seconds.size())))];
  };
  return {at(0.05), at(0.5), at(0.95), 1e6 * seconds.back()};
}

/// Empties the processor's caches by writing more memory than they hold.
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

/// A place at which a contact is laid.
struct Place {
  Index hint = -1;  ///< element that contains the tip
  Vec3 x = Vec3::Zero();
  MaterialPoint at;
};

/// One mesh with the models of the insertion for node addition and for the near field.
struct Ground {
  std::shared_ptr<const Model> model;       ///< method = "node-addition": linear tetrahedra
  std::shared_ptr<const Model> near_field;  ///< the default
  measure::NeedleWay way;
  std::vector<measure::AddedNode> inside;
  std::vector<measure::AddedNode> on_faces;
  std::vector<Place> places;
};

Result<std::shared_ptr<const Model>> compile(const TetMesh& mesh, const std::string& method, const Progress& progress) {
  Scenario scenario = demo_scenario();
  scenario.coupling.method = choice<CouplingSettings::Method>(method).value();
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
  measure::RemeshCostOptions options{.spacing_mm = kSpacing_mm, .most_nodes = kMostPoints};
  options.placement = Placement::interior;
  ground.inside = measure::nodes_along(ground.way, options);
  options.placement = Placement::face;
  ground.on_faces = measure::nodes_along(ground.way, options);

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

/// A rule by which contacts are laid, place after place.
struct Way {
  std::string rule;
  std::size_t places = 0;
  std::function<void()> begin;            ///< removes all contacts
  std::function<bool(std::size_t)> come;  ///< moves the tip to the k-th place; false: it cannot
  std::function<bool(std::size_t)> lay;   ///< lays the k-th contact, which is timed; false: it cannot
  std::vector<double> warm_s{};
  std::vector<double> cold_s{};
  int refused = 0;

  /// Lays all contacts. @param seconds receives the time of each event @param cold empties the caches before each event
  void go(std::vector<double>& seconds, ColdCaches* cold) {
    begin();
    for (std::size_t k = 0; k < places; ++k) {
      refused += come(k) ? 0 : 1;
      if (cold != nullptr) cold->make();
      const double started = measure::thread_cpu_s();
      refused += lay(k) ? 0 : 1;
      seconds.push_back(measure::thread_cpu_s() - started);
    }
  }
};

/// Times all rules in turn, so that disturbances by other programs affect all of them alike.
void time_by_turns(std::vector<Way>& ways, const EventBenchOptions& options) {
  constexpr int rounds_in_turn = 5;
  for (int turn = 0; turn < options.turns; ++turn) {
    for (Way& way : ways) {
      std::vector<double> after_another_way;  // not counted: the caches hold data of another rule
      way.go(after_another_way, nullptr);
      for (int round = 0; round < rounds_in_turn; ++round) way.go(way.warm_s, nullptr);
    }
  }
  ColdCaches caches;
  for (int turn = 0; turn < options.cold_turns; ++turn) {
    for (Way& way : ways) way.go(way.cold_s, &caches);
  }
}

/// Number of places of each rule. It is the same on every mesh, because the time of an event grows with it.
struct Places {
  std::size_t inside = kMostPoints;
  std::size_t on_faces = kMostPoints;
  std::size_t near_field = kMostPoints;
};

/// Times contacts as Insertion lays them: the search starts at the tip's element. With `with_woodbury`, also times
/// nodes on faces with an update of the full inverse.
Result<> measure(const Ground& ground, const Places& places, const EventBenchOptions& options, bool with_woodbury,
                 EventBench& bench) {
  const Locator& locator = ground.model->locator();
  const Vec3 travel = (ground.way.to - ground.way.from).normalized();
  std::vector<Way> ways;

  TrackCompliance inside(ground.way.store, locator, kMostPoints);
  ways.push_back({.rule = "interior",
                  .places = places.inside,
                  .begin = [&] { inside.reset(); },
                  .come = [&](std::size_t k) { return inside.move_tip(ground.inside[k].at, ground.inside[k].x); },
                  .lay =
                      [&](std::size_t k) {
                        const Index hint = ground.inside[k == 0 ? 0 : k - 1].at.tet;
                        const auto at = locator.find(ground.inside[k].x, hint, -travel);
                        return inside.add(*at, ground.inside[k].x, Placement::interior, travel).point > 0;
                      }});

  TrackCompliance on_faces(ground.way.store, locator, kMostPoints);
  ways.push_back({.rule = "paper",
                  .places = places.on_faces,
                  .begin = [&] { on_faces.reset(); },
                  .come =
                      [&](std::size_t k) {
                        const measure::AddedNode& node = ground.on_faces[k];
                        const Vec3 beyond = node.x + kBeyondFace_mm * travel;
                        const auto at = locator.find(beyond, node.at.tet, travel);
                        return at && on_faces.move_tip(*at, beyond);
                      },
                  .lay =
                      [&](std::size_t k) {
                        const measure::AddedNode& node = ground.on_faces[k];
                        // The tip's path through the elements gives the element whose face is crossed.
                        const MaterialPoint at{node.at.tet, locator.weights(node.at.tet, node.x)};
                        return on_faces.add(at, node.x, Placement::face, travel).point > 0;
                      }});

  const Model& model = *ground.near_field;
  const CouplingSettings& settings = model.coupling();
  NearFieldCompliance near_field(std::make_unique<TrackCompliance>(model.store(), model.locator(), kMostPoints),
                                 model.store()->shared_tissue(), model.kernel(),
                                 NeedleKernel{settings.needle_radius_mm, kSpacing_mm}, kMostPoints);
  std::array<int, ContactCompliance::kNeighbours> neighbours{};
  ways.push_back({.rule = "near-field",
                  .places = places.near_field,
                  .begin = [&] { near_field.reset(); },
                  .come = [&](std::size_t k) { return near_field.move_tip(ground.places[k].at, ground.places[k].x); },
                  .lay =
                      [&](std::size_t k) {
                        const Place& place = ground.places[k];
                        const auto at = model.locator().find(place.x, place.hint, -travel);
                        const auto added = near_field.add(*at, place.x, Placement::embedded, travel);
                        if (added.point < 0) return false;
                        int count = 0;
                        for (int point = added.point - 1; point > 0 && count < ContactCompliance::kNeighbours; --point)
                          neighbours[static_cast<std::size_t>(count++)] = point;
                        // Insertion removes a contact whose compliance follows from its neighbours, so it tests this.
                        const std::span<const int> near(neighbours.data(), static_cast<std::size_t>(count));
                        return near_field.independence(added.point, near) > 0.0;
                      }});

  const Tissue& tissue = ground.model->tissue();
  std::optional<paper::DenseInverse> inverse;
  if (with_woodbury) {
    inverse.emplace(paper::DenseInverse::Engine::woodbury, std::make_shared<const MatX>(paper::full_inverse(tissue)),
                    static_cast<int>(places.on_faces));
    ways.push_back({.rule = "woodbury",
                    .places = places.on_faces,
                    .begin = [&] { inverse->reset(); },
                    .come = [](std::size_t) { return true; },
                    .lay =
                        [&](std::size_t k) {
                          const measure::AddedNode& node = ground.on_faces[k];
                          const auto at = locator.find(node.x, ground.on_faces[k == 0 ? 0 : k - 1].at.tet, node.travel);
                          inverse->append_node();
                          inverse->change(node.dofs, measure::stiffness_change(tissue, node));
                          return at.has_value();
                        }});
  }

  time_by_turns(ways, options);
  for (Way& way : ways) {
    if (way.refused > 0)
      return failure("timing changes of the mesh", "a node was refused at a place where it had been added before",
                     "Report this fault of the program");
    if (way.rule == "woodbury") {
      bench.woodbury_nodes = ground.model->mesh().node_count();
      bench.woodbury_us = spread(std::move(way.warm_s));
      bench.woodbury_cold_us = spread(std::move(way.cold_s));
      continue;
    }
    bench.rows.push_back({.nodes = ground.model->mesh().node_count(),
                          .rule = way.rule,
                          .points = static_cast<int>(way.places),
                          .events = static_cast<long>(way.warm_s.size()),
                          .warm_us = spread(std::move(way.warm_s)),
                          .cold_us = spread(std::move(way.cold_s))});
  }
  return Ok{};
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
  Places places;
  for (const Ground& ground : grounds) {
    places.inside = std::min(places.inside, ground.inside.size());
    places.on_faces = std::min(places.on_faces, ground.on_faces.size());
    places.near_field = std::min(places.near_field, ground.places.size());
  }
  if (grounds.empty() || places.inside == 0 || places.on_faces == 0 || places.near_field == 0)
    return failure("timing changes of the mesh", "no node can be added on the needle's way", "Choose a finer mesh");

  EventBench bench;
  for (std::size_t k = 0; k < grounds.size(); ++k) {
    report(progress, "timing changes of the mesh", static_cast<double>(k) / static_cast<double>(grounds.size()));
    const auto measured = measure(grounds[k], places, options, k == 0, bench);
    if (!measured) return measured.error();
  }
  report(progress, "timing changes of the mesh", 1.0);
  return bench;
}

}  // namespace stylet::measure
