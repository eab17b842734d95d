// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/sim/model.hpp"

#include <memory>
#include <string>
#include <utility>

namespace stylet::serve {

/// The source of models of further needles in a patient: the scenario, the mesh and a program's own parts of a model,
/// without the model itself, whose compliance may be large.
struct OtherNeedles {
  explicit OtherNeedles(const Model& like) : scenario(like.scenario()), mesh(like.mesh()), own(like.own_parts()) {}

  /// @param where for messages. Errors: those of Model::compile().
  [[nodiscard]] Result<std::shared_ptr<const Model>> compile(const InsertionPlan& plan, const std::string& where,
                                                             const Progress& progress) const {
    Scenario one = scenario;
    one.insertions = {plan};
    auto model = Model::compile(std::move(one), mesh, where, {}, progress);
    if (model && own.is_any()) return (*model)->with(own);
    return model;
  }

  Scenario scenario;
  TetMesh mesh;
  OwnParts own;
};

}  // namespace stylet::serve
