// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/known_sources.hpp"

#include "dose/sources/tables.hpp"
#include "stylet/core/nearest_name.hpp"

#include <vector>

namespace stylet {

std::span<const SourceModel> known_sources() {
  using namespace dose::sources;
  static const std::vector<SourceModel> all{
      i125_6711(),     i125_selectseed(),     i125_agx100(),       i125_best2301(), pd103_theraseed200(),
      cs131_cs1rev2(), ir192_gammamed_plus(), ir192_flexisource(), ir192_mhdr_v1(), ir192_mhdr_v2()};
  return all;
}

Result<SourceModel> find_source(const std::string& name) {
  std::vector<std::string> names;
  for (const SourceModel& source : known_sources()) {
    if (source.name == name) return source;
    names.push_back(source.name);
  }
  std::string all;
  for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
  const std::string near = nearest_name(name, names);
  return input_error(
      "source", "'" + name + "' is no source model; there are " + all,
      near.empty() ? "Name one of these, or the file of your own source model" : "Did you mean '" + near + "'?");
}

}  // namespace stylet
