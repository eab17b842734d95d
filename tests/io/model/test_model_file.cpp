// SPDX-License-Identifier: GPL-3.0-or-later
// Tests that a saved model equals the original, or that reading it fails.
#include "box.hpp"
#include "io/formats/files.hpp"

#include "h5_new_file.hpp"
#include "model/model_format.hpp"
#include "model/sealed_file.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/sim/simulation.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>
#include <thread>

namespace stylet {
namespace {

using test::Folder;
using test::saved_box;

/// All numbers of a run except computing times, and the forces on the tissue at its end.
std::vector<double> run_of(const std::shared_ptr<const Model>& model, bool grow = true) {
  std::vector<double> numbers;
  Simulation simulation(model);
  for (const PlannedInsertion& plan : model->insertions()) {
    simulation.place(plan.motion.at(0.0), plan.entry, plan.direction);
    const double dt = 1e-3 * model->scenario().run.dt_ms;
    for (int k = 1; k * dt < plan.motion.duration_s(); ++k) {
      if (grow) simulation.prepare();
      const Step& r = simulation.step(plan.motion.at(k * dt), dt);
      for (const double x : {r.time_s, r.force_axial_N, r.force_lateral_N, r.force_sagittal_N}) numbers.push_back(x);
      for (int i = 0; i < 3; ++i) numbers.insert(numbers.end(), {r.tip_mm[i], r.torque_Nmm[i]});
      numbers.push_back(r.contacts + 1000.0 * r.sticking + 1e6 * r.iterations);
    }
  }
  return numbers;
}

std::shared_ptr<const Model> loaded(const std::filesystem::path& path, std::span<const std::string> settings = {}) {
  return test::value_of(load_model(path, {}, settings));
}

/// Some nodes without stored compliance.
std::vector<Index> beyond(const Model& model) {
  std::vector<Index> nodes;
  for (Index a = 0; a < model.mesh().node_count() && nodes.size() < 5; ++a) {
    if (!model.store()->has(a)) nodes.push_back(a);
  }
  return nodes;
}

void save(const Model& model, const std::filesystem::path& path, std::span<const std::string> notes = {}) {
  const auto saved = save_model(model, path, notes);
  if (!saved) throw std::runtime_error(saved.error().message());
}

/// The message of the error when a file is loaded.
std::string refusal(const std::filesystem::path& path, std::span<const std::string> settings = {}) {
  const auto model = load_model(path, {}, settings);
  if (model) return "not refused";
  EXPECT_EQ(model.error().kind, ErrorKind::input);
  EXPECT_NE(model.error().where.find(settings.empty() ? path.filename().string() : ""), std::string::npos);
  EXPECT_FALSE(model.error().cure.empty());
  return model.error().message();
}

class SavedModels : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Elements, SavedModels, testing::Values("p1", "nodal-pressure", "p2"), [](const auto& element) {
  std::string name = element.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST_P(SavedModels, step_as_the_compiled_one_to_the_last_bit_without_a_factor) {
  const Folder folder;
  Scenario scenario = saved_box();
  scenario.tissue_model.element = choice<ElementChoice>(GetParam()).value();
  TetMesh patient = test::box_patient();
  for (const std::string& region : patient.regions)
    patient.surfaces.push_back({region, {{0, 0, 0}, {1, 0, 0}, {0, 1.5, 0}, {0, 0, 2}}, {{0, 2, 1}, {0, 1, 3}}});
  const auto compiled = test::compiled(scenario, patient);
  save(*compiled, folder / "box.stylet");
  const auto model = loaded(folder / "box.stylet");
  ASSERT_EQ(model->mesh().surfaces.size(), patient.surfaces.size());
  for (std::size_t r = 0; r < patient.surfaces.size(); ++r) {
    EXPECT_EQ(model->mesh().surfaces[r].points, patient.surfaces[r].points);
    EXPECT_EQ(model->mesh().surfaces[r].triangles, patient.surfaces[r].triangles);
  }
  EXPECT_EQ(model->store()->blocks(), compiled->store()->blocks());
  EXPECT_EQ(model->scenario(), compiled->scenario());
  EXPECT_EQ(run_of(model), run_of(compiled));
  EXPECT_FALSE(model->tissue().has_factor());
  EXPECT_TRUE(compiled->tissue().has_factor());
}

class OtherLaw final : public CuttingModel {
  [[nodiscard]] std::string name() const override { return "other"; }
  [[nodiscard]] Law law(const Tip& tip) const override { return {tip.cutting_N, tip.viscosity_Ns_per_mm}; }
};

TEST(SavedModel, cannot_hold_a_part_of_the_program) {
  const Folder folder;
  const auto model = test::compiled(saved_box())->with({.cutting = std::make_shared<OtherLaw>()}).value();
  const auto saved = save_model(*model, folder / "own.stylet");
  ASSERT_FALSE(saved.ok());
  EXPECT_NE(saved.error().message().find("law of cutting"), std::string::npos) << saved.error().message();
  EXPECT_FALSE(std::filesystem::exists(folder / "own.stylet"));
}

TEST(SavedModel, makes_the_factor_for_what_is_not_in_it) {
  const Folder folder;
  Scenario scenario = saved_box();
  scenario.coupling.corridor_mm = 1.0;
  const auto compiled = test::compiled(scenario);
  save(*compiled, folder / "box.stylet");
  const auto model = loaded(folder / "box.stylet");
  const std::vector<Index> nodes = beyond(*model);
  ASSERT_FALSE(nodes.empty());
  const auto grown = [&](const Model& of) {
    ComplianceStore store(*of.store());
    store.add_nodes(nodes);
    return store.blocks();
  };
  EXPECT_EQ(grown(*model), grown(*compiled));
  EXPECT_TRUE(model->tissue().has_factor());
}

TEST(SavedModel, keeps_recorded_motions_several_needles_and_notes) {
  const Folder folder;
  Scenario scenario = saved_box();
  scenario.insertions.push_back(scenario.insertions.front());
  scenario.insertions[1].entry_mm = {-5.0, 4.0, -20.0};
  const auto straight = test::compiled(scenario);
  const auto motion = straight->insertions()[1].motion.samples();
  const auto compiled = test::compiled(scenario, test::box_patient(), {{}, motion});
  save(*compiled, folder / "box.stylet", std::vector<std::string>{"one thing", "another"});
  const auto model = loaded(folder / "box.stylet");
  ASSERT_EQ(model->insertions().size(), 2u);
  EXPECT_FALSE(model->insertions()[0].recorded);
  EXPECT_TRUE(model->insertions()[1].recorded);
  EXPECT_EQ(model->insertions()[1].motion.duration_s(), compiled->insertions()[1].motion.duration_s());
  EXPECT_EQ(run_of(model), run_of(compiled));
  EXPECT_FALSE(model->tissue().has_factor());
  const auto file = read_model_file(folder / "box.stylet");
  ASSERT_TRUE(file);
  EXPECT_EQ(file->notes, (std::vector<std::string>{"one thing", "another"}));
}

TEST(SavedModel, takes_settings_that_leave_its_compliance_as_it_is) {
  const Folder folder;
  const Scenario scenario = saved_box();
  save(*test::compiled(scenario), folder / "box.stylet");
  Scenario slower = scenario;
  slower.insertions[0].speed_mm_per_s = 25.0;
  const std::vector<std::string> speed{"insertion.speed_mm_per_s=25"};
  EXPECT_EQ(run_of(loaded(folder / "box.stylet", speed)), run_of(test::compiled(slower)));
  EXPECT_SAYS(refusal(folder / "box.stylet", std::vector<std::string>{"tissue.prostate.young_kPa=77"}),
              "these settings");
  EXPECT_SAYS(refusal(folder / "box.stylet", std::vector<std::string>{"coupling.corridor_mm=20"}), "corridor");
  EXPECT_SAYS(refusal(folder / "box.stylet", std::vector<std::string>{"mesh.nodes=700"}), "mesh.nodes");
  EXPECT_SAYS(refusal(folder / "box.stylet", std::vector<std::string>{"coupling.spacin_mm=3"}), "spacing_mm");
}

TEST(SavedModel, of_another_mesh_or_material_is_refused) {
  const Folder folder;
  save(*test::compiled(saved_box()), folder / "box.stylet");
  const auto file = read_model_file(folder / "box.stylet");
  ASSERT_TRUE(file);
  ModelFile moved = *file;
  moved.mesh.nodes[171].x() += 1e-9;
  ModelFile stiffer = *file;
  stiffer.scenario_text = test::replaced(stiffer.scenario_text, "[run]", "[tissue.prostate]\nyoung_kPa = 41.5\n[run]");
  for (const ModelFile& other : {moved, stiffer}) {
    const auto model = compile_model(other, "box.stylet");
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().kind, ErrorKind::input);
    EXPECT_SAYS(model.error().message(), "compliance does not belong");
    EXPECT_SAYS(model.error().message(), "stylet prepare");
  }
  ModelFile shorter = *file;
  shorter.compliance.kernel.pop_back();
  const auto model = compile_model(shorter, "box.stylet");
  ASSERT_FALSE(model);
  EXPECT_SAYS(model.error().message(), "near field");
}

/// Saves a small model, so that it can be read many times.
void save_small(const std::filesystem::path& path) {
  Scenario scenario = saved_box();
  scenario.coupling.corridor_mm = 1.0;
  save(*test::compiled(scenario), path);
}

TEST(SavedModel, with_any_bit_changed_is_refused) {
  const Folder folder;
  save_small(folder / "whole.stylet");
  const std::string whole = test::content_of(folder / "whole.stylet");
  std::mt19937 random(20051026);
  const char* wanted = std::getenv("STYLET_FLIPS");
  const int flips = wanted == nullptr ? 200 : std::atoi(wanted);
  for (int k = 0; k < flips; ++k) {
    std::string bytes = whole;
    // One in four changes is in the index and the seal, which are small.
    const std::size_t at = k % 4 == 0 ? whole.size() - 1 - random() % 2500 : random() % whole.size();
    bytes[at] ^= static_cast<char>(1 << (random() % 8));
    test::write_file(folder / "flipped.stylet", bytes);
    EXPECT_SAYS(refusal(folder / "flipped.stylet"), "stylet prepare");
  }
  for (const double share : {0.0, 0.01, 0.3, 0.9, 0.9999}) {
    test::write_file(folder / "cut.stylet",
                     whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    EXPECT_SAYS(refusal(folder / "cut.stylet"), "cut.stylet");
  }
}

TEST(SavedModel, made_to_deceive_is_refused_or_read_but_never_ends_the_program) {
  const Folder folder;
  save_small(folder / "whole.stylet");
  const std::string whole = test::content_of(folder / "whole.stylet");
  const detail::SealedFile sealed(folder / "whole.stylet", {});
  const std::string index = sealed.index();
  std::mt19937 random(20051026);
  const auto load = [&](const std::string& content, const std::string& with) {
    test::write_file(folder / "made.stylet", content);
    detail::SealedFile::seal(folder / "made.stylet", with);
    const auto model = read_model_file(folder / "made.stylet");
    if (!model) {
      EXPECT_FALSE(model.error().cure.empty());
      return false;
    }
    if (const auto compiled = compile_model(*model, folder / "made.stylet"); !compiled) {
      EXPECT_FALSE(compiled.error().message().empty());
      return false;
    }
    return true;
  };
  const std::string content = whole.substr(0, sealed.size());
  ASSERT_TRUE(load(content, index));
  for (int k = 0; k < 60; ++k) {
    std::string other = index;
    other[random() % other.size()] ^= static_cast<char>(1 << (random() % 7));
    (void)load(content, other);
  }
  for (const char* number : {"0", "7", "-1", "18446744073709551615", "9223372036854775807", "4294967296", "1e300"}) {
    for (std::size_t at = index.find("[", 0); at != std::string::npos; at = index.find("[", at + 1)) {
      const std::size_t digits = index.find_first_of("0123456789", at);
      const std::size_t end = index.find_first_not_of("0123456789", digits);
      (void)load(content, index.substr(0, digits) + number + index.substr(end));
    }
  }
  for (int k = 0; k < 60; ++k) {
    std::string other = content;
    for (int flip = 0; flip < 3; ++flip) other[random() % other.size()] ^= static_cast<char>(1 << (random() % 8));
    (void)load(other, index);
  }
}

/// Otherwise the steps of a forged model would diverge, or a picture in the middle of a run could not be written.
TEST(SavedModel, with_a_number_that_no_model_has_is_refused_in_each_array) {
  const Folder folder;
  save_small(folder / "whole.stylet");
  const std::string whole = test::content_of(folder / "whole.stylet");
  const detail::SealedFile sealed(folder / "whole.stylet", {});
  const auto index = nlohmann::json::parse(sealed.index());
  int arrays = 0;
  for (const auto& [name, array] : index.at("arrays").items()) {
    std::uint64_t items = 1;
    for (const auto& extent : array.at("shape")) items *= extent.get<std::uint64_t>();
    if (array.at("item_bytes") != sizeof(double) || items == 0) continue;
    ++arrays;
    for (const double number : {std::nan(""), 1e300, -HUGE_VAL}) {
      std::string content = whole.substr(0, sealed.size());
      std::memcpy(content.data() + array.at("at").get<std::uint64_t>() + items / 2 * sizeof number, &number,
                  sizeof number);
      test::write_file(folder / "made.stylet", content);
      detail::SealedFile::seal(folder / "made.stylet", sealed.index());
      EXPECT_SAYS(refusal(folder / "made.stylet"), "a number that no model has") << name;
    }
  }
  EXPECT_GT(arrays, 3);
}

TEST(SavedModel, has_the_same_bytes_each_time) {
  const Folder folder;
  save_small(folder / "one.stylet");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's time stamps have a resolution of 1 s
  save_small(folder / "two.stylet");
  EXPECT_EQ(test::content_of(folder / "one.stylet"), test::content_of(folder / "two.stylet"));
}

TEST(SavedModel, is_an_hdf5_file_for_others) {
  const Folder folder;
  save_small(folder / "box.stylet");
  const h5::LibraryTurn turn;
  const h5::Handle file(h5::check(H5Fopen((folder / "box.stylet").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "open"),
                        H5Fclose);
  EXPECT_EQ(h5::read_text_attribute(file, "format"), "stylet-model");
  const auto model = read_model_file(folder / "box.stylet");
  ASSERT_TRUE(model);
  EXPECT_EQ(h5::read_text(file, "scenario"), model->scenario_text);
  EXPECT_EQ(h5::extents(h5::dataset(file, "mesh/nodes_mm")), (std::vector<hsize_t>{model->mesh.nodes.size(), 3}));
}

TEST(SavedModel, other_files_and_versions_are_named) {
  const Folder folder;
  EXPECT_SAYS(refusal(folder / "none.stylet"), "no such file");
  test::write_file(folder / "text.stylet", "[patient]\n");
  EXPECT_SAYS(refusal(folder / "text.stylet"), "not a saved model");
  {
    const h5::NewFile other((folder / "other.stylet").c_str());
    h5::write_attribute(other, "format", std::string("stylet-run"));
  }
  EXPECT_SAYS(refusal(folder / "other.stylet"), "an earlier version of stylet saved it");
  EXPECT_FALSE(is_model_file(folder / "other.stylet"));
  EXPECT_TRUE(is_hdf5_file(folder / "other.stylet"));
  save(*test::compiled(saved_box()), folder / "box.stylet");
  EXPECT_TRUE(is_model_file(folder / "box.stylet"));
  const detail::SealedFile sealed(folder / "box.stylet", {});
  test::write_file(folder / "newer.stylet", test::content_of(folder / "box.stylet").substr(0, sealed.size()));
  const auto version = [](int number) { return "\"format_version\": " + std::to_string(number); };
  constexpr int kNewer = detail::kModelFileVersion + 1;
  detail::SealedFile::seal(folder / "newer.stylet",
                           test::replaced(sealed.index(), version(kNewer - 1), version(kNewer)));
  EXPECT_SAYS(refusal(folder / "newer.stylet"), "version " + std::to_string(kNewer) + " of the format");
}

TEST(SavedModel, a_damaged_one_is_known_by_its_name) {
  const Folder folder;
  save(*test::compiled(saved_box()), folder / "box.stylet");
  const std::string whole = test::content_of(folder / "box.stylet");
  for (const std::string& bytes : {whole.substr(0, whole.size() / 2), whole.substr(0, 64), whole.substr(0, 4),
                                   whole.substr(0, whole.size() - 1)}) {
    test::write_file(folder / "bad.stylet", bytes);
    test::write_file(folder / "bad.h5", bytes);
    EXPECT_SAYS(refusal(folder / "bad.stylet"), "stylet prepare");
    EXPECT_TRUE(is_meant_as_model(folder / "bad.stylet"));
    EXPECT_FALSE(is_meant_as_model(folder / "bad.h5"));
    EXPECT_FALSE(is_model_file(folder / "bad.stylet"));
  }
  test::write_file(folder / "model.h5", whole);
  EXPECT_TRUE(is_meant_as_model(folder / "model.h5"));
  EXPECT_FALSE(is_meant_as_model(folder / "none.stylet"));
}

TEST(SavedModel, is_not_written_where_it_would_not_be_whole) {
  const Folder folder;
  Scenario scenario = saved_box();
  scenario.coupling.engine = CouplingSettings::Engine::woodbury;
  const auto full = save_model(*test::compiled(scenario), folder / "full.stylet");
  ASSERT_FALSE(full);
  EXPECT_SAYS(full.error().message(), "woodbury");
  const auto nowhere = save_model(*test::compiled(saved_box()), folder / "none" / "box.stylet");
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 0);
}

}  // namespace
}  // namespace stylet
