// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/model_format.hpp"

#include "model/digest.hpp"

#include <array>

namespace stylet::detail {
namespace {

void add(Digest& digest, const TetMesh& mesh) {
  digest.add_bytes(mesh.nodes.data(), mesh.nodes.size() * sizeof(Vec3));
  digest.add_bytes(mesh.tets.data(), mesh.tets.size() * sizeof(mesh.tets[0]));
  digest.add(std::span<const int>(mesh.tet_region));
  for (const std::string& region : mesh.regions) digest.add(region);
}

}  // namespace

std::string compliance_origin(const Tissue& tissue) {
  Digest digest;
  add(digest, tissue.mesh());
  for (const Material& material : tissue.materials())
    digest.add(std::span<const double>(std::array{material.young_MPa, material.poisson}));
  digest.add(std::span<const Index>(tissue.fixed_nodes()));
  digest.add(std::string(to_string(tissue.element())));
  digest.add(std::span<const Index>(tissue.corridor()));
  return digest.finish();
}

std::vector<double> motion_rows(const std::vector<MotionSample>& motion) {
  std::vector<double> rows;
  for (const MotionSample& sample : motion) {
    rows.push_back(sample.time_s);
    rows.insert(rows.end(), sample.base.origin.data(), sample.base.origin.data() + 3);
    rows.insert(rows.end(), sample.base.rotation.coeffs().data(), sample.base.rotation.coeffs().data() + 4);
  }
  return rows;
}

std::vector<MotionSample> motion_of(const std::vector<double>& rows) {
  std::vector<MotionSample> motion(rows.size() / kMotionNumbers);
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const double* row = rows.data() + k * kMotionNumbers;
    motion[k].time_s = row[0];
    motion[k].base.origin = Vec3(row + 1);
    motion[k].base.rotation.coeffs() = Vec4(row + 4);
  }
  return motion;
}

}  // namespace stylet::detail
