// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_file_format.hpp"

#include "model/digest.hpp"
#include "stylet/io/recording_io.hpp"

#include <cstring>

namespace stylet::results {

std::string start_digest(const RunInfo& info, const TetMesh& mesh) {
  detail::Digest digest;
  const auto add = [&](std::span<const std::string> texts) {
    for (const std::string& text : texts) digest.add(text);
  };
  add(std::array{info.version, info.scenario_name, info.scenario_text, info.method});
  for (const ParameterRow& p : info.parameters) add(std::array{p.name, p.value, p.unit, p.source});
  add(info.supports);
  add(info.warnings);
  digest.add(std::span<const double>(std::array{info.needle_diameter_mm, info.needle_length_mm}));
  digest.add(std::span<const int>(info.target_regions));
  for (const Vec3* v : {&info.entry_mm, &info.direction}) digest.add(std::span<const double>(v->data(), 3));
  digest.add_bytes(mesh.nodes.data(), mesh.nodes.size() * sizeof(Vec3));
  digest.add_bytes(mesh.tets.data(), mesh.tets.size() * sizeof(mesh.tets[0]));
  digest.add(std::span<const int>(mesh.tet_region));
  add(mesh.regions);
  if (!mesh.surfaces.empty()) {  // earlier versions have none
    const FlatSurfaces flat = flatten(mesh.surfaces);
    digest.add_bytes(flat.points_mm.data(), flat.points_mm.size() * sizeof(float));
    digest.add(std::span<const Index>(flat.triangles));
    digest.add(std::span<const Index>(flat.sizes));
  }
  return digest.finish();
}

namespace {

void add_needles_and_seeds(detail::Digest& digest, const StoredPlan& plan) {
  const auto add_rows = [&](const auto& rows) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      rows.each_value(k, [&](std::span<const char> value, const record::Column& column) {
        digest.add_bytes(value.data(), column.is_text ? strnlen(value.data(), value.size()) : value.size());
      });
    }
  };
  add_rows(plan.needles);
  add_rows(plan.seeds);
}

void add_source(detail::Digest& digest, const RecordedPlan& head) {
  digest.add(std::span<const double>(std::array{head.seed_length_mm, head.seed_diameter_mm, head.prescription_Gy}));
  digest.add(head.source);
}

}  // namespace

StoredPlan stored_plan(const RecordedPlan& plan) {
  return {plan, record::rows_of(std::span(plan.needles)), record::rows_of(std::span(plan.seeds))};
}

std::string plan_digest(const StoredPlan& plan) {
  const RecordedPlan& head = plan.head;
  detail::Digest digest;
  add_needles_and_seeds(digest, plan);
  digest.add(std::span<const int>(&head.current, 1));
  add_source(digest, head);
  if (head.implant.empty()) return digest.finish();  // of a version without the name
  const ImplantTally& before = head.before;
  digest.add(head.implant);
  digest.add(std::span<const int>(
      std::array{before.skin_punctures, before.organ_entries, before.bone_contacts, before.exits}));
  return digest.finish();
}

}  // namespace stylet::results

namespace stylet {

std::string digest_of_plan(const RecordedPlan& plan) {
  detail::Digest digest;
  results::add_needles_and_seeds(digest, results::stored_plan(plan));
  results::add_source(digest, plan);
  return digest.finish();
}

}  // namespace stylet
