// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_maker.hpp"

#include "core/clock.hpp"
#include "scene_points.hpp"
#include "stylet/core/json_text.hpp"
#include "stylet/imaging/fluoroscope.hpp"
#include "stylet/imaging/pressing_probe.hpp"
#include "stylet/imaging/scan_conversion.hpp"
#include "stylet/imaging/ultrasound_scanner.hpp"
#include "stylet/sim/display_near_field.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

namespace stylet::serve {

namespace {

using ImageJson = nlohmann::json;

constexpr double kImageRange_dB = 100.0;  // of the values that are sent; the page chooses its own range of them

ImageJson json_of(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// Displacement by the loop's forces of all nodes of the mesh and, between the nodes, beside the needle.
class LoopMotion {
 public:
  explicit LoopMotion(const std::shared_ptr<const DisplayField>& field)
      : field_(field),
        load_(field->make_load()),
        near_(std::shared_ptr<const Model>(field, &field->model()), nodes_as_points(field->model().mesh())),
        nodes_(static_cast<std::size_t>(field->model().mesh().node_count())) {
    std::iota(nodes_.begin(), nodes_.end(), Index{0});
    const Scenario& scenario = field->model().scenario();
    for (const std::string& region : field->model().mesh().regions) tissue_.push_back(tissue_of(scenario, region));
  }

  void compute(std::span<const TissueForce> forces, Moment& moment) {
    field_->set(forces, load_);
    field_->displacement(nodes_, load_, moment.displacement);
    near_.set(forces);
    near_.add(moment.displacement);
    moment.forces.clear();
    for (const TissueForce& force : forces) moment.forces.push_back(shown(force));
  }

 private:
  [[nodiscard]] ShownForce shown(const TissueForce& force) const {
    const TetMesh& mesh = field_->model().mesh();
    const Scenario& scenario = field_->model().scenario();
    const auto tet = static_cast<std::size_t>(force.at.tet);
    const TissueParameters& tissue = tissue_[static_cast<std::size_t>(mesh.tet_region[tet])];
    ShownForce out;
    out.at_mm.setZero();
    for (std::size_t k = 0; k < 4; ++k)
      out.at_mm +=
          force.at.weights[static_cast<Eigen::Index>(k)] * mesh.nodes[static_cast<std::size_t>(mesh.tets[tet][k])];
    out.force_N = force.force;
    const bool is_tip = force.along.isZero();
    if (!is_tip) out.along = force.along;
    out.length_mm = is_tip ? 0.0 : scenario.coupling.spacing_mm;
    out.epsilon_mm = std::sqrt(std::numbers::e) * 0.5 * scenario.needle.diameter_mm;
    out.shear_MPa = 1e-3 * tissue.young_kPa / (2.0 * (1.0 + tissue.poisson));
    out.poisson = tissue.poisson;
    return out;
  }

  std::shared_ptr<const DisplayField> field_;
  DisplayField::Load load_;
  DisplayNearField near_;
  std::vector<Index> nodes_;
  std::vector<TissueParameters> tissue_;  ///< by region
};

/// Why a recorded patient is shown without the probe's motion.
std::string no_press(const Error& error) { return "The probe does not press: " + error.what + ". " + error.cure + "."; }

bool is_same_patient(const ImageSubject& a, const ImageSubject& b) {
  return a.mesh && b.mesh && a.gland == b.gland && a.mesh->nodes == b.mesh->nodes &&
         a.mesh->tet_region == b.mesh->tet_region && a.scenario.tissue == b.scenario.tissue &&
         a.scenario.probe == b.scenario.probe;
}

}  // namespace

struct ImageMaker::Parts {
  ImageSubject patient;
  ShownImage shown = ShownImage::none;
  Scenario tables;
  Moment moment;
  std::optional<LoopMotion> motion;
  std::optional<UltrasoundScanner> scanner;
  std::unique_ptr<Fluoroscope> fluoroscope;
  bool in_patient = false;
  ScanConversion conversion;
  std::vector<std::uint8_t> grey;  ///< of the last ultrasound picture, in the grey values of the scenario
  std::optional<ProbeSeat> seat;
  std::optional<PressingProbe> pressing;  ///< of a scenario with a probe, of a live patient while the model is there
  std::string remark;                     ///< why the probe of a replay does not press

