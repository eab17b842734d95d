// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/report_html.hpp"

#include "fixed_number.hpp"
#include "report/gland_section.hpp"
#include "report/html_parts.hpp"
#include "report/map_section.hpp"
#include "report/narrative.hpp"
#include "report/page_template.hpp"
#include "report/parameter_tables.hpp"
#include "report/probe_section.hpp"
#include "report/report_data.hpp"
#include "report/text.hpp"

#include "stylet/io/event_words.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <vtkVersion.h>

#include <algorithm>
#include <cmath>

namespace stylet::results {
namespace {

std::string number_cell(const std::string& text) { return "<td class=\"number\">" + html_escaped(text) + "</td>"; }
std::string item(const std::string& text) { return "<li>" + html_escaped(text) + "</li>"; }

std::string tiles(const RunRecording& run, const Frame& deepest) {
  const Summary& s = *run.summary;
  std::string html = figure_tile(fmt::format("{:.1f} mm", deepest.base_depth_mm), "deepest insertion") +
                     figure_tile(fmt::format("{:.2f} N", s.peak_axial_N), "largest axial force");
  if (!run.info.target_regions.empty()) {
    html += figure_tile(fmt::format("{:.2f} mm", s.target_shift_centroid_mm.norm()), "shift of the target’s centre") +
            figure_tile(fmt::format("{:.1f} mm", s.target_shift_max_mm), "largest motion in the target");
  }
  html += figure_tile(fmt::format("{:.1f} mm", s.tip_deflection_mm), "tip beside its straight line") +
          figure_tile(fmt::format("{:.0f} µs", s.step_us_p99), "99 % of the steps within");
  return html;
}

std::string event_rows(const std::vector<Event>& events) {
  std::string html;
  EventWords words;
  for (const Event& e : events) {
    const std::string label = words.label(e);
    if (label.empty()) continue;  // the puncture at the same place has been said
    html += "<tr>" + text_cell(label) + number_cell(fixed(e.time_s, 3)) + number_cell(fixed(e.depth_mm, 2)) +
            number_cell(fixed(e.force_N, 3)) + "</tr>";
  }
  return html.empty() ? "<tr><td colspan=\"4\">Nothing happened: the needle met no tissue.</td></tr>" : html;
}

std::string model_facts(const RunRecording& run) {
  const auto pair = [](const std::string& name, const std::string& value) {
    return "<dt>" + html_escaped(name) + "</dt><dd>" + html_escaped(value) + "</dd>";
  };
  std::string regions;
  for (const std::string& name : run.mesh.regions) regions += (regions.empty() ? "" : ", ") + name;
  return pair("Coupling", run.info.method) +
         pair("Mesh", fmt::format("{} nodes, {} tetrahedra", run.mesh.nodes.size(), run.mesh.tets.size())) +
         pair("Regions", regions) +
         pair("Needle",
              fmt::format("{:g} mm diameter, {:g} mm long", run.info.needle_diameter_mm, run.info.needle_length_mm)) +
         pair("Entry point", fmt::format("({:.1f}, {:.1f}, {:.1f}) mm, LPS", run.info.entry_mm.x(),
                                         run.info.entry_mm.y(), run.info.entry_mm.z())) +
         pair("Direction", fmt::format("({:.3f}, {:.3f}, {:.3f})", run.info.direction.x(), run.info.direction.y(),
                                       run.info.direction.z())) +
         pair("Contacts, at most", fmt::format("{}", run.summary->contacts_max)) +
         pair("Balance of supports and contacts",
              fmt::format("{:.1e} of the peak force", run.summary->residual_force_balance)) +
         pair("Balance of their moments", fmt::format("{:.1e} relative", run.summary->residual_torque_balance));
}

std::string warning_box(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return {};
  std::string html = "<ul class=\"warnings\">";
  for (const std::string& w : warnings) html += item(w);
  return html + "</ul>";
}

std::string color_key(std::span<const RegionView> regions) {
  std::string html = "<ul class=\"region-key\">";
  for (const RegionView& view : regions) {
    const auto part = [&](std::size_t k) { return std::lround(255 * view.colour[k]); };
    html += fmt::format("<li><span class=\"swatch\" style=\"background:rgb({},{},{})\"></span>{}{}</li>", part(0),
                        part(1), part(2), html_escaped(view.label), view.target ? " (target)" : "");
  }
  return html + "</ul>";
}

std::string figure(const Pictures& pictures, const std::string& name, const std::string& caption) {
  const std::string& png = pictures.png.at(name);
  return "<figure><img alt=\"" + html_escaped(caption) + "\" src=\"data:image/png;base64," + base64_of<char>(png) +
         "\"><figcaption>" + html_escaped(caption) + "</figcaption></figure>";
}

std::string moment_name(const std::string& word, const Frame& frame) {
  return fmt::format("{} ({:.1f} s, depth {:.1f} mm)", word, frame.time_s, frame.base_depth_mm);
}

std::string picture_section(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                            const Pictures& pictures) {
  if (!pictures.wanted) return "<p class=\"note\">The scenario does not ask for still pictures.</p>";
  if (!pictures.why_not.empty()) {
    return "<p class=\"note\">The still pictures could not be drawn on this machine: " +
           html_escaped(pictures.why_not) + ". The interactive view above shows the same scene.</p>";
  }
  const std::array<std::pair<const char*, std::string>, 3> columns{
      {{"before", moment_name("Before", run.frames[moments.before])},
       {"deepest", moment_name("Deepest", run.frames[moments.deepest])},
       {"after", moment_name("After", run.frames[moments.after])}}};
  const bool has_target = !run.info.target_regions.empty();
  const std::array<std::pair<const char*, const char*>, 3> rows{
      {{"view", "anatomy from the left front"},
       {"sagittal", "sagittal section through the tip, seen from the left, needle projected"},
       {"transverse", has_target ? "transverse section through the target, seen from the feet"
                                 : "transverse section through the tip, seen from the feet"}}};
  std::string html = color_key(regions) + "<div class=\"stills\">";
  for (const auto& [file, what] : rows) {
    for (const auto& [moment, when] : columns) {
      html += figure(pictures, fmt::format("{}_{}.png", file, moment), fmt::format("{}: {}", when, what));
    }
  }
  return html +
         "</div><p>Thin grey outlines in the sections show where the organs lay before the insertion.</p>"
         "<h3>How far the tissue has moved, needle at its deepest</h3><div class=\"stills two\">" +
         figure(pictures, "sagittal_displacement.png", "Sagittal section: magnitude of displacement [mm]") +
         figure(pictures, "transverse_displacement.png", "Transverse section: magnitude of displacement [mm]") +
         "</div>";
}

std::string versions(const RunRecording& run) {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return html_escaped(fmt::format("Stylet {} · HDF5 {}.{}.{} · VTK {}", run.info.version, major, minor, release,
                                  vtkVersion::GetVTKVersion()));
}

}  // namespace

Result<std::string> report_html(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                                const Pictures& pictures, const HoleMap* map, const ProbeReport* probe) {
  std::string story, supports;
  for (const std::string& paragraph : tell_what_happened(run, moments)) story += "<p>" + html_prose(paragraph) + "</p>";
  for (const std::string& support : run.info.supports) supports += item(support);
  std::vector<std::string> warnings = run.info.warnings;
  for (const std::string& w : run.summary->warnings) {
    if (std::find(warnings.begin(), warnings.end(), w) == warnings.end()) warnings.push_back(w);
  }
  const Slots slots{
      {"title", html_escaped(run.info.scenario_name) + " – needle insertion report"},
      {"heading", html_escaped(run.info.scenario_name)},
      {"kicker", "Needle insertion report"},
      {"facts",
       html_escaped(fmt::format("{}, {} nodes, {} steps", run.info.method, run.mesh.nodes.size(), run.summary->steps))},
      {"story", story},
      {"tiles", tiles(run, run.frames[moments.deepest])},
      {"warnings", warning_box(warnings)},
      {"probe", probe ? probe_section(*probe) : ""},
      {"gland", gland_section(run)},
      {"map", map ? map_section(*map) : ""},
      {"pictures", picture_section(run, regions, moments, pictures)},
      {"events", event_rows(run.summary->events)},
      {"step_times", html_prose(tell_step_times(*run.summary))},
      {"model", model_facts(run)},
      {"supports", supports},
      {"parameters", parameter_tables(run.info.parameters)},
      {"scenario", html_escaped(run.info.scenario_text)},
      {"versions", versions(run)},
      {"data_id", "report-data"},
      {"data", json_script_safe(report_data(run, regions, moments, map))},
  };
  return whole_page(report_assets(), slots, "report.html");
}

}  // namespace stylet::results
