// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/mesher/mesher.hpp"

#include "anatomy.hpp"
#include "element_size_search.hpp"
#include "local_changes.hpp"
#include "mesh_report.hpp"
#include "pieces.hpp"
#include "seeds.hpp"
#include "sizing.hpp"
#include "volume_fit.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>

namespace stylet {
namespace meshing {
namespace {

constexpr Index kStandardNodes = 3000;
constexpr Index kPaperNodes = 570;     // Goksel et al. 2005
constexpr Index kMostNodes = 2000000;  // memory: about 2 kB each while meshing
constexpr double kGoodNodeError = 0.024;
constexpr double kLargestNodeError = 0.03;
constexpr int kMostAttempts = 4;
constexpr double kSeedSpacing = 2.0;  // wanted edge lengths between the points refinement starts from
constexpr double kQualityGoal = 1.6;  // dihedral angles 19.2° … 156° wherever they can be had

TetrahedraliserInput input_for(const Anatomy& a, const SizeField& size, double scale, Index nodes) {
  TetrahedraliserInput in;
  in.label = [&a](const Vec3& p) { return a.label(p); };
  in.size = [&size, scale](const Vec3& p) { return size(p, scale); };
  in.box = a.box();
  in.box.min().array() -= 5;
  in.box.max().array() += 5;
  in.seeds = surface_seeds(a, size, scale, kSeedSpacing);
  in.most_nodes = static_cast<std::size_t>(nodes) * 6 + 20000;
  return in;
}

/// Lloyd rounds: many while they are cheap.
int relaxation_rounds(Index nodes) { return std::clamp(60000 / nodes, 5, 20); }

/// Refined, relaxed and in one piece, with the wanted number of nodes. The last two steps cost a few nodes; where that
/// is too many, once more with as many more.
Result<RawMesh> relaxed_mesh(Anatomy& a, const SizeField& size, Index wanted, const Progress& progress) {
  const int body = 1 + static_cast<int>(a.find("body") - a.structures.data());
  Index aim = wanted;
  RawMesh best;
  double best_error = HUGE_VAL;
  double dropped = 0;
  for (int attempt = 0; attempt < kMostAttempts && best_error > kGoodNodeError; ++attempt) {
    auto sized = find_element_size([&](double scale) { return input_for(a, size, scale, wanted); }, aim,
                                   size.scale_for(aim), progress);
    if (!sized) return sized.error();
    report(progress, "optimising elements", 0.0);
    sized->tetrahedra->relax(relaxation_rounds(wanted));
    RawMesh raw = sized->tetrahedra->mesh();
    const double loose = drop_loose_pieces(raw, body);
    const double nodes = static_cast<double>(raw.nodes.size());
    if (std::abs(nodes / wanted - 1) < best_error) {
      best_error = std::abs(nodes / wanted - 1);
      best = std::move(raw);
      dropped = loose;
    }
    aim = static_cast<Index>(std::lround(aim * wanted / nodes));
  }
  if (best_error > kLargestNodeError) {
    return failure(a.source, fmt::format("{} nodes wanted, the nearest mesh has {}", wanted, best.nodes.size()),
                   "ask for a few more or fewer nodes");
  }
  if (dropped > 1000) a.notes.push_back(fmt::format("{:.1f} cc of body apart from the rest left out", dropped / 1000));
  return best;
}

/// Regions in order of priority; an error where one of the input has got lost.
Result<TetMesh> to_mesh(const RawMesh& raw, Anatomy& a) {
  TetMesh m;
  m.nodes = raw.nodes;
  m.tets = raw.tets;
  std::vector<int> region(a.structures.size(), -1);
  for (const Layer& layer : a.layers) {
    for (const int s : layer.members) {
      const Structure& structure = a.structures[s];
      if (std::find(raw.label.begin(), raw.label.end(), s + 1) != raw.label.end()) {
        region[s] = static_cast<int>(m.regions.size());
        m.regions.push_back(structure.name);
      } else if (structure.input_volume > 0) {
        return input_error(fmt::format("{}, region '{}'", a.source, structure.name),
                           fmt::format("it has {:.3f} cc outside other structures and no element at {} nodes",
                                       structure.input_volume / 1000, raw.nodes.size()),
                           "ask for more nodes or leave the structure out");
      } else {
        a.notes.push_back(fmt::format("the generated region '{}' found no room", structure.name));
      }
    }
  }
  for (const int l : raw.label) m.tet_region.push_back(region[l - 1]);
  return m;
}

Result<MeshedAnatomy> mesh(Anatomy a, const MeshOptions& options, const Progress& progress) {
  const Index preset = options.preset == MeshPreset::paper ? kPaperNodes : kStandardNodes;
  const Index wanted = options.nodes > 0 ? options.nodes : preset;
  if (options.nodes < 0 || wanted > kMostNodes) {
    return input_error("number of nodes", fmt::format("{}, expected 1 to {}", options.nodes, kMostNodes),
                       "choose a number between, or 0 for the preset's own");
  }
  settle_overlaps(a);
  add_surroundings(a, options);
  const SizeField size(a, options.preset);
  auto relaxed = relaxed_mesh(a, size, wanted, progress);
  if (!relaxed) return relaxed.error();
  RawMesh raw = *std::move(relaxed);
  EditableMesh editable(std::move(raw));
  improve(editable, a, kQualityGoal);
  report(progress, "fitting volumes", 0.8);
  fit_volumes(editable, a);
  improve(editable, a, kQualityGoal);
  report(progress, "measuring the mesh", 0.9);
  auto done = to_mesh(editable.result(), a);
  if (!done) return done.error();
  if (auto ok = check_mesh(*done, a.source); !ok) return ok.error();
  MeshedAnatomy out;
  out.mesh = *std::move(done);
  out.report = report_on(out.mesh, a);
  report(progress, "measuring the mesh", 1.0);
  return out;
}

template <class Input>
Result<MeshedAnatomy> timed(const Input& input, const MeshOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  auto a = anatomy_of(input, options, progress);
  if (!a) return a.error();
  auto out = mesh(*std::move(a), options, progress);
  if (out) out->report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace
}  // namespace meshing

Result<MeshedAnatomy> mesh_contours(const ContourSet& contours, const MeshOptions& options, const Progress& progress) {
  return meshing::timed(contours, options, progress);
}

Result<MeshedAnatomy> mesh_labels(const LabelImage& image, const MeshOptions& options, const Progress& progress) {
  return meshing::timed(image, options, progress);
}

}  // namespace stylet