  [[nodiscard]] bool may_press() const {
    return patient.scenario.probe.kind != ProbeKind::none && (patient.field || patient.is_recorded);
  }
  [[nodiscard]] ImageJson probe_json(const ProbePlace& place, const std::optional<double>& force_N) const;
  Result<> find_seat();
  std::shared_ptr<const GreyPicture> converted(const PolarPicture& picture);
  Result<> prepare_probe(const std::function<void(const std::string&)>& tell);
  Result<> prepare_scanner(const std::function<void(const std::string&)>& tell);
  Result<std::shared_ptr<const LiveImage>> ultrasound();
  Result<std::shared_ptr<const LiveImage>> xray();
};

ImageMaker::ImageMaker() : parts_(std::make_unique<Parts>()) {}
ImageMaker::~ImageMaker() = default;

const std::string& ImageMaker::remark() const { return parts_->remark; }

void ImageMaker::open(ImageSubject patient) {
  Parts& p = *parts_;
  p.scanner.reset();  // scanner and fluoroscope belong to one mesh object
  p.fluoroscope.reset();
  p.motion.reset();
  if (!is_same_patient(p.patient, patient)) {
    p.seat.reset();
    p.pressing.reset();
    p.remark.clear();
  }
  p.patient = std::move(patient);
  p.moment = moment_at_rest(*p.patient.mesh);
  if (p.patient.field) p.motion.emplace(p.patient.field);
}

void ImageMaker::set(ShownImage shown, const Scenario& tables, bool in_patient) {
  Parts& p = *parts_;
  p.shown = shown;
  p.in_patient = in_patient;
  if (!(tables.fluoroscopy == p.tables.fluoroscopy)) p.fluoroscope.reset();
  p.tables.probe = tables.probe;
  p.tables.ultrasound = tables.ultrasound;
  p.tables.fluoroscopy = tables.fluoroscopy;
}

void ImageMaker::take(double time_s, std::span<const TissueForce> forces, std::span<const std::vector<Vec3>> needles_mm,
                      const std::vector<ShownSeed>& seeds) {
  Parts& p = *parts_;
  if (!p.patient.mesh) return;
  p.moment.time_s = time_s;
  if (p.motion) p.motion->compute(forces, p.moment);
  const Scenario& scenario = p.patient.scenario;
  p.moment.needles.assign(needles_mm.size(),
                          shown_needle(scenario.needle.diameter_mm, scenario.needle.lumen_diameter_mm));
  for (std::size_t k = 0; k < needles_mm.size(); ++k) p.moment.needles[k].centreline_mm = needles_mm[k];
  p.moment.seeds = seeds;
}

void ImageMaker::take(Moment moment) { parts_->moment = std::move(moment); }

ImageJson ImageMaker::Parts::probe_json(const ProbePlace& place, const std::optional<double>& force_N) const {
  const ProbeSettings& probe = tables.probe;
  const Capsule surface = capsule_of(place);
  return {{"depth_mm", probe.depth_mm.value_or(seat->gland_mm)},
          {"lift_mm", probe.lift_mm},
          {"tilt_deg", probe.tilt_deg},
          {"roll_deg", probe.roll_deg},
          {"balloon_mm", probe.balloon_mm},
          {"step_mm", probe.step_mm},
          {"diameter_mm", probe.diameter_mm},
          {"tip_mm", json_of(surface.centre_mm + surface.radius_mm * surface.axis)},
          {"axis", json_of(surface.axis)},
          {"force_N", force_N ? ImageJson(*force_N) : ImageJson(nullptr)}};
}

Result<> ImageMaker::Parts::find_seat() {
  if (seat) return Ok{};
  auto found = probe_seat(*patient.mesh, patient.gland, patient.scenario.name);
  if (!found) return found.error();
  seat = *found;
  return Ok{};
}

Result<ProbeSeat> ImageMaker::seat() {
  if (!parts_->patient.mesh) return failure("the probe", "no case is open yet", "Wait until the case is open");
  if (auto found = parts_->find_seat(); !found) return found.error();
  return *parts_->seat;
}

/// Scan conversion of a picture of the range kImageRange_dB, with the gains and the dynamic range of the scenario.
std::shared_ptr<const GreyPicture> ImageMaker::Parts::converted(const PolarPicture& picture) {
  const UltrasoundSettings& settings = tables.ultrasound;
  const auto samples = static_cast<std::size_t>(picture.beams.samples);
  const auto scale = static_cast<float>(kImageRange_dB / settings.dynamic_range_dB);
  grey.resize(picture.grey.size());
  for (std::size_t s = 0; s < samples; ++s) {
    const double gain_dB = hand_gain_dB(settings, static_cast<double>(s) / static_cast<double>(samples - 1));
    const auto offset =
        static_cast<float>(255.0 * (1.0 + (gain_dB - kImageRange_dB) / settings.dynamic_range_dB) + 0.5);  // rounds
    for (std::size_t k = s; k < grey.size(); k += samples)
      grey[k] =
          static_cast<std::uint8_t>(std::clamp(scale * static_cast<float>(picture.grey[k]) + offset, 0.0F, 255.0F));
  }
  auto made = std::make_shared<GreyPicture>(conversion.convert({picture.beams, grey}));
  made->time_s = moment.time_s;
  return made;
}

/// Finds the place of the probe, and solves for the wall that it presses.
Result<> ImageMaker::Parts::prepare_probe(const std::function<void(const std::string&)>& tell) {
  if (auto found = find_seat(); !found) return found;
  if (pressing || !may_press() || !remark.empty()) return Ok{};
  tell("The rectal wall under the probe is being prepared");
  if (patient.is_recorded) {
    auto made = PressingProbe::prepare(patient.scenario, *patient.mesh, patient.scenario.name);
    if (made) pressing.emplace(std::move(*made));
    if (!made) remark = no_press(made.error());
    return Ok{};
  }
  std::shared_ptr<const Model> model(patient.field, &patient.field->model());
  auto made = PressingProbe::prepare(std::move(model), patient.scenario.name);
  if (!made) return made.error();
  pressing.emplace(std::move(*made));
  return Ok{};
}

Result<> ImageMaker::Parts::prepare_scanner(const std::function<void(const std::string&)>& tell) {
  UltrasoundSettings settings = tables.ultrasound;
  settings.gain_dB = 0.0;
  settings.tgc_dB = {};
  settings.dynamic_range_dB = kImageRange_dB;
  if (scanner) {
    if (scanner->settings() == settings) return Ok{};
    auto tuned = scanner->tuned(settings);
    if (!tuned) return tuned.error();
    *scanner = std::move(*tuned);
    return Ok{};
  }
  tell("The scanner is being prepared");
  std::vector<TissueEcho> echoes;
  for (const std::string& region : patient.mesh->regions) echoes.push_back(tissue_of(patient.scenario, region).echo);
  auto made = UltrasoundScanner::create(*patient.mesh, echoes, settings);
  if (!made) return made.error();
  scanner.emplace(std::move(*made));
  return Ok{};
}

Result<std::shared_ptr<const LiveImage>> ImageMaker::Parts::ultrasound() {
  const std::int64_t before = thread_cpu_ns();
  const ProbeKind kind = tables.probe.kind == ProbeKind::none ? ProbeKind::biplane : tables.probe.kind;
  const ProbePlace place = probe_place(tables.probe, *seat);
  Moment shown_moment = moment;
  std::optional<double> force_N;
  if (pressing) force_N = pressing->press(tables.probe, shown_moment).force_N.norm();
  const auto array = shown == ShownImage::sagittal ? UltrasoundArray::sagittal : UltrasoundArray::transverse;
  const PolarPicture picture = scanner->scan(shown_moment, kind, place, array);
  const UltrasoundBeams& beams = picture.beams;
  const double width = beams.step * (beams.lines - 1);
  auto image = std::make_shared<LiveImage>();
  image->rows = static_cast<std::uint32_t>(beams.lines);
  image->columns = static_cast<std::uint32_t>(beams.samples);
  image->pixels.assign(picture.grey.begin(), picture.grey.end());
  image->probe = pose_of(place);
  if (in_patient) image->in_patient = converted(picture);
  image->text = json_text(ImageJson{{"modality", "ultrasound"},
                                    {"time_s", moment.time_s},
                                    {"array", to_string(shown)},
                                    {"radius_mm", beams.surface_mm},
                                    {"depth_mm", beams.sample_mm * (beams.samples - 1)},
                                    {"focus_mm", tables.ultrasound.focus_mm},
                                    {"sector_deg", beams.sector ? width * 180.0 / std::numbers::pi : 0.0},
                                    {"first_mm", beams.sector ? 0.0 : beams.first},
                                    {"length_mm", beams.sector ? 0.0 : width},
                                    {"range_dB", kImageRange_dB},
                                    {"origin_mm", json_of(beams.origin_mm)},
                                    {"right", json_of(beams.across)},
                                    {"up", json_of(beams.ahead)},
                                    {"probe", probe_json(place, force_N)},
                                    {"took_ms", 1e-6 * static_cast<double>(thread_cpu_ns() - before)}});
  return std::shared_ptr<const LiveImage>(std::move(image));
}

Result<std::shared_ptr<const LiveImage>> ImageMaker::Parts::xray() {
  const std::int64_t before = thread_cpu_ns();
  if (!fluoroscope) {
    auto made = Fluoroscope::create(*patient.mesh, tables.fluoroscopy);
    if (!made) return made.error();
    fluoroscope = std::move(*made);
  }
  Moment shown_moment = moment;
  ImageJson probe = nullptr;
  auto image = std::make_shared<LiveImage>();
  if (pressing) {
    const ProbePlace place = probe_place(tables.probe, *seat);
    probe = probe_json(place, pressing->press(tables.probe, shown_moment).force_N.norm());
    image->probe = pose_of(place);
  }
  const GreyPicture& picture = fluoroscope->expose(shown_moment);
  if (in_patient) image->in_patient = std::make_shared<GreyPicture>(picture);
  image->rows = static_cast<std::uint32_t>(picture.rows);
  image->columns = static_cast<std::uint32_t>(picture.columns);
  image->pixels = picture.pixels;
  image->text = json_text(ImageJson{{"modality", "xray"},
                                    {"time_s", moment.time_s},
                                    {"angle_deg", tables.fluoroscopy.angle_deg},
                                    {"cranial_deg", tables.fluoroscopy.cranial_deg},
                                    {"energy_keV", tables.fluoroscopy.energy_keV},
                                    {"mm_per_pixel", picture.mm_per_pixel},
                                    {"probe", std::move(probe)},
                                    {"took_ms", 1e-6 * static_cast<double>(thread_cpu_ns() - before)}});
  return std::shared_ptr<const LiveImage>(std::move(image));
}

Result<std::shared_ptr<const LiveImage>> ImageMaker::make(const std::function<void(const std::string&)>& tell) {
  if (!parts_->patient.mesh) return std::shared_ptr<const LiveImage>();
  const bool is_xray = parts_->shown == ShownImage::xray;
  if (!is_xray || parts_->may_press()) {
    const Result<> prepared = parts_->prepare_probe(tell);
    if (!prepared && !(is_xray && parts_->patient.is_recorded)) return prepared.error();
    if (!prepared) parts_->remark = no_press(prepared.error());
  }
  if (is_xray) return parts_->xray();
  if (auto prepared = parts_->prepare_scanner(tell); !prepared) return prepared.error();
  return parts_->ultrasound();
}

}  // namespace stylet::serve
