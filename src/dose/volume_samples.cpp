// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of structures that are volumes already: labels of masks and regions of meshes.
#include "dose/sampling.hpp"
#include "stylet/dose/structure_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace stylet {

namespace {

/// Number of parts of at most the step's length.
int parts_of(double length, double step) { return std::max(1, static_cast<int>(std::ceil(length / step - 1e-9))); }

double longest_edge(const std::array<Vec3, 4>& corner) {
  double longest = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) longest = std::max(longest, (corner[a] - corner[b]).norm());
  }
  return longest;
}

/// Number of parts of the edges of a tetrahedron: about one sample for a cube of the step, as in other structures, and
/// in a flat or long tetrahedron more, so that no part is longer than three steps.
int parts_of(const std::array<Vec3, 4>& corner, double volume, double step) {
  constexpr double longest_part = 3.0;
  return parts_of(std::max(std::cbrt(volume), longest_edge(corner) / longest_part), step);
}

/// Divides a tetrahedron into parts³ tetrahedra of equal volume and adds their centroids. It is the image of the set
/// 1 ≥ a ≥ b ≥ c ≥ 0 under x₀ + a (x₁ − x₀) + b (x₂ − x₁) + c (x₃ − x₂). Each small cube of this space is divided into
/// six tetrahedra in the same way, one for each order of the coordinates (Kuhn 1960), and each of them lies wholly
/// inside or wholly outside.
void add_parts(const std::array<Vec3, 4>& corner, int parts, double volume, StructureSamples& samples) {
  const Vec3 along = corner[1] - corner[0], across = corner[2] - corner[1], up = corner[3] - corner[2];
  static constexpr std::array<std::array<double, 3>, 6> centroids{{{0.75, 0.5, 0.25},
                                                                   {0.75, 0.25, 0.5},
                                                                   {0.5, 0.75, 0.25},
                                                                   {0.25, 0.75, 0.5},
                                                                   {0.5, 0.25, 0.75},
                                                                   {0.25, 0.5, 0.75}}};
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; j <= i; ++j) {
      for (int k = 0; k <= j; ++k) {
        for (const auto& centroid : centroids) {
          const double a = i + centroid[0], b = j + centroid[1], c = k + centroid[2];
          if (a < b || b < c) continue;
          const Vec3 centroid_mm = corner[0] + (a * along + b * across + c * up) / parts;
          samples.points.push_back(centroid_mm);
          samples.volume_mm3.push_back(volume);
        }
      }
    }
  }
}

}  // namespace

double sampling_step_mm(double volume_cc) {
  constexpr double most_samples = 4e6;
  if (volume_cc < 2.0) return 0.25;
  return std::max(0.5, std::cbrt(1000.0 * volume_cc / most_samples));
}

Result<StructureSamples> sample_structure(const LabelImage& image, int label, double step_mm) {
  const std::string where = "label " + std::to_string(label) + " of " + image.source;
  if (Result<> good = dose::check_step(step_mm, where); !good) return good.error();
  const auto voxels = std::count(image.labels.begin(), image.labels.end(), static_cast<std::uint16_t>(label));
  if (voxels == 0) return input_error(where, "no voxel has this label", "Name a label that the mask contains");
  std::array<int, 3> parts{};
  double all = static_cast<double>(voxels);
  for (int axis = 0; axis < 3; ++axis) {
    parts[static_cast<std::size_t>(axis)] = parts_of(image.spacing[axis], step_mm);
    all *= parts[static_cast<std::size_t>(axis)];
  }
  if (all > dose::kMostSamples) return dose::too_many_samples(step_mm, where);
  const double volume = image.spacing.prod() / (static_cast<double>(parts[0]) * parts[1] * parts[2]);
  StructureSamples samples;
  const auto middle = [](int part, int number) { return (part + 0.5) / number - 0.5; };
  std::size_t voxel = 0;
  for (Index k = 0; k < image.size[2]; ++k) {
    for (Index j = 0; j < image.size[1]; ++j) {
      for (Index i = 0; i < image.size[0]; ++i, ++voxel) {
        if (image.labels[voxel] != label) continue;
        for (int c = 0; c < parts[2]; ++c) {
          for (int b = 0; b < parts[1]; ++b) {
            for (int a = 0; a < parts[0]; ++a) {
              samples.points.push_back(
                  image.voxel_centre(i + middle(a, parts[0]), j + middle(b, parts[1]), k + middle(c, parts[2])));
              samples.volume_mm3.push_back(volume);
            }
          }
        }
      }
    }
  }
  return samples;
}

Result<StructureSamples> sample_structure(const TetMesh& mesh, int region, double step_mm) {
  const bool known = region >= 0 && region < static_cast<int>(mesh.regions.size());
  const std::string where =
      known ? "region '" + mesh.regions[static_cast<std::size_t>(region)] + "'" : "region " + std::to_string(region);
  if (Result<> good = dose::check_step(step_mm, where); !good) return good.error();
  StructureSamples samples;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    if (mesh.tet_region[static_cast<std::size_t>(t)] != region) continue;
    std::array<Vec3, 4> corner;
    for (std::size_t a = 0; a < 4; ++a)
      corner[a] = mesh.nodes[static_cast<std::size_t>(mesh.tets[static_cast<std::size_t>(t)][a])];
    const int parts = parts_of(corner, tet_volume(mesh, t), step_mm);
    const double number = std::pow(parts, 3);
    if (static_cast<double>(samples.points.size()) + number > dose::kMostSamples)
      return dose::too_many_samples(step_mm, where);
    add_parts(corner, parts, tet_volume(mesh, t) / number, samples);
  }
  if (samples.points.empty())
    return input_error(where, "no tetrahedron has this region", "Name a region that the mesh contains");
  return samples;
}

}  // namespace stylet
