# SPDX-License-Identifier: GPL-3.0-or-later
"""Words and characters that the program must not say."""

# Words of libraries that read files and of the C++ runtime.
FOREIGN = ("json.exception", "[json", "parse_error", "type_error", "while parsing", "saw '", "H5", "unable to",
           "HDF5 gave", "vtk", ".cxx", "ERROR:", "No data to", "Error reading", "std::", "bad_alloc", "basic_string",
           "what()", "terminate", "core dumped", "Segmentation fault", "Aborted", "last words", "Dcm", "OFCondition",
           "escaped_list", "boost", "exception", "error_code", "invalid escape", "Invalid stream", "I/O suspension")


def is_harmful(c):
    """Whether a character steers a terminal, ends a line or turns the direction of writing."""
    return ((c < " " and c not in "\n\t") or "\x7f" <= c < "\xa0" or c in "\u061c\u200e\u200f" or
            "\u2028" <= c <= "\u202e" or "\u2066" <= c <= "\u2069")


def harmful(text):
    """The harmful characters of a text, among them bytes that are not UTF-8 and were decoded with surrogateescape."""
    return [c for c in text if is_harmful(c) or "\ud800" <= c <= "\udfff"]
