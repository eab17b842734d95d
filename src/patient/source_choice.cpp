// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/source_choice.hpp"

#include "stylet/dose/fitting_sources.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/io/dose_io.hpp"

#include <filesystem>

namespace stylet {

Result<SourceModel> choose_source(const std::string& wanted, const DosePlan& plan) {
  const std::string& name = wanted.empty() ? plan.source_model : wanted;
  if (name.empty()) return unnamed_source(plan);
  const std::filesystem::path file = name;
  if (file.extension() == ".json" || file.has_parent_path()) return read_source_model(file);
  return find_source(name);
}

}  // namespace stylet
