// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/structure_mask.hpp"

#include <vtkCellArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace stylet::results {
namespace {

constexpr double kFinest_mm = 0.5;

/// Edge [mm] of the cubes, so that the box around the structure has at most so many.
double edge_of(const StructureDose& structure, double most_cubes) {
  Eigen::AlignedBox3d box;
  for (const Contour& contour : structure.contours) {
    for (const Vec3& x : contour.points) box.extend(x);
  }
  return std::max(kFinest_mm, std::cbrt(std::max(box.volume(), 0.0) / most_cubes));
}

}  // namespace

std::optional<StructureMask> structure_mask(const StructureDose& structure, double most_cubes) {
  if (structure.contours.empty()) return std::nullopt;
  StructureMask mask;
  mask.spacing_mm = edge_of(structure, most_cubes);
  const Roi roi{
      .name = structure.name, .number = 0, .type = {}, .colour = structure.colour, .contours = structure.contours};
  const auto samples = sample_structure(roi, 0.5 * mask.spacing_mm);
  if (!samples || samples->points.empty()) return std::nullopt;

  Eigen::AlignedBox3d box;
  for (const Vec3& x : samples->points) box.extend(x);
  // Cubes begin at multiples of their edge, as the squares of the samples do, so that full cubes get equal samples.
  const Vec3 first = (box.min() / mask.spacing_mm).array().floor() - 1.0;
  const Vec3 last = (box.max() / mask.spacing_mm).array().floor() + 1.0;
  for (int k = 0; k < 3; ++k) mask.size[static_cast<std::size_t>(k)] = static_cast<int>(last[k] - first[k]) + 1;
  mask.origin_mm = (first + Vec3::Constant(0.5)) * mask.spacing_mm;

  const auto [nx, ny, nz] = mask.size;
  std::vector<float> filled(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
  for (std::size_t k = 0; k < samples->points.size(); ++k) {
    const Vec3 at = (samples->points[k] / mask.spacing_mm).array().floor() - first.array();
    const auto place =
        (static_cast<std::size_t>(at.z()) * static_cast<std::size_t>(ny) + static_cast<std::size_t>(at.y())) *
            static_cast<std::size_t>(nx) +
        static_cast<std::size_t>(at.x());
    filled[place] += static_cast<float>(samples->volume_mm3[k]);
  }
  const double cube = std::pow(mask.spacing_mm, 3);
  for (const float volume : filled)
    mask.share.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::min(1.0, volume / cube))));
  return mask;
}

StructureSurface mask_surface(const StructureMask& mask, double most_triangles) {
  constexpr double kHalf = 127.5;
  vtkNew<vtkImageData> image;
  image->SetDimensions(mask.size[0], mask.size[1], mask.size[2]);
  image->SetOrigin(mask.origin_mm.data());
  image->SetSpacing(mask.spacing_mm, mask.spacing_mm, mask.spacing_mm);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  std::memcpy(image->GetScalarPointer(), mask.share.data(), mask.share.size());
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(image);
  edges->SetValue(0, kHalf);
  edges->ComputeNormalsOff();
  edges->ComputeScalarsOff();
  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->SetInputConnection(edges->GetOutputPort());
  smooth->SetNumberOfIterations(20);
  smooth->SetPassBand(0.02);
  smooth->NormalizeCoordinatesOn();
  smooth->Update();
  vtkPolyData* surface = smooth->GetOutput();
  vtkNew<vtkQuadricDecimation> thinned;
  if (static_cast<double>(surface->GetNumberOfCells()) > most_triangles) {
    thinned->SetInputData(surface);
    thinned->SetTargetReduction(1.0 - most_triangles / static_cast<double>(surface->GetNumberOfCells()));
    thinned->VolumePreservationOn();
    thinned->Update();
    surface = thinned->GetOutput();
  }
  StructureSurface result;
  for (vtkIdType p = 0; p < surface->GetNumberOfPoints(); ++p) {
    for (const double x : Eigen::Map<const Vec3>(surface->GetPoint(p)))
      result.points_mm.push_back(static_cast<float>(x));
  }
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c) {
    surface->GetCellPoints(c, corners);
    if (corners->GetNumberOfIds() != 3) continue;
    for (vtkIdType k = 0; k < 3; ++k) result.triangles.push_back(static_cast<std::uint32_t>(corners->GetId(k)));
  }
  return result;
}

}  // namespace stylet::results
