// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/make_needle.hpp"

#include "stylet/core/nearest_name.hpp"
#include "stylet/needle/beam.hpp"
#include "stylet/needle/springs.hpp"
#include "stylet/needle/tet.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace stylet {

namespace {

using Build = Result<std::unique_ptr<Needle>> (*)(const NeedleSection&, int, int);

template <class Model>
Result<std::unique_ptr<Needle>> build(const NeedleSection& section, int elements, int load_capacity) {
  auto built = Model::build(section, elements, load_capacity);
  if (!built) return built.error();
  return std::unique_ptr<Needle>(std::move(*built));
}

/// The models, in the order of needle_models().
struct Known {
  int elements;  ///< default number; docs/theory/needle.md has the errors
  Build build;
};
constexpr std::array kKnown{Known{24, build<BeamNeedle>}, Known{24, build<SpringsNeedle>}, Known{60, build<TetNeedle>}};

}  // namespace

std::span<const std::string> needle_models() {
  static const std::array<std::string, kKnown.size()> names{"beam", "springs", "tet"};
  return names;
}

Result<int> default_needle_elements(const std::string& model) {
  const auto names = needle_models();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == model) return kKnown[i].elements;
  }
  const std::string near = nearest_name(model, names);
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return input_error("needle, model", "'" + model + "', expected one of " + all,
                     near.empty() ? "Name one of these" : "Did you mean '" + near + "'?");
}

Result<std::unique_ptr<Needle>> make_needle(const std::string& model, const NeedleSection& section, int elements,
                                            int load_capacity) {
  const auto standard = default_needle_elements(model);
  if (!standard) return standard.error();
  const auto names = needle_models();
  const auto i = static_cast<std::size_t>(std::find(names.begin(), names.end(), model) - names.begin());
  return kKnown[i].build(section, elements == 0 ? *standard : elements, load_capacity);
}

}  // namespace stylet
