// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/laws.hpp"
#include "stylet/geom/mesh_preset.hpp"
#include "stylet/sim/imaging_settings.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

/// The enumerations of a scenario, and the word that a scenario file uses for each of their values.
namespace stylet {

/// Source of the default tissue values. `typical`: measured forces, with moduli from the middle of the published range;
/// `firm` and `soft`: moduli from its ends; `linear`: linear elastic tissue, as in the methods of Goksel et al. 2005.
enum class TissuePreset { typical, firm, soft, linear };
/// Kind of finite element of the tissue (Element); `automatic` lets the program choose.
enum class ElementChoice { automatic, p1, nodal_pressure, p2 };
/// Outer faces of the mesh that are held. `automatic`: none if there is a pubic arch, otherwise the sides.
enum class OuterSupport { automatic, none, sides, all };
/// Mechanical model of the needle: BeamNeedle, SpringsNeedle or TetNeedle.
enum class NeedleModel { beam, springs, tet };
/// Whether the stylet, the wire inside the needle, is in the lumen; it makes the needle stiffer.
enum class StyletPlace { out, in };
/// How seeds leave a needle. `preloaded`: the cannula is drawn back over a stylet that stays, and the seeds rest in
/// space until the cannula has passed them. `pushed`: the needle stops where a seed is wanted, and the seed is pushed
/// out in front of its tip.
enum class SeedTechnique { preloaded, pushed };
/// Order in which the needles of a plan go in: that of the plan, or by their height in the patient.
enum class NeedleOrder { plan, anterior_first, posterior_first };
/// Needles of a plan that are in the tissue at the same time, beside the stabilising ones: one after the other, all
/// needles at one height of the template, or all needles.
enum class NeedlesTogether { one, row, all };
/// Where the staggered solver applies a contact force to the needle: at the contact's exact place, or at the nearest
/// node of the needle.
enum class Projection { exact, nearest_node };

/// The words of an enumeration in scenario files, in the order of its values.
template <class E>
struct Words;

template <>
struct Words<TissuePreset> {
  static constexpr std::array<std::string_view, 4> all{"typical", "firm", "soft", "linear"};
};
template <>
struct Words<ElementChoice> {
  static constexpr std::array<std::string_view, 4> all{"auto", "p1", "nodal-pressure", "p2"};
};
template <>
struct Words<OuterSupport> {
  static constexpr std::array<std::string_view, 4> all{"auto", "none", "sides", "all"};
};
template <>
struct Words<MeshPreset> {
  static constexpr std::array<std::string_view, 2> all{"standard", "paper"};
};
template <>
struct Words<NeedleModel> {
  static constexpr std::array<std::string_view, 3> all{"beam", "springs", "tet"};
};
template <>
struct Words<StyletPlace> {
  static constexpr std::array<std::string_view, 2> all{"out", "in"};
};
template <>
struct Words<SeedTechnique> {
  static constexpr std::array<std::string_view, 2> all{"preloaded", "pushed"};
};
template <>
struct Words<NeedleOrder> {
  static constexpr std::array<std::string_view, 3> all{"plan", "anterior-first", "posterior-first"};
};
template <>
struct Words<NeedlesTogether> {
  static constexpr std::array<std::string_view, 3> all{"one", "row", "all"};
};
template <>
struct Words<ProbeKind> {
  static constexpr std::array<std::string_view, 3> all{"none", "biplane", "endfire"};
};
template <>
struct Words<UltrasoundArray> {
  static constexpr std::array<std::string_view, 2> all{"transverse", "sagittal"};
};
template <>
struct Words<Projection> {
  static constexpr std::array<std::string_view, 2> all{"exact", "nearest-node"};
};
template <>
struct Words<Bevel::Law> {
  static constexpr std::array<std::string_view, 2> all{"offset", "force"};
};
template <>
struct Words<CouplingSettings::Method> {
  static constexpr std::array<std::string_view, 4> all{"near-field", "node-addition", "node-repositioning", "embedded"};
};
template <>
struct Words<CouplingSettings::Rule> {
  static constexpr std::array<std::string_view, 2> all{"interior", "paper"};
};
template <>
struct Words<CouplingSettings::Solver> {
  static constexpr std::array<std::string_view, 2> all{"coupled", "staggered"};
};
template <>
struct Words<CouplingSettings::Engine> {
  static constexpr std::array<std::string_view, 3> all{"condensed", "woodbury", "bcs"};
};

template <class E>
concept Choice = requires {
  Words<E>::all.size();
};

/// The word for a value, or "number N" for a value N that the enumeration does not have.
template <Choice E>
[[nodiscard]] std::string word(E value) {
  const auto at = static_cast<std::size_t>(value);
  return at < Words<E>::all.size() ? std::string(Words<E>::all[at])
                                   : "number " + std::to_string(static_cast<int>(value));
}

/// The value for a word; empty if the enumeration does not have the word.
template <Choice E>
[[nodiscard]] std::optional<E> choice(std::string_view word) {
  const auto& all = Words<E>::all;
  const auto found = std::find(all.begin(), all.end(), word);
  if (found == all.end()) return std::nullopt;
  return static_cast<E>(found - all.begin());
}

}  // namespace stylet
