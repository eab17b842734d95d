// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stylet {

/// A name in UTF-8 as names are compared: letters without accents (ä → a, ß → ss), Cyrillic in lower case (ё → е),
/// letters of Chinese width as ASCII, blanks and dashes of any kind as blanks. ASCII keeps its case.
std::string folded(std::string_view name);

/// Finds the names that a user's word refers to.
/// @return positions in `names` of all names equal to `word`; if there is none, of all names that differ from it only
///   in upper and lower case, in accents or in surrounding blanks; empty for an empty word or a word of blanks
std::vector<std::size_t> find_named(std::span<const std::string> names, std::string_view word);

/// Finds the regions of a mesh that a user's word refers to: find_named(); if there is none, a number N stands for
/// "region N", as the regions of files without names are called.
std::vector<std::size_t> find_region(std::span<const std::string> names, std::string_view word);

/// Whether one of the words equals this name, apart from upper and lower case and surrounding blanks. A name of blanks
/// is never listed.
bool is_listed(std::string_view name, std::span<const std::string> words);

/// Last part of the cure of an error about a structure that cannot be used, in parentheses and after a blank: how to
/// leave the structure out.
std::string or_skip(std::string_view name);

}  // namespace stylet
