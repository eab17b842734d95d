// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/pictures.hpp"

#include "detail/child.hpp"
#include "pictures/canvas.hpp"
#include "pictures/shapes.hpp"
#include "pictures/views.hpp"
#include "stylet/core/survive.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstring>
#include <functional>
#include <vector>

namespace stylet::results {
namespace {

constexpr std::array kNames{"view_before.png",
                            "sagittal_before.png",
                            "transverse_before.png",
                            "view_deepest.png",
                            "sagittal_deepest.png",
                            "transverse_deepest.png",
                            "view_after.png",
                            "sagittal_after.png",
                            "transverse_after.png",
                            "sagittal_displacement.png",
                            "transverse_displacement.png"};

constexpr detail::ChildLimits kLimits{.cpu_s = 300, .wall_s = 180, .memory_bytes = std::size_t{8} << 30};

using Drawing = std::function<Layers()>;

/// The functions that draw the pictures, in the order of kNames.
std::vector<Drawing> drawings(const PictureInput& input, const Moments& moments) {
  const Section sagittal = sagittal_section(input), transverse = transverse_section(input);
  std::vector<Drawing> list;
  for (const std::size_t moment : {moments.before, moments.deepest, moments.after}) {
    const Frame& frame = input.run.frames[moment];
    list.emplace_back([&] { return view_3d(input, frame); });
    list.emplace_back([&, sagittal] { return view_section(input, frame, sagittal); });
    list.emplace_back([&, transverse] { return view_section(input, frame, transverse); });
  }
  list.emplace_back([&, sagittal] { return view_displacement(input, input.deepest, sagittal); });
  list.emplace_back([&, transverse] { return view_displacement(input, input.deepest, transverse); });
  return list;
}

// A child sends "ok", then "<size>:<bytes>" for each picture; or the reason why it could not draw.
constexpr std::string_view kOk = "ok";

std::string draw_some(std::span<const Drawing> list) {
  try {
    auto canvas = Canvas::open();
    if (!canvas) return canvas.error().message();
    std::string parcel(kOk);
    for (const Drawing& drawing : list) {
      const auto png = (*canvas)->draw(drawing());
      if (!png) return png.error().message();
      parcel += fmt::format("{}:", png->size()) + *png;
    }
    return parcel;
  } catch (const std::exception&) {
    return caught_exception("drawing").what;
  }
}

/// Takes the next picture from the received bytes; false if it is incomplete.
bool take_picture(std::string_view& parcel, std::string& png) {
  std::size_t size = 0;
  const auto number = std::from_chars(parcel.data(), parcel.data() + parcel.size(), size);
  const auto digits = static_cast<std::size_t>(number.ptr - parcel.data());
  if (number.ec != std::errc{} || digits >= parcel.size() || parcel[digits] != ':' ||
      parcel.size() - digits - 1 < size) {
    return false;
  }
  png = parcel.substr(digits + 1, size);
  parcel.remove_prefix(digits + 1 + size);
  return true;
}

std::string reason_of(const detail::ChildOutcome& outcome) {
  switch (outcome.end) {
    case detail::ChildEnd::finished:
      return outcome.result;
    case detail::ChildEnd::signalled:
      return fmt::format("the OpenGL driver crashed (signal {})", outcome.code);
    case detail::ChildEnd::exited:
      return "the OpenGL driver ended its process";
    case detail::ChildEnd::timed_out:
    case detail::ChildEnd::overdue:
      return "drawing took too long";
    case detail::ChildEnd::not_started:
      return std::string("no process could be started for drawing: ") + std::strerror(outcome.code);
  }
  return {};
}

}  // namespace

std::span<const char* const> picture_names() { return kNames; }

Pictures draw_pictures(const RunRecording& run, std::span<const RegionView> regions, const Moments& moments,
                       const Progress& progress) {
  const std::vector<TiedSurface> surfaces = shown_surfaces(run.mesh, regions);
  const PictureInput input{run, regions, surfaces, run.frames[moments.deepest]};
  const std::vector<Drawing> list = drawings(input, moments);
  // The pictures of one moment: few OpenGL contexts to set up, and still visible progress.
  constexpr std::size_t kPerChild = 3;
  Pictures pictures;
  for (std::size_t first = 0; first < list.size(); first += kPerChild) {
    report(progress, "pictures", static_cast<double>(first) / static_cast<double>(list.size()));
    const auto batch = std::span(list).subspan(first, std::min(kPerChild, list.size() - first));
    const auto outcome = detail::run_in_child([&] { return draw_some(batch); }, kLimits);
    std::string_view parcel = outcome.result;
    if (outcome.end != detail::ChildEnd::finished || !parcel.starts_with(kOk)) return {{}, reason_of(outcome)};
    parcel.remove_prefix(kOk.size());
    for (std::size_t k = 0; k < batch.size(); ++k) {
      if (!take_picture(parcel, pictures.png[kNames[first + k]])) return {{}, "a picture was not received completely"};
    }
  }
  report(progress, "pictures", 1.0);
  return pictures;
}

}  // namespace stylet::results
