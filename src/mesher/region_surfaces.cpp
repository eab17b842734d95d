// SPDX-License-Identifier: GPL-3.0-or-later
#include "region_surfaces.hpp"

#include "simplify_surface.hpp"
#include "stylet/core/parallel.hpp"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stylet::meshing {
namespace {

constexpr double kFine_mm = 1.4;    ///< spacing of the samples of an organ's distances …
constexpr double kFinest_mm = 0.7;  ///< … and of a thin one
constexpr double kOfRadius = 0.25;  ///< spacing over half the thickness of a thin organ
constexpr double kCoarse_mm = 2.8;  ///< of tissue around organs, whose surfaces are large
constexpr double kLongest = 3.0;    ///< longest edge that simplification removes, over the spacing
/// Smallest distance of a sample from the surface, over the spacing. It keeps triangles from becoming points, and moves
/// the surface by no more than this.
constexpr double kNearest = 0.04;
constexpr double kSmallest_mm3 = 20.0;  ///< smaller pieces are crumbs between surfaces that nearly touch

double spacing_of(const Structure& s, const Layer& layer) {
  if (layer.clipped || s.name == "body") return kCoarse_mm;
  return std::clamp(kOfRadius * s.shape->inner_radius(), kFinest_mm, kFine_mm);
}

/// Signed distances on a grid, positive inside.
struct Samples {
  Vec3 low = Vec3::Zero();
  double spacing = 1.0;
  std::array<int, 3> size{};
  std::vector<float> values;
};

Samples sample(const Anatomy& a, int structure) {
  const Structure& s = a.structures[static_cast<std::size_t>(structure)];
  const Layer& layer = a.layers[static_cast<std::size_t>(a.layer_of(structure + 1))];
  Eigen::AlignedBox3d box = layer.box;
  if (layer.clipped) box = box.intersection(a.layers.back().box);
  Samples out;
  out.spacing = spacing_of(s, layer);
  out.low = box.min() - Vec3::Constant(out.spacing);
  for (int k = 0; k < 3; ++k) out.size[k] = static_cast<int>(std::ceil(box.sizes()[k] / out.spacing)) + 3;
  out.values.resize(static_cast<std::size_t>(out.size[0]) * out.size[1] * out.size[2]);
  const double least = kNearest * out.spacing;
  float* value = out.values.data();
  for (int k = 0; k < out.size[2]; ++k) {
    for (int j = 0; j < out.size[1]; ++j) {
      for (int i = 0; i < out.size[0]; ++i, ++value) {
        const bool at_rim =
            i == 0 || j == 0 || k == 0 || i + 1 == out.size[0] || j + 1 == out.size[1] || k + 1 == out.size[2];
        const double d = at_rim ? out.spacing : a.distance_to(structure, out.low + out.spacing * Vec3(i, j, k));
        *value = static_cast<float>(d < 0.0 ? std::max(-d, least) : std::min(-d, -least));
      }
    }
  }
  return out;
}

/// The surface where the samples change their sign.
Surface contour(const Samples& samples, const std::string& name) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(samples.size.data());
  image->SetOrigin(samples.low.data());
  image->SetSpacing(samples.spacing, samples.spacing, samples.spacing);
  vtkNew<vtkFloatArray> values;
  values->SetArray(const_cast<float*>(samples.values.data()), static_cast<vtkIdType>(samples.values.size()), 1);
  image->GetPointData()->SetScalars(values);
  vtkNew<vtkFlyingEdges3D> filter;
  filter->SetInputData(image);
  filter->ComputeNormalsOff();
  filter->ComputeGradientsOff();
  filter->ComputeScalarsOff();
  filter->SetValue(0, 0.0);
  filter->Update();
  vtkPolyData* made = filter->GetOutput();
  Surface surface{.name = name, .points = {}, .triangles = {}};
  surface.points.resize(static_cast<std::size_t>(made->GetNumberOfPoints()));
  for (std::size_t n = 0; n < surface.points.size(); ++n)
    made->GetPoint(static_cast<vtkIdType>(n), surface.points[n].data());
  vtkCellArray* cells = made->GetPolys();
  vtkIdType count = 0;
  const vtkIdType* corner = nullptr;
  for (cells->InitTraversal(); cells->GetNextCell(count, corner) != 0;)
    surface.triangles.push_back(
        {static_cast<Index>(corner[0]), static_cast<Index>(corner[1]), static_cast<Index>(corner[2])});
  return surface;
}

/// Number of the piece to which each point belongs, by its lowest point.
std::vector<Index> pieces_of(const Surface& surface) {
  std::vector<Index> piece(surface.points.size());
  std::iota(piece.begin(), piece.end(), 0);
  const auto root = [&](Index n) {
    while (piece[static_cast<std::size_t>(n)] != n) {
      Index& up = piece[static_cast<std::size_t>(n)];
      up = piece[static_cast<std::size_t>(up)];
      n = up;
    }
    return n;
  };
  for (const auto& t : surface.triangles) {
    for (int k = 1; k < 3; ++k) {
      const auto [low, high] = std::minmax({root(t[0]), root(t[static_cast<std::size_t>(k)])});
      piece[static_cast<std::size_t>(high)] = low;
    }
  }
  for (Index n = 0; n < static_cast<Index>(piece.size()); ++n) piece[static_cast<std::size_t>(n)] = root(n);
  return piece;
}

/// Leaves out small pieces, and turns the triangles so that their normals point outwards.
Surface without_crumbs(const Surface& surface) {
  const std::vector<Index> piece = pieces_of(surface);
  std::vector<double> volume(surface.points.size(), 0.0);
  const auto at = [&](Index n) -> const Vec3& { return surface.points[static_cast<std::size_t>(n)]; };
  double all = 0.0;
  for (const auto& t : surface.triangles) {
    const double part = at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0;
    volume[static_cast<std::size_t>(piece[static_cast<std::size_t>(t[0])])] += part;
    all += part;
  }
  Surface out{.name = surface.name, .points = {}, .triangles = {}};
  std::vector<Index> number(surface.points.size(), -1);
  for (auto t : surface.triangles) {
    if (std::abs(volume[static_cast<std::size_t>(piece[static_cast<std::size_t>(t[0])])]) < kSmallest_mm3) continue;
    for (Index& n : t) {
      Index& place = number[static_cast<std::size_t>(n)];
      if (place < 0) {
        place = static_cast<Index>(out.points.size());
        out.points.push_back(at(n));
      }
      n = place;
    }
    if (all < 0.0) std::swap(t[1], t[2]);
    out.triangles.push_back(t);
  }
  return out;
}

}  // namespace

std::vector<Surface> region_surfaces(const Anatomy& anatomy, std::span<const std::string> regions,
                                     const Progress& progress) {
  std::vector<Surface> surfaces(regions.size());
  for_each_in_parallel(
      regions.size(),
      [&](std::size_t r) {
        const auto structure = static_cast<int>(anatomy.find(regions[r]) - anatomy.structures.data());
        const Samples samples = sample(anatomy, structure);
        surfaces[r] = without_crumbs(contour(samples, regions[r]));
        simplify(surfaces[r], kLongest * samples.spacing);
      },
      progress, "surfaces");
  return surfaces;
}

}  // namespace stylet::meshing
