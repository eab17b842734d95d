// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/mesher/mesher.hpp"

#include "anatomy.hpp"
#include "element_size_search.hpp"
#include "local_changes.hpp"
#include "mesh_report.hpp"
#include "pieces.hpp"
#include "region_surfaces.hpp"
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
constexpr Index kPaperNodes = 570;          // Goksel et al. 2005
constexpr Index kMostNodes = 2000000;       // limited by memory: meshing takes about 2 kB per node
constexpr double kGoodNodeError = 0.024;    // relative error of the number of nodes that ends the attempts
constexpr double kLargestNodeError = 0.03;  // largest relative error of a result
constexpr int kMostAttempts = 4;
constexpr double kNotedVolume = 1000;  // [mm³] a smaller loss of volume is not reported
constexpr double kSeedSpacing = 2.0;   // distance of the seeds of refinement / wanted edge length
constexpr double kQualityGoal = 1.6;   // means dihedral angles of 19.2° … 156°

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

/// Number of Lloyd rounds: many while they are cheap.
int relaxation_rounds(Index nodes) { return std::clamp(60000 / nodes, 5, 20); }

/// One attempt at a finished mesh.
struct Attempt {
  RawMesh mesh;
  Anatomy anatomy;        ///< with the offsets that meet the volumes
  double node_error = 0;  ///< relative error of the number of nodes
  double quality = 0;     ///< quality of the worst element
  [[nodiscard]] bool good() const { return node_error <= kGoodNodeError && quality >= 1; }
};

Result<Attempt> attempt(const Anatomy& a, const SizeField& size, Index wanted, Index aim, const Progress& progress) {
  Attempt out;
  out.anatomy = a;
  auto sized = find_element_size([&](double scale) { return input_for(a, size, scale, wanted); }, aim,
                                 size.scale_for(aim), progress);
  if (!sized) return sized.error();
  report(progress, "optimising elements", 0.0);
  sized->tetrahedra->relax(relaxation_rounds(wanted));
  report(progress, "optimising elements", 0.8);
  RawMesh raw = sized->tetrahedra->mesh();
  sized->tetrahedra.reset();
  const int body = 1 + static_cast<int>(a.find("body") - a.structures.data());
  const double dropped = drop_loose_pieces(raw, body);
  if (dropped > kNotedVolume) {
    out.anatomy.notes.push_back(fmt::format(
        "A part of the body of {:.1f} cc was left out, since it lies apart from the rest.", dropped / 1000));
  }
  EditableMesh editable(std::move(raw));
  improve(editable, out.anatomy, kQualityGoal);
  fit_volumes(editable, out.anatomy);
  improve(editable, out.anatomy, kQualityGoal);
  out.quality = editable.worst_quality();
  out.mesh = editable.result();
  out.node_error = std::abs(static_cast<double>(out.mesh.nodes.size()) / wanted - 1);
  return out;
}

/// The first attempt with the wanted number of nodes and acceptable angles, else the best of a few. Relaxation and
/// loose pieces cost a few nodes, so the next attempt aims higher by as many; another element size may avoid a bad
/// element.
Result<Attempt> best_attempt(const Anatomy& a, const SizeField& size, Index wanted, const Progress& progress) {
  Attempt best;
  best.node_error = HUGE_VAL;
  Index aim = wanted;
  for (int i = 0; i < kMostAttempts && !best.good(); ++i) {
    auto next = attempt(a, size, wanted, aim, progress);
    if (!next) {
      if (i == 0) return next.error();
      break;
    }
    const double nodes = static_cast<double>(next->mesh.nodes.size());
    const bool counts = next->node_error <= kLargestNodeError;
    const bool better = best.node_error > kLargestNodeError ? counts || next->node_error < best.node_error
                                                            : counts && next->quality > best.quality;
    if (better) best = *std::move(next);
    const double other_size = i % 2 == 0 ? 0.993 : 1.006;
    aim = static_cast<Index>(std::lround(aim * std::clamp(wanted / nodes, 0.9, 1.1) * other_size));
  }
  if (best.node_error > kLargestNodeError) {
    return failure(a.source,
                   fmt::format("{} nodes are wanted, but the nearest mesh has {}", wanted, best.mesh.nodes.size()),
                   "Ask for a few more or fewer nodes");
  }
  return best;
}

/// Makes the mesh with its regions in order of priority; fails when a region of the input has no element.
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
      } else if (!structure.generated) {
        return input_error(
            fmt::format("{}, region '{}'", a.source, structure.name),
            fmt::format("it has {:.3f} cc outside other structures, but no element in a mesh of {} nodes",
                        structure.input_volume / 1000, raw.nodes.size()),
            "Ask for more nodes, or leave the structure out (skip below [patient]; stylet mesh: --skip)");
      } else {
        a.notes.push_back(fmt::format(
            "The region '{}', which the mesher adds to the input, was left out: no element of the mesh lies in it.",
            structure.name));
      }
    }
  }
  for (const int l : raw.label) m.tet_region.push_back(region[l - 1]);
  return m;
}

/// The anatomy for pictures: organs as they were given, and the body as it is meshed, since a needle meets the skin
/// there.
Anatomy as_drawn(const Anatomy& given, const Anatomy& meshed) {
  Anatomy drawn = given;
  drawn.layers.back().offset = meshed.layers.back().offset;
  return drawn;
}

Result<MeshedAnatomy> mesh(Anatomy a, const MeshOptions& options, const Progress& progress) {
  const Index preset = options.preset == MeshPreset::paper ? kPaperNodes : kStandardNodes;
  const Index wanted = options.nodes > 0 ? options.nodes : preset;
  if (options.nodes < 0 || wanted > kMostNodes) {
    return input_error("number of nodes", fmt::format("{}, expected 1 to {}", options.nodes, kMostNodes),
                       "Choose a number in this range, or 0 for the default of the preset");
  }
  settle_overlaps(a);
  add_surroundings(a, options);
  const SizeField size(a, options.preset);
  auto best = best_attempt(a, size, wanted, progress);
  if (!best) return best.error();
  report(progress, "measuring the mesh", 0.0);
  auto done = to_mesh(best->mesh, best->anatomy);
  if (!done) return done.error();
  if (auto ok = check_mesh(*done, a.source); !ok) return ok.error();
  MeshedAnatomy out;
  out.mesh = *std::move(done);
  out.report = report_on(out.mesh, best->anatomy);
  out.mesh.surfaces = region_surfaces(as_drawn(a, best->anatomy), out.mesh.regions, progress);
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
