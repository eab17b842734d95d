// SPDX-License-Identifier: GPL-3.0-or-later
#include "handles.hpp"

#include <algorithm>

namespace stylet::rt {

static_assert(sizeof(stylet_rt_model_info) == 64);
static_assert(sizeof(stylet_rt_insertion) == 64);

stylet_rt_model* make_handle(std::shared_ptr<const Model> model) { return new stylet_rt_model{std::move(model)}; }

namespace {

const PlannedInsertion* planned(const stylet_rt_model* model, int32_t index) noexcept {
  if (model == nullptr || index < 0) return nullptr;
  const std::vector<PlannedInsertion>& all = model->model->insertions();
  return static_cast<std::size_t>(index) < all.size() ? &all[static_cast<std::size_t>(index)] : nullptr;
}

}  // namespace
}  // namespace stylet::rt

using stylet::rt::planned;

extern "C" {

void stylet_rt_model_destroy(stylet_rt_model* model) noexcept { delete model; }

stylet_rt_status stylet_rt_model_read_info(const stylet_rt_model* model, stylet_rt_model_info* info) noexcept {
  if (model == nullptr || info == nullptr) return STYLET_RT_BAD_ARGUMENT;
  const stylet::Model& m = *model->model;
  *info = {};
  info->needle_length_mm = m.scenario().needle.length_mm;
  info->needle_diameter_mm = m.scenario().needle.diameter_mm;
  info->dt_s = 1e-3 * m.scenario().run.dt_ms;
  info->corridor_mm = m.corridor_mm();
  info->nodes = m.mesh().node_count();
  info->tets = m.mesh().tet_count();
  info->regions = static_cast<int32_t>(m.mesh().regions.size());
  info->insertions = static_cast<int32_t>(m.insertions().size());
  info->max_contacts = m.coupling().capacity + 1;
  return STYLET_RT_OK;
}

const char* stylet_rt_model_region(const stylet_rt_model* model, int32_t region) noexcept {
  if (model == nullptr || region < 0) return nullptr;
  const std::vector<std::string>& names = model->model->mesh().regions;
  return static_cast<std::size_t>(region) < names.size() ? names[static_cast<std::size_t>(region)].c_str() : nullptr;
}

stylet_rt_status stylet_rt_model_insertion(const stylet_rt_model* model, int32_t index,
                                           stylet_rt_insertion* insertion) noexcept {
  const stylet::PlannedInsertion* plan = planned(model, index);
  if (plan == nullptr || insertion == nullptr) return STYLET_RT_BAD_ARGUMENT;
  std::copy_n(plan->entry.data(), 3, insertion->entry_mm);
  std::copy_n(plan->direction.data(), 3, insertion->direction);
  insertion->depth_mm = plan->depth_mm;
  insertion->duration_s = plan->motion.duration_s();
  return STYLET_RT_OK;
}

const char* stylet_rt_model_insertion_name(const stylet_rt_model* model, int32_t index) noexcept {
  const stylet::PlannedInsertion* plan = planned(model, index);
  return plan == nullptr ? nullptr : plan->name.c_str();
}

}  // extern "C"
