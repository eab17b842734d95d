// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/source_choice.hpp"

#include "stylet/dose/fitting_sources.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/io/dose_io.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace stylet {

namespace {

Result<SourceModel> model_of(const std::string& name) {
  const std::filesystem::path file = name;
  if (file.extension() == ".json" || file.has_parent_path()) return read_source_model(file);
  return find_source(name);
}

bool is_called(const SourceKind& kind, const std::string& id) {
  return !id.empty() &&
         (kind.id == id || kind.source_model == id || (!kind.isotope.empty() && isotope_of(kind) == isotope_name(id)));
}

}  // namespace

Result<std::vector<SourceModel>> choose_sources(const std::vector<std::string>& wanted, const DosePlan& plan) {
  std::vector<std::string> names(kind_count(plan));
  std::string for_all;
  for (const std::string& argument : wanted) {
    if (argument.empty()) continue;
    const std::size_t split = argument.find('=');
    if (split == std::string::npos) {
      if (!for_all.empty() && for_all != argument)
        return input_error("--source", fmt::format("'{}' and '{}' are both named for all sources", for_all, argument),
                           "Write --source ID=NAME for each kind of source of the plan");
      for_all = argument;
      continue;
    }
    const std::string id = argument.substr(0, split), name = argument.substr(split + 1);
    bool found = false;
    std::string ids;
    for (std::size_t kind = 0; kind < names.size(); ++kind) {
      const SourceKind says = source_kind(plan, kind);
      ids += fmt::format("{}'{}'{}", ids.empty() ? "" : ", ", says.id,
                         says.isotope.empty() ? "" : fmt::format(" ({})", says.isotope));
      if (!is_called(says, id)) continue;
      found = true;
      if (!names[kind].empty() && names[kind] != name)
        return input_error("--source",
                           fmt::format("'{}' and '{}' are both named for source '{}'", names[kind], name, id),
                           "Name one model for each kind of source");
      names[kind] = name;
    }
    if (!found || name.empty())
      return input_error(fmt::format("--source {}", argument),
                         fmt::format("the plan has no source '{}'; its kinds of source are {}", id, ids),
                         "Write --source ID=NAME with the number, name or isotope of a source of the plan");
  }
  std::vector<SourceModel> models;
  for (std::size_t kind = 0; kind < names.size(); ++kind) {
    std::string name = names[kind].empty() ? for_all : names[kind];
    if (name.empty()) name = source_kind(plan, kind).source_model;
    if (name.empty()) return unnamed_source(plan, kind);
    Result<SourceModel> model = model_of(name);
    if (!model) return model.error();
    models.push_back(*std::move(model));
  }
  return models;
}

}  // namespace stylet
