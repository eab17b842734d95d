// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary.hpp"
#include "handles.hpp"
#include "stylet/sim/display_field.hpp"
#include "stylet/sim/display_near_field.hpp"

#include <algorithm>
#include <array>

namespace stylet::rt {
namespace {

static_assert(sizeof(stylet_rt_triangle) == 20);

/// All points as surface points, each a node of the mesh.
std::vector<SurfacePoint> as_points(std::span<const Index> nodes) {
  std::vector<SurfacePoint> points(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) points[k] = {{nodes[k], -1, -1}, {1.0, 0.0, 0.0}};
  return points;
}

/// The patient's surface and all surfaces between regions. @param nodes the points, ascending
std::vector<stylet_rt_triangle> triangles_of(const Model& model, std::span<const Index> nodes) {
  const auto region = [&](Index tet) { return tet < 0 ? -1 : model.mesh().tet_region[static_cast<std::size_t>(tet)]; };
  std::vector<stylet_rt_triangle> triangles;
  for (const auto* faces : {&model.topology().boundary, &model.topology().interfaces}) {
    for (const Face& face : *faces) {
      stylet_rt_triangle& triangle = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        triangle.corner[k] = static_cast<int32_t>(std::ranges::lower_bound(nodes, face.nodes[k]) - nodes.begin());
      triangle.inside = region(face.tet);
      triangle.outside = region(face.neighbour);
    }
  }
  return triangles;
}

}  // namespace
}  // namespace stylet::rt

struct stylet_rt_display {
  stylet_rt_display(std::shared_ptr<const stylet::Model> model_, std::shared_ptr<const stylet::DisplayField> field_)
      : model(std::move(model_)),
        field(std::move(field_)),
        load(field->make_load()),
        near(model, stylet::rt::as_points(field->surface())),
        triangles(stylet::rt::triangles_of(*model, field->surface())),
        moved(Eigen::Matrix3Xf::Zero(3, static_cast<Eigen::Index>(field->surface().size()))) {}

  std::shared_ptr<const stylet::Model> model;
  std::shared_ptr<const stylet::DisplayField> field;
  stylet::DisplayField::Load load;
  stylet::DisplayNearField near;
  std::vector<stylet_rt_triangle> triangles;
  std::vector<stylet::TissueForce> forces;  ///< of the simulation that was taken last
  std::size_t force_count = 0;
  Eigen::Matrix3Xf moved;  ///< [mm] (3 × points)
};

using stylet::rt::ErrorText;
using stylet::rt::guarded;

extern "C" {

stylet_rt_status stylet_rt_display_create(const stylet_rt_model* model, stylet_rt_display** display, char* error,
                                          size_t error_size) noexcept {
  ErrorText text(error, error_size);
  if (display == nullptr) return text.bad_argument("stylet_rt_display_create: the argument display is null");
  *display = nullptr;
  if (model == nullptr) return text.bad_argument("stylet_rt_display_create: the model is null");
  return guarded(text, [&]() -> stylet_rt_status {
    auto field = stylet::DisplayField::prepare(model->model);
    if (!field) return text.of(field.error());
    auto made = std::make_unique<stylet_rt_display>(model->model, *field);
    // Room for the contacts of all needles, so that taking forces does not allocate.
    const auto contacts = static_cast<std::size_t>(model->model->coupling().capacity) + 1;
    made->forces.resize(2 * contacts * STYLET_RT_MAX_NEEDLES);
    *display = made.release();
    return STYLET_RT_OK;
  });
}

void stylet_rt_display_destroy(stylet_rt_display* display) noexcept { delete display; }

stylet_rt_status stylet_rt_display_read_triangles(const stylet_rt_display* display, stylet_rt_triangle* triangles,
                                                  size_t room, size_t* count, size_t* points) noexcept {
  if (display == nullptr || count == nullptr || (triangles == nullptr && room > 0)) return STYLET_RT_BAD_ARGUMENT;
  std::copy_n(display->triangles.begin(), std::min(room, display->triangles.size()), triangles);
  *count = display->triangles.size();
  if (points != nullptr) *points = display->field->surface().size();
  return STYLET_RT_OK;
}

stylet_rt_status stylet_rt_display_take(stylet_rt_display* display, const stylet_rt_sim* sim) noexcept {
  if (display == nullptr || sim == nullptr || sim->model != display->model) return STYLET_RT_BAD_ARGUMENT;
  return guarded([&]() -> stylet_rt_status {
    display->force_count = std::min(sim->simulation.insertion().tissue_forces(display->forces), display->forces.size());
    return STYLET_RT_OK;
  });
}

stylet_rt_status stylet_rt_display_read_points(stylet_rt_display* display, double* points_mm, size_t points,
                                               double* left_out_N) noexcept {
  if (display == nullptr || points_mm == nullptr) return STYLET_RT_BAD_ARGUMENT;
  const auto nodes = display->field->surface();
  if (points < nodes.size()) return STYLET_RT_BAD_ARGUMENT;
  return guarded([&]() -> stylet_rt_status {
    const auto forces = std::span<const stylet::TissueForce>(display->forces).first(display->force_count);
    display->field->set(forces, display->load);
    display->field->displacement(nodes, display->load, display->moved);
    display->near.set(forces);
    display->near.add(display->moved);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const stylet::Vec3 now = display->model->mesh().nodes[static_cast<std::size_t>(nodes[k])] +
                               display->moved.col(static_cast<Eigen::Index>(k)).cast<double>();
      std::copy_n(now.data(), 3, points_mm + 3 * k);
    }
    if (left_out_N != nullptr) *left_out_N = std::max(display->load.left_out_N(), display->near.left_out_N());
    return STYLET_RT_OK;
  });
}

}  // extern "C"
