// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

/// Parts of pages that several pages have, as HTML.
namespace stylet::results {

/// A cell of a table with a text.
std::string text_cell(const std::string& text);

/// A cell of a table with a number: aligned to the right, on one line.
std::string figure_cell(const std::string& text);

/// The heading of a column, or of a column of numbers.
std::string text_heading(const std::string& text);
std::string figure_heading(const std::string& text);

/// A table that can be scrolled where it is wider than the page. @param style classes of its frame and of itself
/// @param head headings @param rows HTML of the rows
std::string scrolled_table(const std::string& frame_style, const std::string& style, const std::string& head,
                           const std::string& rows);

/// An item of the list of tiles. @param value HTML
std::string figure_tile(const std::string& value, const std::string& caption);

/// A name with its value for a list of definitions; nothing without a value.
std::string definition(const std::string& name, const std::string& value);

/// The items of a list of sentences.
std::string sentence_list(const std::vector<std::string>& sentences);

/// A note for readers without script in the place of a chart. @param file the file with the same numbers
std::string chart_note(const std::string& file);

/// A list of warnings in its box; nothing without a warning.
std::string box_of_warnings(const std::vector<std::string>& warnings);

}  // namespace stylet::results
